"""A second list of meaningful faults, drawn up from the source, in the form of the first one."""

from __future__ import annotations

from dataclasses import replace

from reports.exhibit import Document, Exhibit
from reports.studies import faults_by_hand

JUDGED = (
    "further faults were drawn up from the source before any test was looked at. At first each was tried by "
    "at most six test files near it, not by all of its area: the first share is a lower bound, and not "
    "comparable with that of the first list. The second share is that of tests written for the survivors, "
    "most of which were tried all at once. Lower bounds are Clopper and Pearson's, at 95 %."
)


def build(document: Document) -> Exhibit:
    """Shares by area, and the faults that were not noticed from the first."""
    shown = faults_by_hand.build(document)
    said = (f"{document['all']['faults']} {JUDGED}", *shown.paragraphs[1:])
    return replace(shown, title="Meaningful faults, second list", paragraphs=said)
