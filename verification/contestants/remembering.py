"""Solvers that remember what they should not: see `verification.contestants.broken`."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from refimpl.grid import Array
from verification.contestants.protocol import ContactProblem
from verification.contestants.wrong import right

OF_FRICTION = ("tau", "beta", "shear_compliance", "sliding_direction")


class Remembering:
    """Keeps one parameter of the first problem of each size, or of the first one that slides."""

    def __init__(self, name: str) -> None:
        self._name = name
        self._kept: dict[int, Any] = {}

    def __call__(self, problem: ContactProblem) -> Array:
        """Solve with what is remembered."""
        slides = self._name in OF_FRICTION
        posed = problem.coupling if slides else problem
        if posed is None:
            return right(problem)
        kept = {self._name: self._kept.setdefault(problem.M, getattr(posed, self._name))}
        if problem.coupling is not None and slides:
            return right(replace(problem, coupling=replace(problem.coupling, **kept)))
        return right(replace(problem, **kept))


class Forgetful:
    """Hands out again what it found for a problem that was the same but for one parameter."""

    def __init__(self, name: str) -> None:
        self._name = name
        self._found: dict[tuple[object, ...], Array] = {}

    def __call__(self, problem: ContactProblem) -> Array:
        """The answer that is kept, or a new one."""
        asked = {name: value for name, value in vars(problem).items() if name not in ("gap", self._name)}
        key = (problem.gap.tobytes(), *asked.values())
        if key not in self._found:
            self._found[key] = right(problem)
        return self._found[key].copy()
