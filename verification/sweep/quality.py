"""Quality of a sweep's numbers: error bars against the scatter of realisations, and warnings."""

from __future__ import annotations

import json
import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from statistics import median, stdev

from verification.sweep.run import CERTIFIED, COORDINATES, Row

JUDGED = ("friction_coefficient_corrected", "contact_area_corrected")
POINT = tuple(name for name in COORDINATES if name != "realisation")
"""Coordinates that the realisations of one point share."""


@dataclass(frozen=True)
class Quality:
    """Error bar of a number against its scatter; medians over the points of a study.

    error : relative error bar; inf where most are unbounded
    scatter : relative standard deviation over realisations; None with one realisation a point
    points, biased : points with several realisations, and those whose error bar exceeds their scatter
    """

    name: str
    error: float
    scatter: float | None
    points: int = 0
    biased: int = 0


def points_of(rows: Sequence[Row]) -> dict[tuple[object, ...], list[Row]]:
    """Return the converged rows by point: those that differ in their realisation only."""
    found: dict[tuple[object, ...], list[Row]] = {}
    for row in rows:
        if row["status"] in CERTIFIED:
            found.setdefault(tuple(map(_without_seeds(row).get, POINT)), []).append(row)
    return found


def _without_seeds(row: Row) -> Row:
    if not row.get("parameters"):
        return row
    kept = {
        name: value for name, value in json.loads(row["parameters"]).items() if not name.endswith(".seed")
    }
    return row | {"parameters": json.dumps(kept) if kept else None}


def quality_of(rows: Sequence[Row]) -> list[Quality]:
    """Return the quality of mu and A over the converged rows; numbers that are zero everywhere have none."""
    groups = list(points_of(rows).values())
    found = []
    for name in JUDGED:
        of_number = [[row for row in group if row[name]] for group in groups]
        errors = [_median_error(group, name) for group in of_number if group]
        several = [group for group in of_number if len(group) > 1]
        scatters = [_scatter([row[name] for row in group]) for group in several]
        pairs = zip(map(partial(_median_error, name=name), several), scatters, strict=True)
        biased = sum(error > scatter for error, scatter in pairs)
        if errors:
            middle = median(scatters) if scatters else None
            found.append(Quality(name, median(errors), middle, len(several), biased))
    return found


def warnings_of(rows: Sequence[Row]) -> dict[str, int]:
    """Return the number of runs with each warning, the most frequent first."""
    return dict(
        Counter(name for row in rows for name in (row["warnings"] or "").split("; ") if name).most_common()
    )


def _median_error(group: Sequence[Row], name: str) -> float:
    bars = [row[f"{name}_error"] for row in group]
    return median(
        math.inf if bar is None else bar / abs(row[name]) for bar, row in zip(bars, group, strict=True)
    )


def _scatter(values: Sequence[float]) -> float:
    mean = math.fsum(values) / len(values)
    return stdev(values) / abs(mean)
