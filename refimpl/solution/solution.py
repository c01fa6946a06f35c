"""The record that a solve returns: numbers, arrays, how well it converged, and what it cost."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from functools import cached_property
from typing import Any

import numpy as np

from refimpl.accuracy.grid_features import GridFeatures
from refimpl.accuracy.iteration_error import (
    NUMBERS,
)
from refimpl.errors import InputError
from refimpl.grid import Array, Grid, Mask
from refimpl.model.certificate import Certificate
from refimpl.model.friction import FrictionLaw
from refimpl.model.problem import Problem
from refimpl.model.slopes import Slopes
from refimpl.model.state import Status
from refimpl.planning.plan import Plan
from refimpl.planning.term_effects import Effect
from refimpl.scene.scene import Scene
from refimpl.solution import display
from refimpl.solution.arrays import UNITS, as_dataset
from refimpl.solution.bounds import Bounds, proven_bounds
from refimpl.solution.cost import Cost
from refimpl.solution.influence_error import SlopeError, constant_along_an_axis, slope_error
from refimpl.solution.limits import Evidence, ModelWarning, Notice, model_warnings, plain_warning
from refimpl.solution.model_form import ModelForm, model_form
from refimpl.solution.patches import Patch, patches_of
from refimpl.solution.solved import Solved

REPORTED = NUMBERS
"""The numbers of a solution, each with an error bar."""


@dataclass(frozen=True, eq=False, repr=False)
class Solution:
    """A solved scene. Forces in N, lengths in m, areas in m^2, pressures in Pa, arrays in the grid's shape.

    status : how the solve ended
    approach : from first contact, or from the mean planes when periodic
    normal_force, friction_force, binormal_force : N, F and the transverse (binormal) force Q
    friction_coefficient : mu
    contact_area, contact_area_corrected : real contact area, and less the excess along its edge
    plastic_area : area of the contact at the hardness
    max_pressure : maximum contact pressure p_max
    pressure, traction : local f and r of Eq. (1)
    slopes : of the deformed common surface
    surface_lower, surface_upper : deformed heights
    gap : deformed gap by Eq. (6), ``(u + w_p) / (cos theta_x cos theta_y) + h - approach``: zero in contact,
        and nowhere negative beyond the certificate's penetration
    plastic_indentation : depth w_p by which the softer body has yielded
    excluded : elements that the rule for tau's active set leaves without adhesive shear
    slope_error : error of flat-surface influence coefficients at this contact's slopes, by Appendix A's table
    grid : shape and lengths
    friction : the friction law
    sliding_direction : phi (rad)
    certificate : residuals, and ``tolerance`` what they must meet
    uncertainty : for each reported number its parts, absolute, in the number's unit
    plan : what was modelled, what was neglected, why
    neglected : effects of the neglected terms, from the solved contact
    problem : the scene on its grid
    warnings : texts with ``limit``, ``number`` and ``allowed``; notes have no numbers
    cost : work done
    features : what error bars look at on this grid, for studies of several grids
    """

    status: Status
    approach: float
    normal_force: float
    friction_force: float
    binormal_force: float
    friction_coefficient: float
    contact_area: float
    contact_area_corrected: float
    plastic_area: float
    max_pressure: float
    pressure: Array
    traction: Array
    slopes: Slopes
    surface_lower: Array
    surface_upper: Array
    gap: Array
    plastic_indentation: Array
    excluded: Mask
    slope_error: SlopeError
    grid: Grid
    friction: FrictionLaw
    sliding_direction: float
    certificate: Certificate
    tolerance: float
    uncertainty: Mapping[str, Mapping[str, float]]
    plan: Plan
    neglected: Mapping[str, Effect]
    problem: Problem
    warnings: tuple[ModelWarning | Notice, ...]
    cost: Cost
    features: GridFeatures

    @property
    def friction_coefficient_corrected(self) -> float:
        """mu without tau on the mean excess of the contact area along its edge."""
        return self.features.numbers["friction_coefficient_corrected"]

    @property
    def friction_force_corrected(self) -> float:
        """F without tau on the mean excess of the contact area along its edge (N)."""
        return self.features.numbers["friction_force_corrected"]

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
        return self.gap - self.plastic_indentation / self.slopes.obliqueness

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
        if name == "contact_area_share":
            return self.error("contact_area") / math.prod(self.grid.lengths)
        if name not in UNITS:
            raise InputError("error", name, f"one of {', '.join(UNITS)}")
        return math.fsum(self.uncertainty.get(name, {}).values())

    def patches(self) -> tuple[Patch, ...]:
        """Return the contact patches in the order of the array: a row each, SI units."""
        return patches_of(self.pressure, self.plastic, self.grid)

    def to_xarray(self) -> Any:
        """Return an `xarray.Dataset` of the fields: coordinates in m, units and numbers as attributes.

        Raises `InputError` where xarray is not installed.
        """
        return as_dataset(self)

    def __str__(self) -> str:
        return display.table(self)

    def __repr__(self) -> str:
        return display.line(self)

    def _repr_html_(self) -> str:
        return display.html(self)

    def summary(self) -> dict[str, Any]:
        """Return everything but the arrays, as plain values for JSON."""
        numbers = {name: getattr(self, name) for name in REPORTED}
        return {
            "status": self.status.value,
            **numbers,
            "plastic_share": self.plastic_share,
            "contact_area_share": self.contact_area_share,
            "mean_pressure": self.mean_pressure,
            "mean_gap": self.mean_gap,
            **_dimensions(self.grid),
            "tolerance": self.tolerance,
            "certificate": asdict(self.certificate),
            "uncertainty": {name: dict(parts) for name, parts in self.uncertainty.items()},
            "slope_error": asdict(self.slope_error),
            "plan": [
                {
                    "term": term.label,
                    "included": term.included,
                    "reason": term.reason,
                    "effect": asdict(term.effect),
                }
                for term in self.plan.terms
            ],
            "neglected": {name: asdict(effect) for name, effect in self.neglected.items()},
            "method": self.plan.method,
            "warnings": [plain_warning(text) for text in self.warnings],
            "cost": {
                "seconds": self.cost.seconds,
                "applications": dict(self.cost.applications),
                "iterations": dict(self.cost.iterations),
            },
        }


def _dimensions(grid: Grid) -> dict[str, Any]:
    """The grid's numbers for JSON: one number for both sides of a square, else two."""
    square = grid.lengths[0] == grid.lengths[1]
    lengths = {"side": grid.lengths[0]} if square else {"size": list(grid.lengths)}
    same = square and grid.shape[0] == grid.shape[1]
    return {"grid": grid.shape[0] if same else list(grid.shape), **lengths}


def _short_of_accuracy(solved: Solved) -> Status:
    """The status where a requested accuracy was not reached: a certificate that fails counts more."""
    ended_well = solved.status in (Status.CONVERGED, Status.CYCLED)
    return Status.ACCURACY_NOT_REACHED if ended_well else solved.status


def assemble(
    scene: Scene,
    solved: Solved,
    uncertainty: Mapping[str, Mapping[str, float]],
    notes: tuple[Notice, ...] = (),
    *,
    shortfall: Notice | None = None,
    cost: Cost | None = None,
) -> Solution:
    """Return the solution of a solved problem, with its error bars, notes and warnings.

    ``shortfall`` says why a requested accuracy was not reached; ``cost`` is that of all grids.
    """
    problem, state, result = solved.problem, solved.state, solved.result
    surface_lower, surface_upper = problem.heights
    surface_lower -= state.displacement_lower
    surface_upper += state.displacement_upper
    surface_upper -= state.approach
    plane = constant_along_an_axis(problem.gap, problem.mean_surface)
    error = slope_error(state.slopes, state.pressure, problem.pair, plane=plane)
    evidence = Evidence(scene, problem, solved.plan, state, result.excluded, error, solved.neglected)
    return Solution(
        status=_short_of_accuracy(solved) if shortfall else solved.status,
        approach=state.approach - problem.datum,
        normal_force=state.forces.normal,
        friction_force=state.forces.friction,
        binormal_force=state.forces.binormal,
        friction_coefficient=state.friction_coefficient,
        contact_area=state.contact_area,
        contact_area_corrected=state.contact_area_corrected,
        plastic_area=state.plastic_area,
        max_pressure=state.max_pressure,
        pressure=state.pressure,
        traction=state.traction,
        slopes=state.slopes,
        surface_lower=surface_lower,
        surface_upper=surface_upper,
        gap=state.gap,
        plastic_indentation=problem.grid.zeros if state.indentation is None else state.indentation,
        excluded=result.excluded,
        slope_error=error,
        grid=problem.grid,
        friction=problem.friction,
        sliding_direction=problem.direction,
        certificate=state.certificate,
        tolerance=solved.tolerance,
        uncertainty=uncertainty,
        plan=solved.plan,
        neglected=solved.neglected,
        problem=problem,
        warnings=(*notes, *model_warnings(evidence), *((shortfall,) if shortfall else ())),
        cost=cost or solved.cost,
        features=solved.features,
    )
