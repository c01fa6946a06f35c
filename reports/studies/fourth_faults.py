"""A fourth list of meaningful faults, drawn up and judged as the third one."""

from __future__ import annotations

from reports.exhibit import Document, Exhibit
from reports.studies import third_faults


def build(document: Document) -> Exhibit:
    """Shares by area, and the faults that were not noticed from the first."""
    return third_faults.build(document, "fourth")
