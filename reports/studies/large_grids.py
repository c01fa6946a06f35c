"""Large grids: work, memory and seconds of whole solves by surface, terms and size."""

from __future__ import annotations

from reports.exhibit import Column, Document, Exhibit, table

CAPTION = (
    "Each solve in a process of its own, one thread. Work is that of all transforms over one real "
    "transform of the grid; iterations are those on the finest grid. Seconds are of a busy machine."
)
COLUMNS: dict[str, Column] = {
    "surface": "surface",
    "terms": "terms",
    "grid": "{M}²",
    "status": "status",
    "iterations": "finest iterations",
    "work in transforms": "{transforms:.0f}",
    "bytes an element": "{bytes an element:.0f}",
    "peak memory (GB)": lambda row: f"{row['peak memory (bytes)'] / 1e9:.2f}",
    "processor seconds": "{processor seconds:.3g}",
}


def build(document: Document) -> Exhibit:
    """Return the table of the solves that ended."""
    rows = [row for row in document["rows"] if "failure" not in row]
    return Exhibit("Large grids", tables=[table(CAPTION, rows, COLUMNS)])
