"""Problems of the covering designs put to a faulty compact solver.

Problems that the compact solver does not solve when right are not counted.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import cache

from refimpl.grid import Array
from verification.contestants import compact, referee
from verification.contestants.design import in_turn, posed, rows
from verification.contestants.fault_error import CLAIM
from verification.contestants.protocol import ContactProblem

FIRST = ("plain", "sliding", "oblong")
"""Designs that were fixed before any fault beyond the first 51 was judged."""
TRIED = (*FIRST, "tiny", "triples", "memory")
"""Designs of the campaign: all but those of large grids, and those with a hardness."""


@cache
def problems(design: str) -> tuple[tuple[str, ContactProblem], ...]:
    """Slugs and problems of a design, in the order of the suite; those in turn with a letter."""
    return tuple(
        (f"design-{design}-{number:02}{letter if design == 'memory' else ''}", posed(row, number, CLAIM))
        for number, base in enumerate(rows()[design], start=1)
        for letter, row in zip("abc", in_turn(base), strict=False)
    )


@cache
def right(slug: str) -> compact.Solved | None:
    """The compact solver's solution without a fault; None where it does not meet the claim."""
    problem = dict(problems(design_of(slug)))[slug]
    if compact.solve.abilities.lacking(problem):
        return None
    found = compact.solve.solved(problem)
    return found if found.converged and residual(problem, found.pressure) <= CLAIM else None


def design_of(slug: str) -> str:
    """Return the design of a problem by its slug."""
    return slug.removeprefix("design-").rpartition("-")[0]


def residual(problem: ContactProblem, pressure: Array) -> float:
    """The worst recomputed residual; infinite where there is none."""
    try:
        return referee.residual(problem, pressure).worst
    except ValueError:
        return float("inf")


def fails(solver: compact.Compact, slug: str, problem: ContactProblem) -> bool:
    """Return whether a faulty solver misses its claim in a problem that the right one solves."""
    exact = right(slug)
    if exact is None or solver.changes_nothing(problem, exact):
        return False
    return not residual(problem, solver.solved(problem).pressure) <= 1.01 * CLAIM


def verdicts(solver: compact.Compact, largest: float, designs: Iterable[str] = TRIED) -> dict[str, bool]:
    """Return whether each problem of at most ``largest`` elements a side fails, by slug, in suite order."""
    failed: dict[str, bool] = {}
    for design in designs:
        for slug, problem in problems(design):
            if largest < problem.M or right(slug) is None:
                continue
            case = slug.rstrip("abc")
            failed[case] = fails(solver, slug, problem) or failed.get(case, False)
    return failed


def first_failure(solver: compact.Compact, when: Callable[[ContactProblem], bool], design: str) -> str | None:
    """Slug of the first problem that a solver fails, of those of a design that meet the condition, or None.

    Small problems are posed first; to a memory all are posed in the order of the suite.
    """
    posed_ = [*problems(design)]
    if solver.hooks.key is None:
        posed_ = sorted((item for item in posed_ if when(item[1])), key=lambda item: item[1].gap.size)
    return next((slug for slug, problem in posed_ if fails(solver, slug, problem)), None)
