"""Sweeps: seconds by number of workers, and work that a neighbour's answer saves."""

from __future__ import annotations

from reports.exhibit import Column, Document, Exhibit, table

WORKERS: dict[str, Column] = {"workers": "workers", "seconds a run": "{seconds:.3g}"}
NEIGHBOURS: dict[str, Column] = {
    "surface": "surface",
    "neighbour": "neighbour",
    "cold": "{cold:.0f}",
    "from the neighbour": "{from the neighbour:.0f}",
}


def build(document: Document) -> Exhibit:
    """Return the tables of workers and of neighbours."""
    workers = [{"workers": n, "seconds": seconds} for n, seconds in document["seconds a run"].items()]
    first = (
        f"Seconds a run on {document['grid']}² elements, by workers; 0: one process, one solve after the "
        "other."
    )
    second = "Work in transforms of a solve from a neighbour's answer on this grid, beside a cold one."
    return Exhibit(
        "Sweeps",
        tables=[table(first, workers, WORKERS), table(second, document["neighbours"], NEIGHBOURS)],
    )
