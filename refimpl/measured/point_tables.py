"""Tables of points x, y, z: their grid, its pitch, and the map."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from refimpl.errors import InputError, size_text
from refimpl.grid import Array
from refimpl.measured.reading import MAX_POINTS, UNITS, Overrides, RawHeights, checked, unreadable

POINT = 3  # columns; a map has four at least
_SAME_PITCH = 0.01  # relative difference of two pitches: digits of a given one
_UNIT = re.compile(rf"(?<!\w)({'|'.join(UNITS)})(?!\w)")


def on_grid(path: Path, points: Array) -> tuple[Array, tuple[float, float]]:
    """Return heights ``[i, j]`` of points (x, y, z) and their median pitch; absent ones are NaN.

    Raises `InputError` for a line scan, points a tenth of the pitch off the grid, two in one place.
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
        found = f"{len(z)} points would fill {shape[0]} x {shape[1]} places"
        raise unreadable(path, f"points x, y, z on a regular grid ({found})")
    heights = np.full(shape, np.nan)
    heights[i, j] = z
    twice = len(z) - len(np.unique(i * shape[1] + j))
    if twice:
        raise unreadable(path, f"one height a point ({twice} points are given twice)")
    return heights, (pitches[0], pitches[1])


def _positions(path: Path, name: str, along: Array) -> tuple[Array, float]:
    span = float(np.ptp(along)) if len(along) else 0.0
    distinct = np.unique(along)
    steps = np.diff(distinct)
    steps = steps[steps > 1e-6 * span]  # rounding of one coordinate is not a step
    if len(steps) == 0:
        raise unreadable(path, f"a map (a line scan: all points have one {name})")
    pitch = float(np.median(steps))
    pitch = span / round(span / pitch)
    place = (along - along.min()) / pitch
    off = float(np.abs(place - np.rint(place)).max())
    if off > 0.1:
        raise unreadable(path, f"points x, y, z on a regular grid ({off:.2g} of the pitch in {name} off it)")
    return np.rint(place).astype(np.intp), pitch


def _check_pitch(path: Path, pitch: tuple[float, float], stated: float, given: Overrides) -> None:
    """Raise `InputError` unless a given pixel is the points' pitch (m), or would be in another unit."""
    if given.pixel_size is None:
        return
    ratios = np.divide(given.pixel_size, pitch)
    if not any(np.allclose(ratios, unit / stated, _SAME_PITCH, 0) for unit in UNITS.values()):
        own = f"{size_text(pitch)} m (in one of the units)"
        allowed = f"none, or the pitch of the points in {path.name}, {own}"
        raise InputError("pixel_size", given.pixel_size, allowed)


def points_map(
    path: Path, points: Array, given: Overrides, header: tuple[str, ...] = (), notes: tuple[str, ...] = ()
) -> RawHeights:
    """Return the map of points x, y, z in the given unit, or in the three that a line of the header names."""
    found: list[list[str]] = [_UNIT.findall(line) for line in header]
    named = next((units for units in found if len(units) == POINT), None)
    own = given.unit or (named[-1] if named else None)
    if own is None:
        allowed = f'one: {path.name} holds points x, y, z and states no unit (say unit = "um", or --unit um)'
        raise InputError("unit", None, allowed)
    heights, edges = on_grid(path, points)
    x, y = (UNITS[name] for name in (named or [own, own])[:2])
    pitch = edges[0] * x, edges[1] * y
    _check_pitch(path, pitch, x, given)
    unit, pixel, overridden = given.resolve(path.name, named[-1] if named else own, pitch)
    if heights.size > MAX_POINTS:
        raise unreadable(path, f"heights on a grid of at most {MAX_POINTS} points")
    said = () if named is None else (f"units {', '.join(named)} of x, y, z as the header states them",)
    heights, notes = checked(path, heights * UNITS[unit]), (*notes, *said, *overridden)
    source, orientation = "as points x, y, z", "coordinates as the file states them"
    return RawHeights(heights, pixel, path.name, source, unit, orientation, notes=notes)
