"""Mutation testing: the share of small faults that tests notice, and what is said of the others."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from reports.exhibit import Cell, Document, Exhibit, Table

HEAD = ("", "tried", "killed", "too slow", "equivalent", "survive", "score", "lower bound")


def build(document: Document) -> Exhibit:
    """Scores in all, by subject and by operator, and the survivors with their explanations."""
    rows = [_row("all", document)]
    rows += [_row(name, part) for name, part in document["by_subject"].items()]
    rows += [_row(name, part) for name, part in document["by_operator"].items()]
    survivors = [
        (f"{s['module']}:{s['line']}", s["before"], s["after"], s["explained"] or "not explained")
        for s in document["survivors"]
    ]
    return Exhibit(
        f"Mutants of the {document.get('of', 'numerics')}",
        (
            f"A stratified sample of {document['tried']} of {document['candidates']} small faults "
            "(operators, numbers, comparisons, removed statements), seed "
            f"{document['seed']}, was put into the modules of {', '.join(document['by_subject'])} one at "
            "a time; each module's own fast tests must notice.",
            "A mutant that exceeds its processor time counts as noticed; an equivalent one, which computes "
            "the same, counts neither way. Bounds are Clopper and Pearson's, at "
            f"{document['confidence']:.0%}; counted as survivors, equivalent ones leave a score of "
            f"{document['score_raw']:.1%}.",
            *notes(document),
        ),
        [
            Table("Scores by subject and by kind of change.", HEAD, rows),
            Table("Survivors.", ("where", "line", "as changed", "explanation"), survivors),
        ],
    )


def notes(document: Document) -> tuple[str, ...]:
    """Scope of the sample: tests were written against the survivors of the first seed's."""
    if document["seed"] != 1:
        return ("No test was written and no mutant explained because of this sample before it was judged.",)
    return (
        "Tests were sharpened against this sample's survivors, so its score says how few of these are left "
        "open; how many others would survive is what the fresh sample estimates.",
    )


def _row(name: str, part: Mapping[str, Any]) -> tuple[Cell, ...]:
    names = ("tried", "killed", "timeout", "equivalent", "survived", "score", "score_lower_bound")
    return (name, *(part[key] for key in names))
