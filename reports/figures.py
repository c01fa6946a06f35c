"""Which case has which figures.

The catalogue goes by the case's id: where its data are missing, the report says so. `OFFERED` goes by names
of recorded series alone, so that a new case gets a figure by recording its series under these names.
"""

from __future__ import annotations

from collections.abc import Mapping
from fnmatch import fnmatchcase
from itertools import pairwise
from typing import Any

from reports.catalogue import DECLARED
from reports.drawing import Figure, dots, lines, maps, order

OFFERED = (
    Figure(
        "*",
        ("pressure map", "traction map", "side (mm)"),
        maps({"pressure map": "Pressure", "traction map": "Traction"}, side="side (mm)", unit="MPa"),
        "Maps of contact pressure and traction.",
        (8.6, 3.8),
    ),
    Figure(
        "*",
        ("x (mm)", "pressure (MPa)", "hertz (MPa)"),
        lines(
            "x (mm)",
            {"pressure (MPa)": "this code"},
            exact={"hertz (MPa)": "Hertz"},
            xlabel="x from the centre (mm)",
            ylabel="pressure (MPa)",
        ),
        "Profile of the pressure through the centre, against Hertz.",
    ),
    Figure("*", ("M", "error"), order({"error": "error"}), "Error over the grid, with the fitted order."),
    Figure(
        "*",
        ("difference by scene",),
        dots("difference by scene", xlabel="largest difference between the solvers"),
        "Agreement of the solvers, scene by scene.",
    ),
)


def figures_of(case_id: str, data: Mapping[str, Any]) -> list[Figure]:
    """The figures declared for the case, else those offered for its series, else a plain plot of them."""
    declared = [figure for figure in DECLARED if fnmatchcase(case_id, figure.cases)]
    return declared or [figure for figure in OFFERED if figure.available(data)] or _plain(data)


def _plain(data: Mapping[str, Any], most: int = 6) -> list[Figure]:
    """All lists over the first one, where that reads as one picture.

    That is: it rises or falls, and the others are few, as long, and of comparable size or on a logarithmic
    axis.
    """
    x, *others = [name for name, values in data.items() if isinstance(values, list)] or [""]
    if not (0 < len(others) <= most and all(_is_series(data[name]) for name in (x, *others))):
        return []
    if not (_rises(data[x]) or _rises(data[x][::-1])) or {len(data[name]) for name in others} != {
        len(data[x])
    }:
        return []
    log = ("x" if _wide(data[x]) else "") + ("y" if all(_wide(data[name]) for name in others) else "")
    sizes = [max(abs(value) for value in data[name] if value is not None) for name in others]
    if "y" not in log and not max(sizes) <= 100 * min(sizes):
        return []
    ylabel = others[0] if len(others) == 1 else ""
    draw = lines(x, dict(zip(others, others, strict=True)), xlabel=x, ylabel=ylabel, log=log, marker=True)
    return [Figure("*", (x, *others), draw, "The series that the case recorded.")]


def _is_series(values: object) -> bool:
    """A list of three numbers or more, of which some may be unknown."""
    if not isinstance(values, list) or len(values) < 3 or all(value is None for value in values):
        return False
    return all(isinstance(value, int | float | None) for value in values)


def _rises(values: list[float | None]) -> bool:
    return all(a is not None and b is not None and a < b for a, b in pairwise(values))


def _wide(values: list[float | None]) -> bool:
    """Whether the known values are positive and span more than a factor of thirty."""
    known = [value for value in values if value is not None]
    return bool(known) and min(known) > 0 and max(known) > 30 * min(known)
