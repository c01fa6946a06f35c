"""The estimates made again from the solved contact: what terms that were left out may have changed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from refimpl.grid import Array
from refimpl.model.problem import Problem
from refimpl.planning import term_effects
from refimpl.planning.expected_contact import Outlook, found
from refimpl.planning.term_effects import Effect, Scales

_ESTIMATES = {
    "shear coupling": term_effects.shear_coupling,
    "obliqueness": term_effects.obliqueness,
    "shear tilt": term_effects.shear_tilt,
}


def effects_left_out(
    names: tuple[str, ...], problem: Problem, pressure: Array, before: Outlook, grid: int | None = None
) -> dict[str, Effect]:
    """Effect by name of each term left out as small; costs nothing when there is none.

    With ``grid``, that of ``grid x grid`` elements if they are more: a coarse start may tip elements by
    terms that the grid of the decision would not notice.
    """
    if not names or not pressure.any():
        return {}
    outlook = found(problem, pressure, before)
    finer = max(1.0, (grid or 0) / problem.grid.M) ** 2
    outlook = replace(outlook, elements=round(finer * outlook.elements))
    scales = Scales(outlook, problem.pair, problem.friction)
    return {name: _ESTIMATES[name](scales) for name in names}


def uncertainty_left_out(
    changes: Mapping[str, Effect], local_friction: float, load: float, numbers: Mapping[str, float]
) -> dict[str, dict[str, float]]:
    """The same as parts of the uncertainty, in each number's unit; Q changes as F does.

    ``local_friction`` is ``r`` over ``f``, both summed; ``numbers`` holds what changes as areas do: A, f_max,
    the approach from first touch, or at an approach the force by as many of these as it is a power of them.
    """
    if not changes:
        return {}
    friction = sum(local_friction * effect.friction + effect.bare for effect in changes.values())
    area = sum(effect.area for effect in changes.values())
    parts = {name: {"left out": area * abs(value)} for name, value in numbers.items()}
    parts["friction_coefficient"] = {"left out": friction}
    parts["friction_force"] = {"left out": friction * load}
    parts["binormal_force"] = {"left out": friction * load}
    return parts
