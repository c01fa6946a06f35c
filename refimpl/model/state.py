"""A solver's result before certification: the fields and the end of its loops."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import Enum

from refimpl.grid import Array, Mask
from refimpl.model.slopes import Slopes


class Status(Enum):
    """End of a solve.

    CONVERGED : the certificate meets the tolerance
    STAGNATED : not converged; the residual no longer falls
    ITERATION_LIMIT : not converged; a loop's limit came first
    CYCLED : converged, with an alternating contact edge: some elements in contact carry no adhesive shear
        (`refimpl.solvers.tau_active_set`); the certificate holds for the returned traction
    ACCURACY_NOT_REACHED : the certificate holds, and a requested accuracy was not reached
    NO_CONTACT : at the prescribed approach the surfaces do not touch
    """

    CONVERGED = "converged"
    STAGNATED = "stagnated"
    ITERATION_LIMIT = "iteration limit"
    CYCLED = "cycled"
    ACCURACY_NOT_REACHED = "accuracy not reached"
    NO_CONTACT = "no contact"


@dataclass(frozen=True, eq=False)
class SolverResult:
    """A solver's result; arrays have the shape of the grid.

    pressure, traction : f and r (Pa)
    slopes : those that the facet tractions of the slope correction were taken at
    status : how the loops ended
    excluded : elements that the rule for tau's active set leaves without adhesive shear
    iterations : counts by loop
    indentation : plastic indentation that the slopes contain (m), None without a cap
    """

    pressure: Array
    traction: Array
    slopes: Slopes
    status: Status
    excluded: Mask
    iterations: dict[str, int] = field(default_factory=dict)
    indentation: Array | None = None
