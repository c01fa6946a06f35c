"""Cost of an error in mu, A or p_max by class of scene, with friction and slopes."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from reports.exhibit import Exhibit, Table


def build(document: Mapping[str, Any]) -> Exhibit:
    """Return a table of grids and work: a row for each class and number, a column for each error."""
    demands = sorted({row["error"] for one in document["classes"] for row in one["prices"]}, reverse=True)
    rows = []
    for one in document["classes"]:
        for quantity in dict.fromkeys(row["quantity"] for row in one["prices"]):
            offers = {row["error"]: row for row in one["prices"] if row["quantity"] == quantity}
            rows.append((one["class"], quantity, *(_offer(offers[demand]) for demand in demands)))
    head = ("class", "number", *(f"{demand:.1%}" for demand in demands))
    caption = (
        "Elements a side, and work in transforms of 256 x 256 elements, from which on every grid is within "
        "the error; medians of three realisations against 2048 x 2048. Finer: more than 1024."
    )
    return Exhibit("Cost of an error", tables=[Table(caption, head, rows)])


def _offer(row: Mapping[str, Any]) -> str:
    return "finer" if row["M"] is None else f"{row['M']:.0f} ({row['transforms of 256']:.3g})"
