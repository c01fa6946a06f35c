"""Claims and parts of the paper (`paper.toml`), with our verdict and the evidence."""

from __future__ import annotations

import tomllib
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase
from importlib import resources
from itertools import pairwise
from typing import Any

from reports.agreement import ROUNDED, Number, as_cases, by_quantity, numbers, verdict_of
from reports.findings import MISSING, by_claim, filled, note
from reports.results import Case, worst

NOT_ESTABLISHED = "not established"
CONDITIONAL = "confirmed with conditions"
VERDICTS = (
    NOT_ESTABLISHED,
    "not confirmed",
    "erratum proposed",
    "print or conversion",
    ROUNDED,
    CONDITIONAL,
    "confirmed",
    "by construction",
    "definition",
    "schematic",
)
"""From the least to the most favourable; the last three judge nothing."""
UNJUDGED = VERDICTS[-3:]


@dataclass(frozen=True)
class Claim:
    """One statement of the paper; the fields are those of `paper.toml`."""

    label: str
    quote: str
    evidence: Sequence[str]
    verdict: str = ""
    numbers: Sequence[str] = ()
    holds: Sequence[str] = ()
    corrected: Sequence[str] = ()
    finding: str = ""
    condition: str = ""
    own: bool = False
    part: str = ""


@dataclass(frozen=True)
class Part:
    """A part of the paper; the fields are those of `paper.toml`."""

    name: str
    setting: str
    figures: Sequence[str] = ()


@dataclass(frozen=True)
class Judged:
    """A claim with its verdict, its finding in numbers, the cases found for it, and errata."""

    claim: Claim
    verdict: str
    finding: str
    cases: Sequence[Case]
    errata: Sequence[Mapping[str, Any]]


def entries(kind: str) -> list[Any]:
    """Return the entries of `paper.toml` of a kind, "claim", "part" or "conversion", in the paper's order."""
    text = resources.files("reports").joinpath("paper.toml").read_text(encoding="utf-8")
    found: list[Any] = tomllib.loads(text)[kind]
    return found


def paper() -> list[Claim]:
    """Return every claim of the matrix."""
    return [Claim(**entry) for entry in entries("claim")]


def parts() -> list[Part]:
    """Return the parts of the paper."""
    return [Part(**entry) for entry in entries("part")]


def of_the_conversion() -> frozenset[str]:
    """Return the errata that may be faults of the text's conversion from print, by equation."""
    return frozenset(entries("conversion"))


def longest(cases: Iterable[Case]) -> list[Case]:
    """Return the cases but for quick ones that have a long one (``-full``) that passed."""
    known = list(cases)
    long = {case["id"] for case in known if case["id"].endswith("-full") and case["status"] == "pass"}
    return [case for case in known if f"{case['id']}-full" not in long]


def judged(cases: Iterable[Case], errata: Iterable[Mapping[str, Any]]) -> list[Judged]:
    """Return every claim with its evidence; a long case that passed stands for the quick one of its name."""
    known = longest(cases)
    found = by_claim(known)
    groups = by_quantity(numbers(found))
    found |= as_cases(groups)
    corrections = {erratum["equation"]: erratum for erratum in errata}
    return [_judged(claim, known, found, groups, corrections) for claim in paper()]


def _judged(
    claim: Claim,
    known: Sequence[Case],
    by_name: Mapping[str, Case],
    groups: Mapping[str, Sequence[Number]],
    corrections: Mapping[str, Mapping[str, Any]],
) -> Judged:
    found = [c for c in known if any(fnmatchcase(c["id"], pattern) for pattern in claim.evidence)]
    said = next((note(case) for case in found if recorded(case) is not None), "")
    finding = filled(claim.finding, by_name) or said
    finding = said if MISSING in finding and said else finding
    verdict = _verdict(claim, found, by_name, groups)
    return Judged(
        claim,
        verdict,
        f"{finding}. Condition: {claim.condition}" if verdict == CONDITIONAL else finding,
        found,
        [corrections[name] for name in claim.corrected if name in corrections],
    )


def _verdict(
    claim: Claim, cases: Sequence[Case], by_name: Mapping[str, Case], groups: Mapping[str, Sequence[Number]]
) -> str:
    """Return the least favourable verdict of claim, numbers, comparisons, cases; none without a pass."""
    if claim.evidence and (not cases or worst(list(cases)) != "pass"):
        return NOT_ESTABLISHED
    if claim.verdict in UNJUDGED:
        return claim.verdict
    given = [claim.verdict] if claim.verdict else []
    given += [verdict_of(groups.get(quantity, ())) for quantity in claim.numbers]
    given += [ascending(filled(text, by_name)) for text in claim.holds]
    if not claim.own:
        given += [v for v in map(recorded, cases) if v is not None]
    return min(given, key=VERDICTS.index, default=NOT_ESTABLISHED)


def ascending(text: str) -> str:
    """Return the verdict on "a < b < c", with its numbers in place.

    >>> ascending("1.5 < 2 < 3"), ascending("2 < 1"), ascending("1 < n/a")
    ('confirmed', 'not confirmed', 'not established')
    """
    values = text.split(" < ")
    if MISSING in values:
        return NOT_ESTABLISHED
    return "confirmed" if all(float(a) < float(b) for a, b in pairwise(values)) else "not confirmed"


def statements(claims: Iterable[Judged]) -> dict[str, list[Judged]]:
    """Return the claims that each case is evidence of, by its id: the paper's only verdicts."""
    found: dict[str, list[Judged]] = {}
    for row in claims:
        for case in row.cases:
            found.setdefault(case["id"], []).append(row)
    return found


def recorded(case: Case) -> str | None:
    """Return the verdict on the paper that a case records; None where it judges our code alone."""
    text = case["data"].get("verdict")
    return text if text in VERDICTS else None


@dataclass(frozen=True)
class Shown:
    """A part with what the evidence holds of it."""

    part: Part
    claims: Sequence[Judged]
    numbers: Sequence[Number]
    cases: Sequence[Case]


def shown(claims: Sequence[Judged], numbers: Sequence[Number], cases: Sequence[Case]) -> list[Shown]:
    """Return the parts with a claim, number or figure; long cases that passed stand for a pattern's quick."""
    known, found = longest(cases), []
    for part in parts():
        drawn = [
            case
            for pattern in part.figures
            for case in (known if "*" in pattern else cases)
            if fnmatchcase(case["id"], pattern)
        ]
        mine = [claim for claim in claims if claim.claim.part == part.name and claim.cases]
        compared = [n for n in numbers if n.part == part.name]
        if mine or compared or drawn:
            found.append(Shown(part, mine, compared, drawn))
    return found
