"""Sweeps: what a neighbour's answer saves, in work."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from reports.exhibit import Exhibit, Table


def build(document: Mapping[str, Any]) -> Exhibit:
    """Return the tables of workers and of neighbours."""
    workers = [(name, f"{seconds:.3g}") for name, seconds in document["seconds a run"].items()]
    rows = [
        (row["surface"], row["neighbour"], f"{row['cold']:.0f}", f"{row['from the neighbour']:.0f}")
        for row in document["neighbours"]
    ]
    grid = document["grid"]
    return Exhibit(
        "Sweeps",
        tables=[
            Table(
                f"Seconds a run on {grid}² elements, by workers; 0: one process, one solve after the other.",
                ("workers", "seconds a run"),
                workers,
            ),
            Table(
                "Work in transforms of a solve from a neighbour's answer on this grid, beside a cold one.",
                ("surface", "neighbour", "cold", "from the neighbour"),
                rows,
            ),
        ],
    )
