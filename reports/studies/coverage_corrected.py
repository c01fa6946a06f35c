"""Error bars by class of scene: coverage, the binomial test, and length."""

from __future__ import annotations

import math
from typing import Any

from reports.exhibit import Column, Document, Exhibit, table

CAPTION = (
    "Error bars of single grids of 48 to 128 elements against 384, on random scenes drawn after the "
    "constants were fitted and looked at once; at worst, the reference is off by all of its own bound. "
    "Usable bars are at most half of the number; one that is unbounded always covers. The length is a median."
)
COLUMNS: dict[str, Column] = {
    "class": lambda row: row["class"] or "all",
    "number": lambda row: row["number"] or "all",
    "scenes": "scenes",
    "covered": "{held:.1%}",
    "at worst": "{held_at_worst:.1%}",
    "usable": "{usable:.0%}",
    "covered of the usable": lambda row: _share(row["held_of_usable"]),
    "p against 92 %": "{p:.2g}",
    "error bar over error": lambda row: _length(row["median_bar_over_error"]),
}


def build(document: Document) -> Exhibit:
    """Return the table of classes and numbers."""
    return Exhibit("Error bars by class of scene", tables=[table(CAPTION, document["table"], COLUMNS)])


def _share(covered: float | None) -> str:
    return "none" if covered is None else f"{covered:.1%}"


def _length(ratio: Any) -> str:
    return "unbounded" if ratio is None or ratio == math.inf else f"{ratio:.3g}"
