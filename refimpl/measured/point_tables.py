"""Tables of points x, y, z: their grid and its pitch."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from refimpl.errors import InputError
from refimpl.grid import Array

POINT = 3  # columns


def is_triples(rows: Array) -> bool:
    """True if the rows are points x, y, z: a map has four columns at least."""
    return bool(rows.shape[1] == POINT)


def on_grid(path: Path, points: Array) -> tuple[Array, tuple[float, float]]:
    """Heights ``[i, j]`` of points ``(x, y, z)`` and the pitch of their grid; absent points are NaN.

    The pitch is the median distance between neighbouring distinct coordinates. Raises InputError for a line
    scan, for points more than a tenth of the pitch off the grid and for two points in one place.
    """
    x, y, z = points[np.isfinite(points[:, :2]).all(axis=1)].T
    indices, pitches = [], []
    for name, along in (("x", x), ("y", y)):
        index, pitch = _positions(path, name, along)
        indices.append(index)
        pitches.append(pitch)
    i, j = indices
    shape = int(i.max()) + 1, int(j.max()) + 1
    if shape[0] * shape[1] > 25 * len(z) + 1000:
        what = f"points on a regular grid ({len(z)} points would fill {shape[0]} x {shape[1]} places)"
        raise InputError("path", str(path), what)
    heights = np.full(shape, np.nan)
    heights[i, j] = z
    twice = len(z) - len(np.unique(i * shape[1] + j))
    if twice:
        raise InputError("path", str(path), f"one height a point ({twice} points are given twice)")
    return heights, (pitches[0], pitches[1])


def _positions(path: Path, name: str, along: Array) -> tuple[Array, float]:
    span = float(np.ptp(along)) if len(along) else 0.0
    distinct = np.unique(along)
    steps = np.diff(distinct)
    steps = steps[steps > 1e-6 * span]  # rounding of one coordinate is not a step
    if len(steps) == 0:
        raise InputError("path", str(path), f"a map (a line scan: all points have one {name})")
    pitch = float(np.median(steps))
    pitch = span / round(span / pitch)
    place = (along - along.min()) / pitch
    off = float(np.abs(place - np.rint(place)).max())
    if off > 0.1:
        raise InputError(
            "path", str(path), f"points on a regular grid ({off:.2g} of the pitch in {name} off it)"
        )
    return np.rint(place).astype(np.intp), pitch
