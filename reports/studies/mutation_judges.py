"""Mutation testing of what judges: cases, contestants, error bars, benchmarks, reports."""

from __future__ import annotations

from reports.exhibit import Document, Exhibit
from reports.studies import mutation


def build(document: Document) -> Exhibit:
    """The exhibit of `mutation` for other modules."""
    return mutation.build(document)
