"""Error bars by class of scene: ``python -m verification.coverage.classes --scenes 100 --json FILE``.

A scene is solved on a grid of 48 to 128 elements along its longer side, and judged against one of four to ten
times as many. Half of the scenes are free, half periodic; half are squares, half rectangles; maps are free
and square. Each number's bar is that of the single grid, as ``solve(scene, grid=M)`` states it.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from scipy import stats

import refimpl as rf
from refimpl.accuracy.digits import LARGEST_SHARE
from refimpl.accuracy.grid_features import GridFeatures
from refimpl.solution.quantities import error_bound
from verification.coverage.class_scenes import (
    CLASSES,
    DECIMATED,
    MEASURED,
    decimated,
    each,
    options,
    read_heights,
    scene,
    windows_of,
)
from verification.coverage.judge import EDGE_SIZE_BOUND
from verification.framework.case import jsonable
from verification.output.files import write_result
from verification.output.provenance import provenance
from verification.output.text_table import columns

GRIDS = (48, 64, 96, 128)
REFERENCE = 512  # along the longer side
NUMBERS = (
    "friction_coefficient_corrected",
    "friction_coefficient",
    "contact_area",
    "contact_area_corrected",
    "max_pressure",
    "approach",
)
LEVEL = 0.92


def single_grid_rows(one: rf.Scene, M: int, known: rf.Scene | None = None) -> list[dict[str, Any]] | None:
    """Return bar, error and the reference's bound, over each number; None where a solve did not end well.

    ``known`` replaces the scene on the coarse grid.
    """
    finest = rf.solve(one, grid=REFERENCE)
    coarse = rf.solve(known or one, grid=M)
    if not (coarse.converged and finest.converged) or coarse.contact_area == 0:
        return None
    rows = []
    for name in NUMBERS:
        exact, bound = reference(finest, name)
        found = float(getattr(coarse, name))
        lengths = error_bound(coarse, name), abs(found - exact), bound
        shares = (length / abs(found) if length else 0.0 for length in lengths)
        row = dict(zip(("bar", "error", "reference_bound"), shares, strict=True))
        rows.append(row | {"number": name, "too_large": found > exact})
    return rows


def reference(finest: rf.Solution, name: str) -> tuple[float, float]:
    """Return a number of the finest grid without its edges' mean excess, and a bound of what is left."""
    features: GridFeatures = finest.details.features
    value = float(getattr(finest, name))
    bound = math.hypot(
        EDGE_SIZE_BOUND * features.edge,
        0.5 * math.sqrt(features.straight.squares) * features.grid.element_area,
    )
    if name == "contact_area":
        return value - features.excess, bound
    if name == "contact_area_corrected":
        return finest.contact_area - features.excess, bound
    if name in ("friction_coefficient", "friction_coefficient_corrected"):
        return finest.friction_coefficient - features.dmu_dA * features.excess, features.dmu_dA * bound
    if name == "max_pressure" and not features.yields:
        return features.peak.height, error_bound(finest, name)
    return value, error_bound(finest, name)


def summary(rows: Iterable[dict[str, Any]]) -> dict[str, Any]:
    """Return the shares of bars that hold and are usable, a binomial test against `LEVEL`, and the length.

    A bar without an end always holds: of those that are ``usable``, at most half of their number, the share
    that holds stands by itself.
    """
    rows = list(rows)
    held = sum(row["error"] <= row["bar"] for row in rows)
    short = [row for row in rows if row["bar"] <= LARGEST_SHARE]
    finite = [row["bar"] / row["error"] for row in rows if row["error"] > 0]
    bounded = [row for row in rows if math.isfinite(row["bar"])]
    off = sum(row["error"] * (1 if row["too_large"] else -1) for row in bounded)
    bars = sum(row["bar"] for row in bounded)
    test = stats.binomtest(held, len(rows), LEVEL, alternative="less")
    return {
        "scenes": len(rows),
        "held": held / len(rows),
        "held_at_worst": sum(row["error"] + row["reference_bound"] <= row["bar"] for row in rows) / len(rows),
        "usable": len(short) / len(rows),
        "held_of_usable": sum(row["error"] <= row["bar"] for row in short) / len(short) if short else None,
        "p": test.pvalue,
        "bias_over_bar": off / bars if bars else None,
        "median_bar_over_error": float(np.median(finite)) if finite else None,
    }


def main(arguments: Sequence[str] | None = None) -> None:
    """Judge the scenes of all classes, write the document and print its table."""
    parser = options("classes", __doc__, scenes=100)
    parser.add_argument("--only", help="one class")
    chosen = parser.parse_args(arguments)
    classes = dict(CLASSES)
    if chosen.map is not None:
        heights = read_heights(chosen.map)
        classes |= {MEASURED: windows_of(heights), DECIMATED: windows_of(heights, whole=True)}
    if chosen.only:
        classes = {name: kind for name, kind in classes.items() if name == chosen.only}
    found: list[dict[str, Any]] = []
    lost: dict[str, int] = dict.fromkeys(classes, 0)
    for kind, seed in each(classes, chosen.first, chosen.scenes):
        M = GRIDS[seed % len(GRIDS)]
        one, known = scene(kind, seed, classes), None
        if kind == DECIMATED:
            known, M = decimated(one, seed)
        rows = single_grid_rows(one, M, known)
        lost[kind] += rows is None
        found += [{"class": kind, "seed": seed, **row} for row in rows or ()]
    table = tables(found)
    rows = sorted(found, key=lambda row: str(row["number"]))
    document = {
        "provenance": provenance(),
        "first": chosen.first,
        "not_converged": lost,
        "table": table,
        "rows": [{name: _short(value) for name, value in row.items()} for row in rows],
    }
    write_result(jsonable(document), chosen.json)
    print(columns(lines(table), indent=""))


def _short(value: Any) -> Any:
    """Numbers with two digits: the table is made of all of them."""
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
    """Return the lines of the printed table."""
    shown = {
        "class": ("class", ""), "number": ("number", ""), "scenes": ("scenes", ""), "held": ("held", ".3f"),
        "held_at_worst": ("with the reference's bound", ".3f"), "usable": ("usable", ".2f"),
        "held_of_usable": ("of these", ".3f"), "p": ("p", ".2g"),
        "bias_over_bar": ("bias/bar", "+.2f"), "median_bar_over_error": ("bar/error", ".2f"),
    }  # fmt: skip
    names = [row | {name: row[name] or "all" for name in ("class", "number")} for row in table]
    return [[head for head, _ in shown.values()]] + [
        ["" if row[name] is None else format(row[name], digits) for name, (_, digits) in shown.items()]
        for row in names
    ]


if __name__ == "__main__":
    main()
