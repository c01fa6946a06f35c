"""Derivatives of the numbers at a contact set that stays as it is, by one linear solve a parameter."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from refimpl.errors import NotConverged
from refimpl.grid import Array
from refimpl.model.problem import Problem
from refimpl.scene.discretise import discretise
from refimpl.scene.parameters import with_parameter
from refimpl.scene.scene import Scene
from refimpl.sensitivities.difference_quotients import both_sides
from refimpl.sensitivities.fixed_contact import FixedContact

_STEP = 1e-4  # relative, of parameters: smooth at a fixed set, so the quotient errs by 1e-8
_TIED = 1e-6  # share of p_max within which pressures tie: symmetric scenes, apart from slopes
_SOLVED = 1e-3  # relative residual of a linear solve, at most: the digits of a derivative


@dataclass(frozen=True, eq=False)
class Answer:
    """Derivatives at the fixed set: pressures (window's shape), their peak, F, Q and the approach.

    Of peaks that tie the middle one counts, as for a central difference; ``torn`` is how far others are off.
    """

    pressure: Array
    peak: float
    torn: float
    friction: float
    binormal: float
    approach: float
    residual: float


def fixed_answer(
    scene: Scene, base: Problem, fixed: FixedContact, name: str, value: float, excess: float
) -> Answer:
    """Return the answer to a parameter; friction without tau on the mean ``excess`` (m^2)."""
    (low, below), (high, above) = both_sides(
        name,
        value,
        _STEP,
        lambda at: _changed(scene, base, with_parameter(scene, name, at)).windowed(fixed.window),
    )
    span = high - low
    residuals = [fixed.residual(problem, fixed.pressure, fixed.approach) for problem in (below, above)]
    found = fixed.response((residuals[1] - residuals[0]) / span)
    if not found.residual <= _SOLVED:
        raise NotConverged(f"the derivative over {name} is not found: {found.residual:.1e} is left of it")
    before, after = (
        fixed.forces(
            problem,
            fixed.pressure + (at - value) * found.pressure,
            fixed.approach + (at - value) * found.approach,
        )
        for problem, at in ((below, low), (above, high))
    )
    pressure = found.pressure
    if fixed.capped.any():
        pressure = np.where(fixed.capped, (above.cap - below.cap) / span, pressure)
    tied = pressure[fixed.pressure >= (1 - _TIED) * fixed.peak]
    return Answer(
        pressure=pressure,
        peak=0.5 * float(tied.max() + tied.min()),
        torn=0.5 * float(np.ptp(tied)),
        friction=(after.friction - before.friction - (above.friction.jump - below.friction.jump) * excess)
        / span,
        binormal=(after.binormal - before.binormal) / span,
        approach=found.approach,
        residual=found.residual,
    )


def _changed(scene: Scene, base: Problem, changed: Scene) -> Problem:
    """Return the changed scene's problem; surfaces are sampled again only where they changed."""
    if changed.upper.surface is scene.upper.surface and changed.lower.surface is scene.lower.surface:
        elasticity = replace(base.elasticity, pair=changed.materials)
        return replace(base, elasticity=elasticity, friction=changed.friction, load=changed.load)
    return discretise(changed, base.grid, base.terms)
