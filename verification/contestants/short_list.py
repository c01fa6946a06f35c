"""Ranked short list of the dimensions of a fault, from the failing problems of the covering design."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Mapping
from typing import Any

from verification.contestants.design import rows
from verification.framework.case import Result

LISTED = 3


def levels(slug: str) -> dict[str, Any] | None:
    """Levels of a problem of the design by its slug, with the parity of its elements; or None."""
    head, _, number = slug.rpartition("-")
    design = head.removeprefix("design-")
    if not head.startswith("design-") or design not in rows():
        return None
    row = dict(rows()[design][int(number) - 1])
    coupling = row.get("coupling")
    sign = None if coupling is None else "positive" if coupling > 0 else "negative"
    even = "even" if row["elements"] % 2 == 0 else "odd"
    return row | {"parity": even, "sliding": coupling is not None, "sign of c0": sign}


def short_list(failed: Mapping[str, bool], most: int = LISTED) -> list[str]:
    """Return "only where ..." sentences, best first, from slugs and whether each problem failed.

    Candidates are a level of one dimension or levels of two; their score is the F measure, ``2 n / (f + s)``,
    with n the failures that a candidate covers, f all failures and s all problems that it covers.

    >>> from verification.contestants.design import rows
    >>> slugs = [f"design-plain-{n:02}" for n in range(1, 49)]
    >>> short_list({slug: levels(slug)["borders"] == "periodic" for slug in slugs})[0]
    'borders = periodic'
    """
    known = {slug: row for slug in failed if (row := levels(slug)) is not None}
    total = sum(failed[slug] for slug in known)
    if not total:
        return []
    facts = {slug: {(k, v) for k, v in row.items() if v is not None} for slug, row in known.items()}
    single = sorted({fact for slug in known for fact in facts[slug]}, key=str)
    pairs = itertools.combinations(single, 2)
    scores: list[tuple[float, int, str]] = []
    for candidate in itertools.chain(((fact,) for fact in single), pairs):
        covered = [slug for slug in known if facts[slug].issuperset(candidate)]
        hit = sum(failed[slug] for slug in covered)
        if hit:
            name = " and ".join(f"{key} = {value}" for key, value in candidate)
            scores.append((-2 * hit / (total + len(covered)), len(candidate), name))
    return [name for _, _, name in sorted(scores)[:most]]


def of_results(results: Iterable[Result]) -> list[str]:
    """Return the short list of a run: failures among the problems of the design that were judged."""
    judged = [r for r in results if r.status in ("pass", "fail")]
    return short_list({r.id.partition("/")[2]: r.status == "fail" for r in judged})
