"""The record that a solve returns: numbers, arrays, how well it converged, and what it cost."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

from refimpl.accuracy.grid_features import GridFeatures
from refimpl.accuracy.iteration_error import NUMBERS
from refimpl.grid import Grid
from refimpl.solution import display
from refimpl.solution.arrays import as_dataset
from refimpl.solution.cost import Cost
from refimpl.solution.evidence import Evidence
from refimpl.solution.limits import Notice, plain_warning
from refimpl.solution.patches import Patch, patches_of
from refimpl.solution.record import Record

REPORTED = NUMBERS
"""The numbers of a solution, each with an error bar."""


@dataclass(frozen=True, init=False, eq=False, repr=False)
class Solution(Record):
    """A solved scene. Forces in N, lengths in m, areas in m^2, pressures in Pa, arrays in the grid's shape.

    status : how the solve ended
    approach : from first contact, or from the mean planes when periodic
    normal_force, friction_force, binormal_force : N, F and the transverse (binormal) force Q
    friction_coefficient_corrected, friction_force_corrected : mu and F without tau on the mean excess of the
        contact area along its edge: the numbers for people
    friction_coefficient : mu, Eq. (4) of the discrete state: the number to compare between codes
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
    evidence : state, features and effects on this grid, which the numbers and arrays are read from
    grids : features of all grids of a refinement, coarse to fine; empty for a single grid
    shortfall : why a requested accuracy was not reached
    changes : numbers and arrays that `dataclasses.replace` put in place of those
    """

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
        return {
            "status": self.status.value,
            **{name: getattr(self, name) for name in REPORTED},
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


def assemble(
    evidence: Evidence,
    *,
    grids: Sequence[GridFeatures] = (),
    shortfall: Notice | None = None,
    cost: Cost | None = None,
) -> Solution:
    """Return the solution of a solved problem.

    ``grids`` are the features that error bars come from, of this grid alone by default. ``shortfall`` says
    why a requested accuracy was not reached; ``cost`` is that of all grids.
    """
    return Solution(evidence, cost or evidence.cost, tuple(grids), shortfall)
