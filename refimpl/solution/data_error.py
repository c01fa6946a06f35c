"""The part of an error bar that is for what lies between the points of measured surfaces and arrays.

A rough contact area goes as ``P / (E* g)`` with the rms gradient g (Bush, Gibson and Thomas 1975). Elements
wider than the pitch miss what g gains from their spacing to the pitch, which the data say. What no point says
is taken from the last octave that they do: g at twice the pitch against g at the pitch. The approach and,
twice over, the maximum pressure are taken to move by the same share, which decimated maps confirm.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from refimpl.errors import InputError
from refimpl.grid import Array, Grid
from refimpl.scene.scene import Scene
from refimpl.surfaces import Sphere
from refimpl.surfaces.surface import Surface

MOST_ELEMENTS = 4  # between points of the data: the surface between them is interpolated, and smooth there
_OCTAVES = 1.5  # changes as of the last octave, of which a bar holds this many
_MOST_POINTS = 2048  # a side, of a map whose gradients are computed


def data_error(scene: Scene, grid: Grid) -> float:
    """Return the share of the contact area that the data leave open; 0 without measured parts."""
    parts = [part for name in ("lower", "upper") for part in scene.parts(name)]
    measured = [part for part in parts if part.pitch(grid.lengths) is not None]
    if not measured:
        return 0.0
    formulas = [part for part in parts if part not in measured and not isinstance(part, Sphere)]
    other = sum(_squared_gradient(part.sample(grid), grid) for part in formulas)
    at_grid, at_pitch, above = (sum(squares) for squares in zip(*_squares(measured, grid), strict=True))
    if at_pitch + other == 0:
        return 0.0
    missed, unseen = (1 - math.sqrt(min(1.0, (s + other) / (at_pitch + other))) for s in (at_grid, above))
    return missed + _OCTAVES * unseen


def finest_by_data(scene: Scene) -> float:
    """Return the elements along the longer side at four a pitch; infinite without measured parts."""
    parts = [part for name in ("lower", "upper") for part in scene.parts(name)]
    pitches = [pitch for part in parts if (pitch := part.pitch(scene.lengths)) is not None]
    return MOST_ELEMENTS * max(scene.lengths) / min(pitches) if pitches else math.inf


def _squares(measured: list[Surface], grid: Grid) -> Iterator[tuple[float, float, float]]:
    """Mean square gradients of each part: on the grid, at its pitch, and at twice its pitch."""
    for part in measured:
        pitch = part.pitch(grid.lengths) or 1.0
        counts = [min(_MOST_POINTS, max(2, round(length / pitch))) for length in grid.lengths]
        fine = Grid((counts[0], counts[1]), grid.lengths, grid.periodic)
        try:
            z = part.sample(fine)
        except InputError:  # arrays of a few points have no other grid
            fine, z = grid, part.sample(grid)
        at_pitch, above = _squared_gradient(z, fine), _squared_gradient(z, fine, points=2)
        wider = max(grid.spacings) > pitch
        yield (_squared_gradient(part.sample(grid), grid) if wider else at_pitch), at_pitch, above


def _squared_gradient(z: Array, grid: Grid, points: int = 1) -> float:
    """Mean square of the differences between points so many apart over their distance, both axes."""
    total = 0.0
    for values, spacing in zip((z, z.T), grid.spacings, strict=True):
        around = np.concatenate([values, values[: points * grid.periodic]])
        if len(around) > points:
            total += float(((around[points:] - around[:-points]) ** 2).mean()) / (points * spacing) ** 2
    return total
