"""Mutation testing once more, on a sample that no test was written against."""

from __future__ import annotations

from dataclasses import replace

from reports.exhibit import Document, Exhibit
from reports.studies import mutation


def build(document: Document) -> Exhibit:
    """The exhibit of `mutation` for another seed."""
    return replace(mutation.build(document), title="Mutants of the numerics, a fresh sample")
