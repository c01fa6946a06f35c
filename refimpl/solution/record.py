"""Numbers and arrays of a solution, each read where it stands: in the state, its evidence, or the problem."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from operator import attrgetter
from typing import Any

import numpy as np

from refimpl.accuracy import refinement
from refimpl.accuracy.grid_features import GridFeatures
from refimpl.bounds.proven_bounds import Bounds, proven_bounds
from refimpl.errors import require_one_of
from refimpl.grid import Array, Grid, Mask, read_only
from refimpl.half_space.influence_error import SlopeError
from refimpl.half_space.model_form import ModelForm, model_form
from refimpl.model.certificate import Certificate, State
from refimpl.model.friction import FrictionLaw
from refimpl.model.problem import Problem
from refimpl.model.slopes import Slopes
from refimpl.model.state import Status
from refimpl.planning.plan import Plan
from refimpl.planning.term_effects import Effect
from refimpl.solution.cost import Cost
from refimpl.solution.evidence import Evidence
from refimpl.solution.limits import ModelWarning, Notice, model_warnings
from refimpl.solution.plausibility import notes

UNITS = {
    "friction_coefficient_corrected": "1",
    "friction_coefficient": "1",
    "contact_area": "m^2",
    "contact_area_corrected": "m^2",
    "contact_area_share": "1",
    "plastic_area": "m^2",
    "plastic_share": "1",
    "max_pressure": "Pa",
    "mean_pressure": "Pa",
    "mean_gap": "m",
    "approach": "m",
    "normal_force": "N",
    "friction_force": "N",
    "friction_force_corrected": "N",
    "binormal_force": "N",
}
"""Numbers of a solution with their units."""


class _FromPart:
    """An attribute that a part of the record holds, under the same name if none is given."""

    def __init__(self, part: str, name: str) -> None:
        self._part, self._name = attrgetter(part), name

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = self._name or name

    def __get__(self, record: Parts | None, owner: type) -> Any:
        if record is None:
            return self
        part = self._part(record)
        return part[self._name] if isinstance(part, Mapping) else getattr(part, self._name)


def _from(part: str, name: str = "") -> Any:
    return _FromPart(part, name)


class Parts:
    """Attributes of a `Solution` that its evidence, state or problem holds, as described there."""

    problem: Problem = _from("evidence")
    plan: Plan = _from("evidence")
    state: State = _from("evidence")
    features: GridFeatures = _from("evidence")
    neglected: Mapping[str, Effect] = _from("evidence")
    slope_error: SlopeError = _from("evidence")
    tolerance: float = _from("evidence")

    approach: float = _from("evidence.numbers")
    normal_force: float = _from("evidence.numbers")
    friction_force: float = _from("evidence.numbers")
    binormal_force: float = _from("evidence.numbers")
    friction_coefficient: float = _from("evidence.numbers")
    friction_coefficient_corrected: float = _from("features.numbers")
    friction_force_corrected: float = _from("features.numbers")
    contact_area: float = _from("evidence.numbers")
    contact_area_corrected: float = _from("features.numbers")
    plastic_area: float = _from("evidence.numbers")
    max_pressure: float = _from("evidence.numbers")

    pressure: Array = _from("state")
    traction: Array = _from("state")
    slopes: Slopes = _from("state")
    excluded: Mask = _from("state")
    certificate: Certificate = _from("state")
    grid: Grid = _from("problem")
    friction: FrictionLaw = _from("problem")
    sliding_direction: float = _from("problem", "direction")


@dataclass(frozen=True, init=False, eq=False, repr=False)
class Record(Parts):
    """A `Solution` without its texts: what it stores, and what follows from that. Arrays are read-only.

    Error bars, warnings and whatever else no solve needs are computed when first read, and in a pickle.
    """

    evidence: Evidence
    cost: Cost
    grids: tuple[GridFeatures, ...]
    shortfall: Notice | None
    changes: Mapping[str, Any]

    def __init__(
        self,
        evidence: Evidence,
        cost: Cost,
        grids: tuple[GridFeatures, ...] = (),
        shortfall: Notice | None = None,
        changes: Mapping[str, Any] | None = None,
        **others: Any,
    ) -> None:
        """Store what all else follows from.

        ``others`` are attributes that `dataclasses.replace` changes: they hide the evidence's own.
        """
        if unknown := [name for name in others if not hasattr(type(self), name)]:
            raise TypeError(f"a Solution has no attribute {unknown[0]}")
        own = {"evidence": evidence, "cost": cost, "grids": grids, "shortfall": shortfall}
        changes = {**(changes or {}), **others}
        vars(self).update(own, changes=changes, **changes)
        evidence.freeze()

    def __getstate__(self) -> dict[str, Any]:
        _ = self.status, self.uncertainty, self.warnings
        return vars(self)

    @cached_property
    def status(self) -> Status:
        """Status of the solve; a certificate that fails counts more than an accuracy that was not reached."""
        ended = self.evidence.status
        short = self.shortfall is not None and ended in (Status.CONVERGED, Status.CYCLED)
        return Status.ACCURACY_NOT_REACHED if short else ended

    @cached_property
    def uncertainty(self) -> Mapping[str, Mapping[str, float]]:
        """For each reported number the parts of its error bar, absolute, in the number's unit."""
        return refinement.uncertainty(self.grids or [self.features])

    @cached_property
    def warnings(self) -> tuple[ModelWarning | Notice, ...]:
        """Notes of inputs and surfaces, warnings of the model's limits, and why an accuracy was missed."""
        ended = (self.shortfall,) if self.shortfall else ()
        return (*notes(self.evidence), *model_warnings(self.evidence), *ended)

    @cached_property
    def surface_lower(self) -> Array:
        """Deformed heights of the lower surface (m)."""
        return read_only(self.evidence.surfaces[0])

    @cached_property
    def surface_upper(self) -> Array:
        """Deformed heights of the upper surface (m)."""
        return read_only(self.evidence.surfaces[1])

    @cached_property
    def gap(self) -> Array:
        """Deformed gap by Eq. (6) (m)."""
        return read_only(self.state.gap)

    @cached_property
    def plastic_indentation(self) -> Array:
        """Depth w_p by which the softer body has yielded (m)."""
        return read_only(self.grid.zeros if self.state.indentation is None else self.state.indentation)

    @property
    def contact(self) -> Mask:
        """Elements with ``f > 0``."""
        return self.pressure > 0

    @property
    def separation(self) -> Array:
        """Height of the upper deformed surface over the lower one (m).

        On slopes Eq. (6) leaves it ``u (1 / (cos theta_x cos theta_y) - 1)`` below the `gap`.
        """
        return self.surface_upper - self.surface_lower

    @property
    def clearance(self) -> Array:
        """``v - approach`` (m): the `gap` without the plastic indentation."""
        return self.gap - self.plastic_indentation / self.slopes.cosine_product

    @cached_property
    def theta_x(self) -> Array:
        """Slope angle along the sliding direction, positive uphill (rad)."""
        return np.arctan(self.slopes.tan_x)

    @cached_property
    def theta_y(self) -> Array:
        """Slope angle along the direction 90 degrees anticlockwise of sliding (rad)."""
        return np.arctan(self.slopes.tan_y)

    @property
    def converged(self) -> bool:
        """True if the loops ended well and the certificate holds; an alternating contact edge is certified
        too."""
        return self.status in (Status.CONVERGED, Status.CYCLED)

    @property
    def certified(self) -> bool:
        """True if the certificate holds, as it may where a requested accuracy was not reached."""
        return self.certificate.satisfies(self.tolerance)

    @property
    def plastic_share(self) -> float:
        """Share of the contact area that is at the hardness; 0 without contact."""
        return self.plastic_area / self.contact_area if self.contact_area else 0.0

    @cached_property
    def bounds(self) -> Bounds:
        """Proven bounds at the state's slopes and active set of tau; computed when first used."""
        return proven_bounds(self.problem, self.pressure, self.traction, self.slopes)

    @cached_property
    def model_form(self) -> ModelForm:
        """Stated relative errors of the half-space in approach and N; computed when first used."""
        lower, upper = self.problem.heights
        approach = self.approach + self.problem.datum
        moved = lower - self.surface_lower, self.surface_upper - upper + approach
        return model_form(self.problem, self.pressure, self.traction, moved, approach)

    @property
    def contact_area_share(self) -> float:
        """Real over nominal contact area, A/A0; A0 is the whole domain."""
        return self.contact_area / math.prod(self.grid.lengths)

    @property
    def mean_pressure(self) -> float:
        """Mean pressure of the elements in contact (Pa); 0 without contact."""
        return float(self.pressure[self.contact].mean()) if self.contact_area else 0.0

    @property
    def mean_gap(self) -> float:
        """Mean gap between the deformed surfaces over the domain (m)."""
        return float(self.gap.mean())

    @property
    def plastic(self) -> Mask:
        """Elements at the hardness."""
        return self.pressure >= self.problem.cap

    def error(self, name: str) -> float:
        """Return the error bar of a number: the sum of its parts, in its unit; inf where unbounded.

        A/A0 has that of A; a number without any part has 0. Raises `InputError` for an unknown name.
        """
        require_one_of("error", name, UNITS)
        if name == "contact_area_share":
            return self.error("contact_area") / math.prod(self.grid.lengths)
        return math.fsum(self.uncertainty.get(name, {}).values())
