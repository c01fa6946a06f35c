"""A solver's result before certification: the fields, the end of its loops, and the states of cycles."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import Enum
from typing import NamedTuple

from refimpl.grid import Array, Mask
from refimpl.model.forces import contact_area, friction_coefficient, resultants
from refimpl.model.problem import Problem
from refimpl.model.slopes import Slopes


class Status(Enum):
    """End of a solve.

    CONVERGED : the certificate meets the tolerance
    STAGNATED : not converged; the residual no longer falls
    ITERATION_LIMIT : not converged; a loop's limit came first
    CYCLED : converged, with an alternating contact edge: some elements in contact carry no adhesive shear
        (`refimpl.solvers.tau_active_set`); the certificate holds for the returned traction
    NO_CONTACT : at the prescribed approach the surfaces do not touch
    """

    CONVERGED = "converged"
    STAGNATED = "stagnated"
    ITERATION_LIMIT = "iteration limit"
    CYCLED = "cycled"
    NO_CONTACT = "no contact"


class CycleState(NamedTuple):
    """Summary of one state of a cycle: friction coefficient and contact area (m^2)."""

    friction_coefficient: float
    contact_area: float


@dataclass(frozen=True, eq=False)
class SolverResult:
    """A solver's result; arrays have the shape of the grid.

    pressure, traction : f and r (Pa)
    slopes : those that the facet tractions of the slope correction were taken at
    status : how the loops ended
    excluded : elements that the rule for tau's active set leaves without adhesive shear
    cycle_states : summaries of the states of all cycles
    iterations : counts by loop
    indentation : plastic indentation that the slopes contain (m), None without a cap
    """

    pressure: Array
    traction: Array
    slopes: Slopes
    status: Status
    excluded: Mask
    cycle_states: tuple[CycleState, ...]
    iterations: dict[str, int] = field(default_factory=dict)
    indentation: Array | None = None


def cycle_state(problem: Problem, pressure: Array, traction: Array, slopes: Slopes) -> CycleState:
    """Return the summary of a state, by Eqs (2) to (4)."""
    forces = resultants(pressure, traction, slopes, problem.grid.element_area)
    load = problem.nominal_load(forces.normal)
    return CycleState(friction_coefficient(forces.friction, load), contact_area(pressure != 0, problem.grid))
