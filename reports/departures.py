"""Departures of result files from the code: other cases, dates and commits.

A file can be consistent in itself and yet be of another version, or forged. Compared are the claims, metrics
and tolerances that this version registers; values can only be compared by another run.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from datetime import UTC, datetime, timedelta
from typing import Any

from reports.evidence import Evidence
from reports.results import Case
from reports.text import number

_CLOCKS = timedelta(days=1)  # by which clocks and time zones of two machines differ
_SHOWN = 12  # cases that one sentence names
_RUN = "this run"


def departures(
    evidence: Evidence,
    registered: Mapping[str, Mapping[str, Any]],
    known: Callable[[str], bool],
    now: datetime,
) -> list[str]:
    """Return a sentence for each kind of departure in each file; none where all agree.

    ``registered``: claim, metric, tolerance and tier of this version's cases by id; ``known`` returns whether
    a commit is one of the checkout, and True where there is none.
    """
    made = {_RUN: evidence.run["provenance"]}
    found: dict[tuple[str, str], list[str]] = {}
    for case in evidence.cases:
        file = _RUN if case["origin"] is None else case["origin"]["file"]
        made.setdefault(file, case["origin"])
        for kind, text in _of_case(case, registered.get(case["id"])):
            found.setdefault((file, kind), []).append(text)
    if evidence.solver is None and not evidence.run["only"]:
        ids = {case["id"] for case in evidence.run["cases"]}
        tiers = ("quick", evidence.run["tier"])
        missing = [id for id, row in registered.items() if row["tier"] in tiers and id not in ids]
        found |= {(_RUN, "cases of its tier that are missing"): missing} if missing else {}
    said = [f"{file}: {kind}: {_listed(texts)}" for (file, kind), texts in found.items()]
    return said + [f"{file}: {text}" for file, one in made.items() for text in _of_origin(one, known, now)]


def _of_case(case: Case, row: Mapping[str, Any] | None) -> Iterator[tuple[str, str]]:
    """Kinds of departure of a case, each with the case's id and both values."""
    id = case["id"]
    if row is None:
        yield "cases that this version does not have", id
        return
    if case["claim"] != row["claim"]:
        yield "another claim than this version's", id
    if case["metric"] != row["metric"]:
        yield "another metric than this version's", f"{id} ({case['metric']}, not {row['metric']})"
    if case["tolerance"] != row["tolerance"]:
        stated, own = number(case["tolerance"]), number(row["tolerance"])
        yield "another tolerance than this version's", f"{id} ({stated}, not {own})"


def _of_origin(made: Mapping[str, Any], known: Callable[[str], bool], now: datetime) -> Iterator[str]:
    try:
        stated = datetime.fromisoformat(made["date"])
        if stated.replace(tzinfo=stated.tzinfo or UTC) > now + _CLOCKS:
            yield f"its date {made['date']} is in the future"
    except ValueError:
        yield f"its date {made['date'][:40]!r} is no date"
    if made["commit"] is not None and not known(made["commit"]):
        yield f"its commit {made['commit'][:12]!r} is none of this checkout's"


def _listed(texts: list[str]) -> str:
    more = f" and {len(texts) - _SHOWN} more" if len(texts) > _SHOWN else ""
    return ", ".join(texts[:_SHOWN]) + more
