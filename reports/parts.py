"""The chapter on the paper's figures and tables: its parts, with claims, numbers and figures of each."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase

from reports.agreement import Number
from reports.claims import Judged, entries, longest
from reports.results import Case


@dataclass(frozen=True)
class Part:
    """A part of the paper; the fields are those of `paper.toml`."""

    name: str
    setting: str
    figures: Sequence[str] = ()


PARTS = tuple(Part(**entry) for entry in entries("part"))


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
    for part in PARTS:
        drawn = [case for pattern in part.figures for case in known if fnmatchcase(case["id"], pattern)]
        mine = [claim for claim in claims if claim.claim.part == part.name and claim.cases]
        compared = [n for n in numbers if n.part == part.name]
        if mine or compared or drawn:
            found.append(Shown(part, mine, compared, drawn))
    return found
