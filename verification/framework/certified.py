"""Solutions that a case may judge."""

from __future__ import annotations

from refimpl import Solution, Status


def certified(solution: Solution, *, cycled: bool = True) -> Solution:
    """Return a solution that ended well; RuntimeError for others, as only certified states are compared.

    Without ``cycled`` neither may single edge elements alternate in the active set of tau.
    """
    if not solution.converged or (solution.status is Status.CYCLED and not cycled):
        raise RuntimeError(f"ended {solution.status.value} on {solution.grid.shape} elements")
    return solution
