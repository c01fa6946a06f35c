"""The certified state of a solution, for tests of what judges states."""

from __future__ import annotations

import refimpl as rf
from refimpl.model.certificate import State, certify
from refimpl.operators.influence import window_influence


def state_of(solution: rf.Solution) -> State:
    """The state that certification recomputes from the solution's arrays."""
    operator = window_influence(solution.grid, solution.details.sliding_direction)
    yielded = solution.plastic_indentation if solution.details.problem.terms.plastic else None
    return certify(
        solution.details.problem, operator, solution.pressure, solution.traction, solution.slopes, yielded
    )
