"""Curves of a sweep: means over realisations with their scatter and error bars."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from statistics import fmean, stdev

from refimpl.errors import InputError
from verification.sweep.export import named
from verification.sweep.quality import points_of
from verification.sweep.run import COORDINATES, OUTCOMES, Row


@dataclass(frozen=True)
class Point:
    """Mean over a point's converged realisations, their standard deviation, and the mean error bar.

    scatter : 0 with one realisation
    error : inf where any is unbounded, 0 for a number without error bar
    """

    x: float
    mean: float
    scatter: float
    error: float
    realisations: int


Curves = dict[object, list[Point]]
"""Points in the order of x, by the value of the column that distinguishes the curves."""


def curves(rows: Sequence[Row], x: str, y: str, by: str | None = None) -> Curves:
    """Return curves of y over x, one for each ``by``. `InputError` for no such column, or not of numbers."""
    rows = [row | named(row) for row in rows]
    for option, name in (("--x", x), ("--y", y), ("--by", by)):
        _check_column(option, name, rows)
    found: dict[object, dict[float, list[Row]]] = {}
    for group in points_of(rows).values():
        for row in group:
            place = found.setdefault(row[by] if by else None, {})
            place.setdefault(float(row[x]), []).append(row)
    return {
        value: [_point(place, group, y) for place, group in sorted(places.items())]
        for value, places in sorted(found.items(), key=lambda item: (str(type(item[0])), item[0]))
    }


def is_logarithmic(values: Sequence[float]) -> bool:
    """Return True for positive values over more than a decade.

    >>> is_logarithmic([1.0, 20.0]), is_logarithmic([1.0, 2.0]), is_logarithmic([0.0, 20.0])
    (True, False, False)
    """
    return bool(values) and min(values) > 0 and max(values) > 10 * min(values)


def _check_column(option: str, name: str | None, rows: Sequence[Row]) -> None:
    if name is None:
        return
    known = dict.fromkeys([*COORDINATES, *OUTCOMES, *(key for row in rows for key in named(row))])
    kinds = int | float | str if option == "--by" else int | float
    numeric = [key for key in known if all(isinstance(row.get(key), kinds) for row in rows)]
    if name not in numeric:
        raise InputError(option, name, f"one of {', '.join(numeric)}")


def _point(x: float, group: Sequence[Row], y: str) -> Point:
    values = [float(row[y]) for row in group]
    bars = [row.get(f"{y}_error", 0.0) for row in group]
    scatter = stdev(values) if len(values) > 1 else 0.0
    error = fmean(math.inf if bar is None else bar for bar in bars)  # a store keeps no infinity
    return Point(x, fmean(values), scatter, error, len(values))
