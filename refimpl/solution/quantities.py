"""The numbers of a solution, declared once: symbol, unit, source, rule of the error bar, where shown.

Prompt, command line, JSON, array files, sweeps and what ``accuracy=`` may be about are views of `Numbers`: a
new number is one entry there.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import overload

from refimpl.accuracy import refinement
from refimpl.accuracy.iteration_error import without_rule
from refimpl.errors import InputError, require_one_of
from refimpl.grid import Array
from refimpl.model.friction import FrictionLaw
from refimpl.solution.details import Details

Source = Callable[["Numbers"], float]
Rule = Callable[["Numbers", "Quantity"], float | None]


def own_parts(solution: Numbers, quantity: Quantity) -> float | None:
    """Return the sum of the parts that are stated for the number; None without any, and where one is None."""
    parts = solution.uncertainty.get(quantity.name, {}).values()
    known = [part for part in parts if part is not None]
    return math.fsum(known) if 0 < len(known) == len(parts) else None


def _mean_pressure_error(solution: Numbers, quantity: Quantity) -> float | None:
    """Return ``(P + dP) / (A - dA) - P / A``, with dP / P of N; unbounded where A is."""
    area, force = solution.error("contact_area"), solution.error("normal_force")
    if area is None or force is None:
        return None
    open_area, open_force = area / solution.contact_area, force / abs(solution.normal_force)
    grown = (1 + open_force) / (1 - open_area) if open_area < 1 else math.inf
    return solution.mean_pressure * (grown - 1)


def _plastic_share_error(solution: Numbers, quantity: Quantity) -> float | None:
    """Return ``(A_p + dA_p) / (A - dA) - A_p / A``, and no more than a share leaves."""
    area, plastic = solution.error("contact_area"), solution.error("plastic_area")
    if area is None or plastic is None or not plastic + solution.plastic_area:
        return plastic
    share, least = solution.plastic_share, solution.contact_area - area
    grown = (solution.plastic_area + plastic) / least if least > 0 else math.inf
    return min(grown - share, max(share, 1 - share))


def _area_share_error(solution: Numbers, quantity: Quantity) -> float | None:
    """Return the bar of A over A0, which is exact."""
    area = solution.error("contact_area")
    return None if area is None else area / solution.details.grid.nominal_area


def _mean_gap_error(solution: Numbers, quantity: Quantity) -> float | None:
    """Return the approach's bar, and the share of the displacements by which N is uncertain.

    Mean displacements are less than the approach and in proportion to N: ``abs(approach) dN / N`` is enough.
    Judged on 16 scenes on 48 and 96 against 384: all 32 covered, the worst at 0.40 of the bar.
    """
    approach, force = solution.error("approach"), solution.error("normal_force")
    if approach is None or force is None:
        return None
    return approach + abs(solution.approach) * force / abs(solution.normal_force)


def _mean(pressure: Array) -> float:
    touching = pressure[pressure > 0]
    return float(touching.mean()) if touching.size else 0.0


def _elastic_friction(details: Details) -> float:
    """Return the part of Eq. (3) that is not local friction: ``sum f sin(theta_x) cos(theta_y) dA``."""
    slopes = details.state.slopes
    return float((details.state.pressure * slopes.sin_x * slopes.cos_y).sum()) * details.grid.element_area


@dataclass
class Quantity:
    """A number of a `Solution`, which reads it as an attribute of its name.

    label : in printed tables
    symbol : after the paper; empty for none
    unit : SI
    source : its value; None for that of this name in `Evidence.numbers`
    rule : its error bar, in the same unit; None for a number without one
    tables : which have a row of it: that of Python's "prompt", of the "command" line, of a "picture"
    target : whether ``accuracy=`` may be about it
    """

    label: str
    symbol: str
    unit: str
    source: Source | None = None
    rule: Rule | None = own_parts
    tables: tuple[str, ...] = ("prompt", "command")
    target: bool = False

    def __set_name__(self, owner: type, name: str) -> None:
        self.name = name

    @overload
    def __get__(self, solution: None, owner: type) -> Quantity: ...
    @overload
    def __get__(self, solution: Numbers, owner: type) -> float: ...
    def __get__(self, solution: Numbers | None, owner: type) -> Quantity | float:
        if solution is None:
            return self
        found = solution.details.evidence.numbers
        return found[self.name] if self.source is None else self.source(solution)


_EVERYWHERE = "prompt", "command", "picture"


class Numbers:
    """The numbers of a `Solution`, in the order of its tables, with their error bars."""

    details: Details

    friction_coefficient_corrected = Quantity(
        "friction coefficient mu", "mu", "1", tables=_EVERYWHERE, target=True,
        source=lambda s: s.details.features.numbers["friction_coefficient_corrected"],
    )  # fmt: skip
    friction_coefficient = Quantity("mu, summed over elements", "mu", "1", target=True)
    contact_area = Quantity("contact area A", "A", "m^2", tables=_EVERYWHERE, target=True)
    contact_area_corrected = Quantity(
        "A, perimeter-corrected", "A", "m^2", tables=("prompt", "command"), target=True,
        source=lambda s: s.details.features.numbers["contact_area_corrected"],
    )  # fmt: skip
    contact_area_share = Quantity(
        "A/A0", "A/A0", "1", tables=("prompt", "picture"), rule=_area_share_error,
        source=lambda s: s.contact_area / s.details.grid.nominal_area,
    )  # fmt: skip
    plastic_area = Quantity("plastic area", "A_p", "m^2")
    plastic_share = Quantity(
        "plastic share of A", "A_p/A", "1", tables=("command",), rule=_plastic_share_error,
        source=lambda s: s.plastic_area / s.contact_area if s.contact_area else 0.0,
    )  # fmt: skip
    max_pressure = Quantity("maximum pressure p_max", "p_max", "Pa", tables=_EVERYWHERE, target=True)
    mean_pressure = Quantity(
        "mean contact pressure", "p_mean", "Pa", tables=("prompt",), rule=_mean_pressure_error,
        source=lambda s: _mean(s.details.state.pressure),
    )  # fmt: skip
    mean_gap = Quantity(
        "mean gap", "", "m", tables=("prompt",), rule=_mean_gap_error,
        source=lambda s: float(s.details.state.gap.mean()),
    )  # fmt: skip
    approach = Quantity("approach", "delta", "m", tables=_EVERYWHERE)
    normal_force = Quantity("normal force N", "N", "N", tables=_EVERYWHERE)
    friction_force_corrected = Quantity(
        "friction force F", "F", "N",
        source=lambda s: s.details.features.numbers["friction_force_corrected"],
    )  # fmt: skip
    friction_force = Quantity("F, summed over elements", "F", "N", tables=())
    binormal_force = Quantity("transverse force Q", "Q", "N")
    elastic_friction = Quantity(
        "F by slopes", "F_s", "N", tables=(), rule=None, source=lambda s: _elastic_friction(s.details)
    )  # fmt: skip

    @cached_property
    def uncertainty(self) -> Mapping[str, Mapping[str, float | None]]:
        """For each reported number the parts of its error bar, absolute, in the number's unit.

        Empty without contact. A part that nothing bounds is infinite; one for which there is no rule, None.
        """
        features = self.details.features
        if not features.touching:
            return {}
        parts = refinement.uncertainty(self.details.grids or [features])
        unknown = without_rule(self.details.problem.friction)
        return {**parts, **{name: {"discretisation": None} for name in unknown if name in parts}}

    def error(self, name: str) -> float | None:
        """Return a number's error bar; inf where unbounded, None without a rule. Raises `InputError`."""
        require_one_of("error", name, QUANTITIES)
        quantity = QUANTITIES[name]
        return None if quantity.rule is None else quantity.rule(self, quantity)


QUANTITIES = {name: found for name, found in vars(Numbers).items() if isinstance(found, Quantity)}
REPORTED = tuple(name for name, quantity in QUANTITIES.items() if quantity.rule is own_parts)
"""Numbers whose error bars have parts of their own, given by grids; others follow from those."""
TARGETS = tuple(name for name, quantity in QUANTITIES.items() if quantity.target)


def check_target(name: str) -> None:
    """Raise `InputError` unless ``accuracy=`` may be about the number."""
    require_one_of("quantity", name, TARGETS)


def check_has_bar(name: str, law: FrictionLaw) -> None:
    """Raise `InputError` for a number that has no error bar with this law."""
    if name in without_rule(law):
        bounded = " or ".join(target for target in TARGETS if target not in without_rule(law))
        allowed = f"{bounded}, or a grid: no rule gives error bars of friction by {type(law).__name__}"
        raise InputError("quantity", name, allowed)


def error_bound(solution: Numbers, name: str) -> float:
    """Return the error bar of a number for what is computed with it: infinite without a rule."""
    error = solution.error(name)
    return math.inf if error is None else error
