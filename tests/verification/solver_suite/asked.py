"""Problems that cases and arrays of pins pose, caught by a solver that watches."""

from __future__ import annotations

from collections.abc import Callable

from refimpl.grid import Array
from verification.solver_suite import own
from verification.solver_suite.check import Entrant
from verification.solver_suite.isolated import Limited
from verification.solver_suite.pin_arrays import PinArray
from verification.solver_suite.protocol import ContactProblem


def watching(answer: Callable[[ContactProblem], Array]) -> tuple[Limited, list[tuple[ContactProblem, Array]]]:
    """A solver of our own abilities, and what it is asked and answers."""
    asked: list[tuple[ContactProblem, Array]] = []

    def solve(problem: ContactProblem) -> Array:
        pressure = answer(problem)
        asked.append((problem, pressure))
        return pressure

    return Limited(solve, own.solve.abilities), asked


def problem_of(array: PinArray, *, by_load: bool = True) -> ContactProblem:
    solver, asked = watching(lambda _: array.pressure)
    (array.under_load if by_load else array.at_approach)(Entrant(solver))
    return asked[0][0]
