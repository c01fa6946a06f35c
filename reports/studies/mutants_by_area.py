"""Random mutants of every area, exchanged arguments, columns, keys and units among them: as first judged."""

from __future__ import annotations

from dataclasses import replace

from reports.exhibit import Document, Exhibit
from reports.studies import faults_by_hand


def build(document: Document) -> Exhibit:
    """The exhibit of `faults_by_hand` for a random sample, which lists survivors alone."""
    built = faults_by_hand.build(document)
    how = (
        f"{document['all']['faults']} mutants, as many of each area (seed {document['seed']}): operators, "
        "numbers, comparisons, removed statements, and exchanged arguments, columns, keys and units. Each is "
        "judged by the doctests of its module and the tests of its area; no test was written because of this "
        "sample before it was judged."
    )
    return replace(built, title="Mutants of every area", paragraphs=(how,))
