"""A third list of meaningful faults, drawn up blind, in the form of the first one."""

from __future__ import annotations

from dataclasses import replace

from reports.exhibit import Document, Exhibit
from reports.studies import faults_by_hand

JUDGED = (
    "faults were drawn up from the source by readers who saw no test, no earlier list and no result. None "
    "changes a text that an earlier list changes. Each is judged by the doctests of its module, the tests "
    "that import it and those of its area; tests that reach it by other modules, which may notice it as "
    "well, are not run. Lower bounds are Clopper and Pearson's, at 95 %."
)


def build(document: Document, which: str = "third") -> Exhibit:
    """Shares by area, and the faults that were not noticed from the first."""
    shown = faults_by_hand.build(document)
    said = (f"{document['all']['faults']} {JUDGED}", *shown.paragraphs[1:])
    return replace(shown, title=f"Meaningful faults, {which} list", paragraphs=said)
