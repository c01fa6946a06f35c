"""Ranked short list of the dimensions of a fault, from the failing problems of the covering designs."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator, Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from verification.contestants.traits import Trait, levels
from verification.framework.case import Result

LISTED = 3
PAIR = 0.04
"""Score that a pair of conditions loses to a single one."""
DOUBTS = 2
"""Problems that are taken to speak against each condition: a failure outside it and a pass within it.

What one or two problems show may be chance; what ten show is little changed (Laplace's rule of succession).
"""
SHARE = 0.1
"""Score of a condition that explains all failures, those among problems without its dimension too."""


class Condition(NamedTuple):
    """Condition on one dimension: ``name``, the words that follow it, and the problems that meet it."""

    name: str
    words: str
    met: NDArray[np.bool_]

    def __str__(self) -> str:
        return f"{self.name} {self.words}".strip()


def short_list(failed: Mapping[str, bool], most: int = LISTED) -> list[str]:
    """Return conditions under which problems fail, best first, from slugs and whether each failed.

    Candidates are conditions on one dimension, or on two. Their score is ``2 n / (f + s + 2) + 0.1 n / F``:
    n failures meet the condition, of s problems that meet it, of f failures among the problems that have the
    dimension, and of F in all. The first term is the F measure with two `DOUBTS`: a fault that fails
    elsewhere too, by another way, is named by its dimension all the same. The second term prefers conditions
    that explain more of the failures.

    >>> from verification.contestants.design import rows
    >>> slugs = [f"design-plain-{n:02}" for n in range(1, 49)]
    >>> short_list({slug: levels(slug)["borders"] == "periodic" for slug in slugs})[0]
    'borders = periodic'
    """
    traits = {slug: found for slug in failed if (found := levels(slug)) is not None}
    fails = np.array([failed[slug] for slug in traits], dtype=np.float64)
    if not fails.any():
        return []
    if fails.all():
        return ["everywhere"]
    conditions, has = _conditions(list(traits.values()))
    met = np.array([each.met for each in conditions], dtype=np.float64)
    known = np.array([has[each.name] for each in conditions], dtype=np.float64)
    hits, covered, failures = (met * fails) @ met.T, met @ met.T, (known * fails) @ known.T
    score = 2 * hits / (failures + covered + DOUBTS) + SHARE * hits / fails.sum()
    score -= PAIR * ~np.eye(len(conditions), dtype=bool)
    return _best(conditions, score, most)


def _best(conditions: list[Condition], score: NDArray[np.float64], most: int) -> list[str]:
    """The best conditions on different dimensions; a pair behind a single one of its two says no more."""
    rows, columns = np.triu_indices(len(conditions))
    order = np.argsort(-score[rows, columns], kind="stable")
    listed: dict[frozenset[str], str] = {}
    for i, j in zip(rows[order], columns[order], strict=True):
        one, other = conditions[i], conditions[j]
        names = frozenset((one.name, other.name))
        if any(names >= known for known in listed) or (i != j and _says_no_more(one, other)):
            continue
        listed[names] = str(one) if i == j else f"{one} and {other}"
        if len(listed) == most:
            break
    return list(listed.values())


def _says_no_more(one: Condition, other: Condition) -> bool:
    """Whether a pair is on one dimension, or one of its conditions follows from the other."""
    if one.name == other.name:
        return True
    both = one.met & other.met
    return bool(np.array_equal(both, one.met) or np.array_equal(both, other.met))


def _conditions(traits: list[dict[str, Trait]]) -> tuple[list[Condition], dict[str, NDArray[np.bool_]]]:
    """All conditions that some problems meet and others do not; and which problems have each dimension."""
    names = list(dict.fromkeys(itertools.chain(*traits)))
    has = {name: np.array([name in each for each in traits]) for name in names}
    found = [each for name in names for each in _of(name, [one.get(name) for one in traits])]
    return [each for each in found if each.met.any()], has


def _of(name: str, values: list[Trait | None]) -> Iterator[Condition]:
    numbers = np.array([value if isinstance(value, float) else np.nan for value in values])
    for low, high in itertools.pairwise(sorted({*numbers[~np.isnan(numbers)]})):
        yield Condition(name, f"above {low:.3g}", numbers > low)
        yield Condition(name, f"below {high:.3g}", numbers < high)
    for value in dict.fromkeys(value for value in values if isinstance(value, str | bool)):
        words = f"= {value}" if isinstance(value, str) else "" if value else "not"
        yield Condition(name, words, np.array([v == value for v in values]))


def of_results(results: Iterable[Result]) -> list[str]:
    """Return the short list of a run: problems of the designs that failed or broke, among those judged."""
    judged = [r for r in results if r.status != "unavailable"]
    return short_list({r.id.partition("/")[2]: r.status != "pass" for r in judged})
