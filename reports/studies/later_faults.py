"""A second list of meaningful faults, of modules written since the first, in the form of the first one."""

from __future__ import annotations

from dataclasses import replace

from reports.exhibit import Document, Exhibit
from reports.studies import faults_by_hand


def build(document: Document) -> Exhibit:
    """Shares by area, and the faults that were not noticed from the first."""
    return replace(faults_by_hand.build(document), title="Meaningful faults, second list")
