"""The part of an error bar that is for what lies between the points of measured surfaces and arrays.

A rough contact area goes as ``P / (E* g)`` with the rms gradient g (Bush, Gibson and Thomas 1975). Elements
wider than the pitch miss what g gains from their spacing to the pitch, which the data say. What no point says
is taken from the data as well: of every second point the others are interpolated, and the gradients of the
differences are what a pitch twice as wide does not see; likewise for every fourth. From the second to the
first of these shares they go on to the pitch itself: on a surface without waves below a few points they fall
by an order of magnitude or more, on a self-affine one hardly. The approach and, twice over, the maximum
pressure are taken to move by the same share.
"""

from __future__ import annotations

import math

import numpy as np

from refimpl.grid import Array, Grid, inner
from refimpl.scene.scene import Scene
from refimpl.surfaces import Sphere

MOST_ELEMENTS = 4  # between points of the data: the surface between them is interpolated, and smooth there
_FACTOR = 1.5  # on that share: all errors of mu of ten maps that are self-affine to the pitch are covered
_MOST_POINTS = 2048  # a side, of a map whose gradients are computed
_LEAST_POINTS = 8  # along an axis, for a cubic through every second one


def data_error(scene: Scene, grid: Grid) -> float:
    """Return the share of the contact area that the data leave open; 0 without measured parts."""
    parts = [part for name in ("lower", "upper") for part in scene.parts(name)]
    measured = [part for part in parts if part.pitch(grid.lengths) is not None]
    if not measured:
        return 0.0
    formulas = [part for part in parts if part not in measured and not isinstance(part, Sphere)]
    other = sum(_squared_gradient(part.sample(grid), grid.spacings, grid.periodic) for part in formulas)
    at_grid = at_pitch = between = 0.0
    for part in measured:
        z, spacings = part.data_points(grid)
        z = z[:_MOST_POINTS, :_MOST_POINTS]
        own = _squared_gradient(z, spacings, grid.periodic)
        wider = max(grid.spacings) > min(spacings)
        at_grid += _squared_gradient(part.sample(grid), grid.spacings, grid.periodic) if wider else own
        at_pitch += own
        between += own * unseen_share(z, grid.periodic)
    seen = at_pitch + other
    if seen == 0:
        return 0.0
    missed = 1 - math.sqrt(min(1.0, (at_grid + other) / seen))
    return missed + _FACTOR * (1 - math.sqrt(seen / (seen + between)))


def finest_by_data(scene: Scene) -> float:
    """Return the elements along the longer side at four a pitch; infinite without measured parts."""
    return math.inf if scene.pitch is None else MOST_ELEMENTS * max(scene.lengths) / scene.pitch


def unseen_share(z: Array, periodic: bool = False) -> float:
    """Return the mean square gradient that waves between the points add, over that of the points.

    >>> x = 2 * np.pi * np.arange(64) / 16  # sixteen points a wave, and uncorrelated heights
    >>> bool(unseen_share(np.add.outer(np.sin(x), np.sin(x))) < 1e-3)
    True
    >>> round(unseen_share(np.random.default_rng(0).normal(size=(64, 64))), 1)
    0.8
    """
    second = _interpolation_loss(z, periodic)
    few = min(z.shape) < 2 * _LEAST_POINTS  # every fourth point says nothing
    quarters = [z[i::2, j::2] for i in (0, 1) for j in (0, 1)]  # all, for a mirror image has the same share
    fourth = 0.0 if few else float(np.mean([_interpolation_loss(quarter, periodic) for quarter in quarters]))
    return second * (min(1.0, second / fourth) if fourth > 0 else 1.0)


def _interpolation_loss(z: Array, periodic: bool) -> float:
    """Return the share of the mean square gradient that cubics through every second point miss."""
    missed = total = 0.0
    for values in (z, z.T):
        if len(values) < _LEAST_POINTS:
            missed, total = missed + _mean_square(values), total + _mean_square(values)
            continue
        around = np.concatenate([values, values[: int(periodic)]])
        total += _mean_square(np.diff(around, axis=0))
        values = np.concatenate([values[len(values) - 3 * periodic :], values, values[: 3 * periodic]])
        middle = (9 * (values[2:-4] + values[4:-2]) - values[:-6] - values[6:]) / 16
        missed += _mean_square(values[3:-3] - middle)
    return missed / total if total > 0 else 0.0


def _mean_square(values: Array) -> float:
    total = inner(values, values)
    if math.isfinite(total) and values.size:
        return total / values.size
    known = values[np.isfinite(values)]  # missing points
    return float((known**2).mean()) if known.size else 0.0


def _squared_gradient(z: Array, spacings: tuple[float, float], periodic: bool) -> float:
    """Return the mean square of neighbouring points' differences over their distance, both axes."""
    total = 0.0
    for values, spacing in zip((z, z.T), spacings, strict=True):
        around = np.concatenate([values, values[: int(periodic)]])
        total += _mean_square(np.diff(around, axis=0)) / spacing**2
    return total
