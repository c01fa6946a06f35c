"""Mutation testing of the verification code: cases, its suite, error bars, benchmarks, reports."""

from __future__ import annotations

from dataclasses import replace

from reports.exhibit import Document, Exhibit
from reports.studies import mutation


def build(document: Document) -> Exhibit:
    """The exhibit of `mutation` for other modules, with what a survivor may be here."""
    built = mutation.build(document)
    posed = (
        "Where a check poses a problem, another number often makes another problem, with an answer known as "
        "well: most survivors in the checks of the suite are such, and none of them is explained away."
    )
    goal = f"The goal set for the numerics, {document['goal']:.2f}, is " + (
        "met." if document["score"] >= document["goal"] else "not met."
    )
    return replace(built, paragraphs=(*built.paragraphs, posed, goal))
