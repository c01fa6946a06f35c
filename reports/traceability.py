"""The paper item by item (`paper.toml`), with the cases that are evidence for or against it."""

from __future__ import annotations

import tomllib
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase
from importlib import resources
from typing import Any

from reports.results import Case, worst


@dataclass(frozen=True)
class Item:
    """An equation, table, figure or sentence of the paper, and patterns of the cases that judge it."""

    label: str
    states: str
    evidence: tuple[str, ...]
    corrected: tuple[str, ...] = ()
    """Equations under which the errata correct it."""


VERDICTS = ("refuted", "confirmed with conditions", "confirmed")


@dataclass(frozen=True)
class Traced:
    """An item with the cases found for it and the errata that correct it."""

    item: Item
    cases: Sequence[Case]
    errata: Sequence[Mapping[str, Any]]

    @property
    def status(self) -> str:
        """The worst status of the evidence; "unavailable" without any."""
        return worst(list(self.cases)) if self.cases else "unavailable"

    @property
    def verdict(self) -> str:
        """On the paper: the least favourable verdict that a case recorded, and whether errata correct it."""
        if self.status != "pass":
            return "not established"
        said = {str(case["data"].get("verdict")) for case in self.cases}
        found = next((verdict for verdict in VERDICTS if verdict in said), "verified")
        if self.errata:
            return f"{found}; print corrected" if said & set(VERDICTS) else "corrected"
        return found


def paper() -> list[Item]:
    """Every equation, table, figure and sentence that the report traces, in the paper's order."""
    text = resources.files("reports").joinpath("paper.toml").read_text(encoding="utf-8")
    return [
        Item(entry["label"], entry["states"], tuple(entry["evidence"]), tuple(entry.get("corrected", ())))
        for entry in tomllib.loads(text)["item"]
    ]


def traced(cases: Iterable[Case], errata: Iterable[Mapping[str, Any]]) -> list[Traced]:
    """Every item of the paper with its evidence; a long case stands for the quick one of its name."""
    known = list(cases)
    long = {case["id"] for case in known if case["id"].endswith("-full") and case["status"] == "pass"}
    known = [case for case in known if f"{case['id']}-full" not in long]
    corrections = {erratum["equation"]: erratum for erratum in errata}
    return [
        Traced(
            item,
            [c for c in known if any(fnmatchcase(c["id"], pattern) for pattern in item.evidence)],
            [corrections[name] for name in item.corrected if name in corrections],
        )
        for item in paper()
    ]
