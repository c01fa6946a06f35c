"""Error bars by class of scene: how those of stored scenes cover their errors (`verification.coverage.fit`).

A scene is solved on grids of 48 to 128 elements along its longer side, and judged against a reference of
three to eight times as many, or a number in closed form. Half of the scenes are free, half periodic; half are
squares, half rectangles; maps are free and square. Each number's bar is that of the single grid, as
``solve(scene, grid=M)`` states it.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from scipy import stats

from refimpl.accuracy.digits import LARGEST_SHARE
from refimpl.accuracy.discretisation_error import estimates
from refimpl.accuracy.grid_features import GridFeatures
from refimpl.accuracy.refinement import uncertainty
from verification.coverage.building import Solved

NUMBERS = (
    "friction_coefficient_corrected",
    "friction_coefficient",
    "contact_area",
    "contact_area_corrected",
    "plastic_area",
    "max_pressure",
    "approach",
)
LEVEL = 0.92
EDGE_SIZE_BOUND = 0.12
"""Of the edge, that a reference without its mean excess is open by: three standard deviations."""


def rows(scenes: Iterable[Solved]) -> list[dict[str, Any]]:
    """Return bar, error and the reference's bound, over each number, of one grid of every scene."""
    chosen = ((one, one.grids[one.seed % (len(one.grids) - 1)]) for one in scenes)
    return [
        {"class": one.kind, "seed": one.seed, "M": max(grid.grid.shape), **row}
        for one, grid in chosen
        for row in _grid_rows(grid, one)
    ]


def _grid_rows(grid: GridFeatures, one: Solved) -> list[dict[str, Any]]:
    found, bars = [], uncertainty([grid])
    for name in NUMBERS:
        exact, bound = reference(one.grids[-1], name)
        number = grid.numbers[name]
        if number == 0:
            continue
        if (raw := _RAW.get(name, name)) in one.exact:
            exact, bound = one.exact[raw], 0.0
        lengths = sum(bars[name].values()), abs(number - exact), bound
        shares = (length / abs(number) if length else 0.0 for length in lengths)
        row = dict(zip(("bar", "error", "reference_bound"), shares, strict=True))
        found.append(row | {"number": name, "too_large": number > exact})
    return found


_RAW = {
    "friction_coefficient_corrected": "friction_coefficient",
    "contact_area_corrected": "contact_area",
}
"""Numbers of which others are corrected."""


def reference(features: GridFeatures, name: str) -> tuple[float, float]:
    """Return a number of the finest grid without its edges' mean excess, and a bound of what is left."""
    bound = math.hypot(
        EDGE_SIZE_BOUND * features.edge,
        0.5 * math.sqrt(features.straight.squares) * features.grid.element_area,
    )
    if name in ("contact_area", "contact_area_corrected"):
        return features.numbers["contact_area_corrected"], bound
    if name in ("friction_coefficient", "friction_coefficient_corrected"):
        return features.numbers["friction_coefficient_corrected"], features.dmu_dA * bound
    own = sum(uncertainty([features])[name].values())
    if name == "max_pressure" and not features.yields:
        return features.peak.height, own
    if name == "plastic_area":
        return estimates([features])[name].value, own
    return features.numbers[name], own


def summary(rows: Iterable[dict[str, Any]]) -> dict[str, Any]:
    """Return the shares of bars that hold and are usable, a binomial test against `LEVEL`, and the length.

    A bar without an end always holds: of those that are ``usable``, at most half of their number, the share
    that holds stands by itself.
    """
    rows = list(rows)
    held = sum(row["error"] <= row["bar"] for row in rows)
    short = [row for row in rows if row["bar"] <= LARGEST_SHARE]
    finite = [row["bar"] / row["error"] for row in rows if row["error"] > 0 and math.isfinite(row["bar"])]
    test = stats.binomtest(held, len(rows), LEVEL, alternative="less")
    return {
        "scenes": len(rows),
        "held": held / len(rows),
        "held_at_worst": sum(row["error"] + row["reference_bound"] <= row["bar"] for row in rows) / len(rows),
        "usable": len(short) / len(rows),
        "held_of_usable": sum(row["error"] <= row["bar"] for row in short) / len(short) if short else None,
        "p": test.pvalue,
        "median_bar_over_error": float(np.median(finite)) if finite else None,
        "unbounded": sum(not math.isfinite(row["bar"]) for row in rows) / len(rows),
    }


def document(scenes: Sequence[Solved]) -> dict[str, Any]:
    """Return the table and the rows of the scenes as a result file has them."""
    found = rows(scenes)
    seeds = sorted({one.seed for one in scenes})
    short = [{name: _short(value) for name, value in row.items()} for row in found]
    return {"seeds": [seeds[0], seeds[-1]], "table": tables(found), "rows": short}


def _short(value: Any) -> Any:
    """Return the numbers with two digits: the table is made of all of them."""
    return float(f"{value:.2g}") if isinstance(value, float) else value


def tables(found: Sequence[dict[str, Any]]) -> list[dict[str, Any]]:
    """Return the summary of each class and number, of each class, and of each number."""
    rows = []
    for kind in (*dict.fromkeys(row["class"] for row in found), None):
        for number in (*NUMBERS, None):
            some = [row for row in found if kind in (None, row["class"]) and number in (None, row["number"])]
            if some:
                rows.append({"class": kind, "number": number, **summary(some)})
    return rows


def lines(table: Sequence[dict[str, Any]]) -> list[list[str]]:
    """Return the lines of the printed table; without a class or number a row is of all of them."""

    def shown(value: Any) -> str:
        return "" if value is None else f"{value:.3g}" if isinstance(value, float) else str(value)

    return [[*table[0]], *([shown(value) for value in row.values()] for row in table)]
