"""Posing a problem to a solver under test: only a checked answer that claims success is returned."""

from __future__ import annotations

import math
import numbers
from dataclasses import replace

import numpy as np

from verification.solver_suite.protocol import (
    NUMBERS,
    Answer,
    BadAnswer,
    ContactProblem,
    Contestant,
    Unsupported,
    abilities_of,
)

HIGHEST = 1e50
"""Pressures (over E*) from which an answer is nonsense: sums and energies of what is below stay finite."""
EXPECTED = "expected an array of real numbers, or Answer(pressure, converged) with one"


def _named(answer: object) -> str:
    """What kind of thing an answer is."""
    if answer is None:
        return "None"
    if isinstance(answer, np.ndarray):
        return f"an array of {answer.dtype}"
    return f"a {type(answer).__name__}"


def ask(contestant: Contestant, problem: ContactProblem) -> Answer:
    """Return the claimed answer of a solver under test, checked; its pressures ``(M, M)`` (Pa) are an array.

    The solver gets a copy of the problem. Raises `Unsupported` where its abilities do not reach,
    `BadAnswer` for an answer that cannot be judged or admits failure, and every exception of the solver.
    """
    lacking = abilities_of(contestant).lacking(problem)
    if lacking:
        raise Unsupported(f"the solver does not offer: {lacking}")
    answer = contestant(replace(problem, gap=problem.gap))
    beside = _numbers(answer) if isinstance(answer, Answer) else {}
    if isinstance(answer, Answer):
        if not isinstance(answer.converged, bool | np.bool_):
            raise BadAnswer(f"converged = {answer.converged!r}: expected true or false")
        if not answer.converged:
            raise BadAnswer("the solver did not converge by its own report")
        answer = np.asanyarray(answer.pressure)  # a mask stays
    if not isinstance(answer, np.ndarray) or answer.dtype.kind not in "fiu":
        raise BadAnswer(f"the solver returned {_named(answer)}: {EXPECTED}")
    if answer.shape != problem.gap.shape:
        raise BadAnswer(f"pressures of shape {answer.shape} for a gap of shape {problem.gap.shape}")
    if np.ma.is_masked(answer):  # values below a mask are no answer
        raise BadAnswer(f"{int(np.count_nonzero(np.ma.getmaskarray(answer)))} pressures are masked")
    pressure = np.array(answer, dtype=np.float64)
    if not np.isfinite(pressure).all():
        raise BadAnswer(f"{int(np.count_nonzero(~np.isfinite(pressure)))} pressures are not finite")
    if not np.abs(pressure).max() < HIGHEST * problem.reduced_modulus:
        raise BadAnswer(f"pressures up to {np.abs(pressure).max():.3g} Pa, beyond {HIGHEST:g} E*")
    return Answer(pressure, True, **beside)


def _numbers(answer: Answer) -> dict[str, float]:
    """The numbers that an answer has, by name. Raises `BadAnswer` for what is no finite number."""
    found = {name: getattr(answer, name) for name in NUMBERS if getattr(answer, name) is not None}
    for name, number in found.items():
        real = isinstance(number, numbers.Real) and not isinstance(number, bool)
        if not real or not math.isfinite(number):
            raise BadAnswer(f"{name} = {number!r}: expected a finite number, or None")
    return {name: float(number) for name, number in found.items()}
