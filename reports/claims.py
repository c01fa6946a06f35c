"""Claims and parts of the paper (`paper.toml`), with our verdict and the evidence."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase
from importlib import resources
from typing import Any

from reports.agreement import Number, as_cases, numbers
from reports.findings import by_claim, filled
from reports.results import Case, worst

NOT_ESTABLISHED = "not established"
VERDICTS = (
    NOT_ESTABLISHED,
    "not confirmed",
    "erratum proposed",
    "confirmed with conditions",
    "confirmed",
    "by construction",
    "definition",
    "schematic",
)
"""From the least to the most favourable; the last three judge nothing."""


@dataclass(frozen=True)
class Claim:
    """One statement of the paper; the fields are those of `paper.toml`."""

    label: str
    quote: str
    verdict: str
    evidence: Sequence[str]
    corrected: Sequence[str] = ()
    finding: str = ""
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


def entries(kind: str) -> list[dict[str, Any]]:
    """Return the entries of `paper.toml` of a kind, "claim" or "part", in the paper's order."""
    text = resources.files("reports").joinpath("paper.toml").read_text(encoding="utf-8")
    found: list[dict[str, Any]] = tomllib.loads(text)[kind]
    return found


def paper() -> list[Claim]:
    """Return every claim of the matrix."""
    return [Claim(**entry) for entry in entries("claim")]


def parts() -> list[Part]:
    """Return the parts of the paper."""
    return [Part(**entry) for entry in entries("part")]


def of_the_conversion() -> frozenset[str]:
    """Errata that may be faults of the text's conversion from print, by equation."""
    text = resources.files("reports").joinpath("paper.toml").read_text(encoding="utf-8")
    return frozenset(tomllib.loads(text)["conversion"])


def longest(cases: Iterable[Case]) -> list[Case]:
    """Return the cases but for quick ones that have a long one (``-full``) that passed."""
    known = list(cases)
    long = {case["id"] for case in known if case["id"].endswith("-full") and case["status"] == "pass"}
    return [case for case in known if f"{case['id']}-full" not in long]


def judged(cases: Iterable[Case], errata: Iterable[Mapping[str, Any]]) -> list[Judged]:
    """Return every claim with its evidence; a long case that passed stands for the quick one of its name."""
    known = longest(cases)
    found = by_claim(known)
    found |= as_cases(numbers(found))
    corrections = {erratum["equation"]: erratum for erratum in errata}
    return [_judged(claim, known, found, corrections) for claim in paper()]


def _judged(
    claim: Claim,
    known: Sequence[Case],
    by_name: Mapping[str, Case],
    corrections: Mapping[str, Mapping[str, Any]],
) -> Judged:
    found = [c for c in known if any(fnmatchcase(c["id"], pattern) for pattern in claim.evidence)]
    said = [c for c in found if recorded(c) is not None]
    first = note(said[0]) if said else ""
    finding = filled(claim.finding, by_name) if claim.finding else first
    return Judged(
        claim,
        verdict(claim, found),
        finding,
        found,
        [corrections[name] for name in claim.corrected if name in corrections],
    )


def verdict(claim: Claim, cases: Sequence[Case]) -> str:
    """The claim's verdict, or a less favourable one that a case records; none without evidence that
    passed."""
    if claim.evidence and (not cases or worst(list(cases)) != "pass"):
        return NOT_ESTABLISHED
    if claim.own or claim.verdict in VERDICTS[-3:]:
        return claim.verdict
    said = [v for v in map(recorded, cases) if v is not None]
    return min((claim.verdict, *said), key=VERDICTS.index)


def recorded(case: Case) -> str | None:
    """Return the verdict on the paper that a case records; None where it judges our code alone."""
    text = case["data"].get("verdict")
    return text if text in VERDICTS else None


def note(case: Case) -> str:
    """The first statement of a case's note, without the verdict.

    >>> note({"data": {"verdict": "confirmed"}, "note": "confirmed: 1 (of 2; 3) here; more. And more"})
    '1 (of 2; 3) here'
    """
    text: str = case["note"].removeprefix(case["data"]["verdict"]).removeprefix(":").strip()
    return re.split(r"(?:;|\.) (?![^(]*\))", text)[0]


@dataclass(frozen=True)
class Shown:
    """A part with what the evidence holds of it."""

    part: Part
    claims: Sequence[Judged]
    numbers: Sequence[Number]
    cases: Sequence[Case]


def shown(claims: Sequence[Judged], numbers: Sequence[Number], cases: Sequence[Case]) -> list[Shown]:
    """Return the parts that have a claim, a number or a figure; long cases that passed replace quick ones."""
    known, found = longest(cases), []
    for part in parts():
        drawn = [case for pattern in part.figures for case in known if fnmatchcase(case["id"], pattern)]
        mine = [claim for claim in claims if claim.claim.part == part.name and claim.cases]
        compared = [n for n in numbers if n.part == part.name]
        if mine or compared or drawn:
            found.append(Shown(part, mine, compared, drawn))
    return found
