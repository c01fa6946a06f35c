"""The record that a solve returns: numbers, arrays, how well it converged, and what it cost."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

from refimpl.accuracy.grid_features import GridFeatures
from refimpl.grid import Grid
from refimpl.solution import display
from refimpl.solution.arrays import Patch, as_dataset, patches_of
from refimpl.solution.details import Details
from refimpl.solution.evidence import Cost, Evidence
from refimpl.solution.model_warning import Notice, plain_warning
from refimpl.solution.quantities import QUANTITIES
from refimpl.solution.record import Record


@dataclass(frozen=True, eq=False, repr=False)
class Solution(Record):
    """A solved scene. Forces in N, lengths in m, areas in m^2, pressures in Pa, arrays in the grid's shape.

    It is read, never changed: all of it follows from `details`.

    Numbers, each with its error bar by ``error(name)``, None where no rule gives one:

    friction_coefficient_corrected, friction_force_corrected : mu and F without tau on the mean excess of the
        contact area along its edge: the numbers for people
    friction_coefficient, friction_force : mu and F summed over elements, Eqs (4) and (3) of the discrete
        state: the numbers to compare between codes
    normal_force, binormal_force : N and the transverse (binormal) force Q
    elastic_friction : the part of F by slopes, ``sum f sin(theta_x) cos(theta_y) dA``: a single specimen's
        mean slope is in it, with the opposite sign once it slides the opposite way
    approach : from first contact, or from the mean planes when periodic
    contact_area, contact_area_corrected, contact_area_share : real contact area, less the excess along its
        edge, and over that of the domain
    plastic_area, plastic_share : area of the contact at the hardness, and its share of the contact
    max_pressure, mean_pressure : of the contact
    mean_gap : over the domain

    Arrays, read-only:

    pressure, traction : local f and r of Eq. (1)
    contact : elements with ``f > 0``
    gap : deformed gap by Eq. (6), ``(u + w_p) / (cos theta_x cos theta_y) + h - approach``: zero in contact,
        and nowhere negative beyond the certificate's penetration
    surfaces : deformed heights, lower and upper
    slopes : of the deformed common surface: ``theta_x``, ``theta_y``, their tangents, sines and cosines
    plastic_indentation : depth w_p by which the softer body has yielded

    How good it is:

    status, converged : how the solve ended, and whether it ended well
    certificate : residuals
    uncertainty, error : parts of each number's error bar, and their sum
    warnings : texts with ``limit``, ``number`` and ``allowed``; notes have no numbers

    What was solved:

    grid : shape and lengths
    plan : what was modelled, what was neglected, why
    cost : work done

    To take along:

    summary : everything but the arrays, for JSON
    patches : table of contact patches
    to_xarray : the arrays with coordinates and units
    details : what solvers keep, for studies: problem, state, evidence, proven bounds
    """

    def patches(self) -> tuple[Patch, ...]:
        """Return the contact patches in the order of the array: a row each, SI units."""
        return patches_of(self.pressure, self.details.plastic, self.grid)

    def to_xarray(self) -> Any:
        """Return an `xarray.Dataset` of the fields: coordinates in m, units and numbers as attributes.

        Raises `InputError` without xarray.
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
            **{name: getattr(self, name) for name in QUANTITIES},
            "error": {name: self.error(name) for name in QUANTITIES},
            **_dimensions(self.grid),
            "tolerance": self.details.tolerance,
            "certificate": asdict(self.certificate),
            "uncertainty": {name: dict(parts) for name, parts in self.uncertainty.items()},
            "slope_error": asdict(self.details.slope_error),
            "plan": [
                {
                    "term": term.label,
                    "included": term.included,
                    "reason": term.reason,
                    "effect": asdict(term.effect),
                }
                for term in self.plan.terms
            ],
            "neglected": {name: asdict(effect) for name, effect in self.details.neglected.items()},
            "method": self.plan.method,
            "warnings": [plain_warning(text) for text in self.warnings],
            "cost": {
                "seconds": self.cost.seconds,
                "applications": dict(self.cost.applications),
                "iterations": dict(self.cost.iterations),
            },
        }


def _dimensions(grid: Grid) -> dict[str, Any]:
    """Return the grid's numbers for JSON: one number for both sides of a square, else two."""
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
    """Return the solution of a solved problem, with the features and the cost of all grids."""
    return Solution(Details(evidence, cost or evidence.cost, tuple(grids), shortfall))
