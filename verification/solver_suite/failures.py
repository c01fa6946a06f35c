"""Failures of a run by the dimensions of the covering designs: where a faulty solver fails."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cache

from verification.framework.case import Result
from verification.solver_suite.design import further_rows, rows
from verification.solver_suite.dimensions import DESIGNS, FURTHER

LISTED = 4
"""Dimensions in the list."""
Counts = dict[str, dict[str, tuple[int, int]]]
"""Problems that failed, and all, by dimension and level."""


@cache
def _levels(further: bool) -> dict[str, dict[str, str]]:
    """Return the levels that its design varies, by the id of a case; and whether the size is odd."""
    found: dict[str, dict[str, str]] = {}
    for name, design in (rows() | (further_rows() if further else {})).items():
        for number, row in enumerate(design, start=1):
            levels = {each: f"{row[each]}" for each in (DESIGNS | FURTHER)[name].dimensions}
            parity = {"parity": "odd" if row["elements"] % 2 else "even"}
            found[f"solver/design-{name}-{number:02}"] = levels | parity
    return found


def by_dimension(results: Iterable[Result]) -> Counts:
    """Return the dimensions that tell failures apart best, with those of their levels that have any.

    By chi squared of their table of failures less its mean under chance; without a positive one, none.
    """
    counts: Counts = {}
    for result in results:
        known = _levels(result.id.removeprefix("solver/design-").rpartition("-")[0] in FURTHER)
        for name, level in known.get(result.id, {}).items() if result.status != "unavailable" else ():
            failed, posed = counts.setdefault(name, {}).get(level, (0, 0))
            counts[name][level] = failed + (result.status != "pass"), posed + 1
    best = sorted(counts, key=lambda name: -_excess(list(counts[name].values())))[:LISTED]
    return {
        name: {level: found for level, found in sorted(counts[name].items()) if found[0]}
        for name in best
        if _excess(list(counts[name].values())) > 0
    }


def _excess(levels: list[tuple[int, int]]) -> float:
    failed, posed = (sum(column) for column in zip(*levels, strict=True))
    share = failed / posed
    if share in (0, 1):
        return 0.0
    squared: float = sum((f - share * n) ** 2 / n for f, n in levels) / (share * (1 - share))
    return squared - (len(levels) - 1)


def in_words(counts: Counts) -> list[str]:
    """Return a line for each dimension.

    >>> in_words({"borders": {"periodic": (3, 20)}})
    ['borders: 3 of 20 with periodic']
    """
    words = {
        name: [f"{failed} of {posed} with {level}" for level, (failed, posed) in levels.items()]
        for name, levels in counts.items()
    }
    return [f"{name}: {', '.join(each)}" for name, each in words.items()]
