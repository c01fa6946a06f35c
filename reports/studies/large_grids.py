"""Large grids: work, memory and seconds of whole solves by surface, terms and size."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from reports.exhibit import Exhibit, Table


def build(document: Mapping[str, Any]) -> Exhibit:
    """Return the table of solves."""
    rows = [
        (
            row["surface"],
            row["terms"],
            f"{row['M']}²",
            row["status"],
            row["finest iterations"],
            f"{row['transforms']:.0f}",
            f"{row['bytes an element']:.0f}",
            f"{row['peak memory (bytes)'] / 1e9:.2f}",
            f"{row['processor seconds']:.3g}",
        )
        for row in document["rows"]
        if "failure" not in row
    ]
    head = (
        "surface",
        "terms",
        "grid",
        "status",
        "iterations",
        "work in transforms",
        "bytes an element",
        "peak memory (GB)",
        "processor seconds",
    )
    caption = (
        "Each solve in a process of its own, one thread. Work is that of all transforms over one real "
        "transform of the grid; iterations are those on the finest grid. Seconds are of a busy machine."
    )
    return Exhibit("Large grids", tables=[Table(caption, head, rows)])
