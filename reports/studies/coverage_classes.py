"""Error bars by class of scene: share that hold, the binomial test, and their length."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from reports.exhibit import Exhibit, Table


def build(document: Mapping[str, Any]) -> Exhibit:
    """Return the table of classes and numbers."""
    rows = []
    for row in document["table"]:
        ratio = row["median_bar_over_error"]
        rows.append(
            (
                row["class"] or "all",
                row["number"] or "all",
                row["scenes"],
                f"{row['held']:.1%}",
                f"{row['held_at_worst']:.1%}",
                f"{row['usable']:.0%}",
                "none" if row["held_of_usable"] is None else f"{row['held_of_usable']:.1%}",
                f"{row['p']:.2g}",
                "unbounded" if ratio is None or ratio == float("inf") else f"{ratio:.3g}",
            )
        )
    head = (
        "class",
        "number",
        "scenes",
        "bar holds",
        "at worst",
        "usable",
        "of these, bar holds",
        "p against 92 %",
        "bar over error",
    )
    caption = (
        "Error bars of single grids of 48 to 128 elements against 512, on random scenes that were looked at "
        "once; at worst, the reference is off by all of its own bound. Usable bars are at most half of the "
        "number; one without an end always holds. The length is a median."
    )
    return Exhibit("Error bars by class of scene", tables=[Table(caption, head, rows)])
