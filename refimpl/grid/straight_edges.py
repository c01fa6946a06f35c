"""Straight edges of a contact: runs of element faces that come in and out together.

An edge along a direction v of small whole numbers of elements meets the element centres in the same way after
every step v, so its errors do not cancel: a whole edge is in contact or not at once. With a step w of
``det(v, w) = +-1`` every element is ``s v + t w``, and such an edge is a run of faces between two lines of
elements along s. Along an axis these are the faces of elements; on a strip along (3, 2) there is one for five
of them. Where an edge crosses lines, the runs follow one another and their errors cancel. What counts is how
far a run is longer than those at its ends: on a strip that is all of it, on a large disc a quarter.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from refimpl.grid.fields import Mask
from refimpl.grid.grid import Grid

Indices = NDArray[np.intp]
Field = NDArray[np.int8]  # 1 in contact, 0 without, `_OUTSIDE` beyond the domain
Steps = Sequence[tuple[tuple[int, int], tuple[int, int]]]  # v and w

_OUTSIDE = 2
_SHORTEST = 3  # faces; a shorter run is never longer than those at its ends
_CROSSING = 2  # faces of a run where an edge crosses the axis
_REACH = 3  # elements of the longest step
_AT_ONCE = 100_000  # elements times steps in one table; larger tables are no quicker
_AXES: Steps = ((0, 1), (1, 0)), ((1, 0), (0, 1))
_BETWEEN: Steps = (
    ((1, 1), (0, 1)), ((1, -1), (0, 1)),
    ((2, 1), (1, 1)), ((2, -1), (1, -1)), ((1, 2), (1, 1)), ((1, -2), (1, -1)),
    ((3, 1), (1, 0)), ((3, -1), (1, 0)), ((1, 3), (0, 1)), ((1, -3), (0, 1)),
    ((3, 2), (1, 1)), ((3, -2), (1, -1)), ((2, 3), (1, 1)), ((2, -3), (1, -1)),
)  # fmt: skip
"""On a disc the share of direction v in the variance falls as ``|v|^-3``: 2 % at (3, 2)."""


@dataclass(frozen=True)
class StraightEdges:
    """Straight edges by number of ``runs`` and sum of ``squares`` of their lengths.

    ``faces`` are those along the axes that a run has beyond two: from there on edges run along the axis
    rather than between the axes. Where a run closes on itself all of them count.
    """

    faces: int
    runs: int
    squares: int


NO_STRAIGHT_EDGES = StraightEdges(0, 0, 0)


def straight_edges(contact: Mask, grid: Grid) -> StraightEdges:
    """Return the straight edges of a contact, an array of the grid's shape.

    >>> strip = np.zeros((8, 8), dtype=bool)
    >>> strip[3:5] = True
    >>> straight_edges(strip, Grid.square(1.0, 8, periodic=True))
    StraightEdges(faces=16, runs=2, squares=128)
    >>> straight_edges(np.pad([[True, True], [True, True]], 3), Grid.square(1.0, 8))
    StraightEdges(faces=0, runs=0, squares=0)
    """
    near, field = _near_edge(contact), contact.astype(np.int8)
    if not near[0].size:
        return NO_STRAIGHT_EDGES
    if not grid.periodic:
        field = np.pad(field, (0, _REACH), constant_values=_OUTSIDE)
    axes = _Runs(field, near, _AXES)
    if field.shape[0] != field.shape[1]:  # between the axes lines close on squares alone
        padding = [(0, max(field.shape) + _REACH - count) for count in field.shape]
        field = np.pad(field, padding, constant_values=_OUTSIDE)
    several = max(1, _AT_ONCE // near[0].size)
    between = (_BETWEEN[k : k + several] for k in range(0, len(_BETWEEN), several))
    straight = np.concatenate([axes.excess(), *(_Runs(field, near, steps).excess() for steps in between)])
    faces = int(axes.beyond(_CROSSING).sum())
    return StraightEdges(faces, int(np.count_nonzero(straight)), int((straight**2).sum()))


def _near_edge(contact: Mask) -> Sequence[Indices]:
    """Return i and j of the elements in contact within `_REACH` of one without, also across a border."""
    inside = contact
    for axis in (0, 1):
        for shift in (1, _REACH - 1, -_REACH):
            inside = inside & np.roll(inside, shift, axis)
    return np.divmod(np.flatnonzero(contact & ~inside), contact.shape[1])


def _faces(field: Field, near: Sequence[Indices], v: Indices, w: Indices) -> tuple[Indices, ...]:
    """Return direction, line t, position s and side of the faces between an element and that at w from it.

    The side is 0 where the element itself is in contact, 1 where the other is.
    """
    wide, width = np.pad(field, _REACH, mode="wrap").ravel(), field.shape[1] + 2 * _REACH
    here = (near[0] + _REACH) * width + near[1] + _REACH
    away = np.multiply.outer(w[0] * width + w[1], [1, -1])[..., None]
    way, side, place = np.unravel_index(np.flatnonzero(wide[here + away] == 0), (*away.shape[:2], here.size))
    (i, j), v, w = (index[place] for index in near), v.take(way, axis=1), w.take(way, axis=1)
    det = v[0] * w[1] - v[1] * w[0]
    return way, det * (v[0] * j - v[1] * i) - side, det * (w[1] * i - w[0] * j), side


class _Runs:
    """Runs of faces along v, a row each: direction, line, position and side of its first face, and length.

    Directions are v, w and w, v of each step. Lines close: a run that goes on at the beginning of its line
    has two rows, each with the length of both. The last row of ``last`` and ``length`` is of no run.
    """

    def __init__(self, field: Field, near: Sequence[Indices], steps: Steps) -> None:
        v, w = np.transpose([pair for v, w in steps for pair in ((v, w), (w, v))], (1, 2, 0))
        self.lines, self.count = (np.where(step[0], *field.shape) for step in (w, v))
        span = max(field.shape) + 1  # keys of two lines do not follow one another
        self.shape = 2 * len(steps), span, span, 2
        keys = np.sort(self.keys(*_faces(field, near, v, w)))
        new = np.ones(keys.size + 1, dtype=bool)
        new[1:-1] = np.diff(keys) != 2
        self.first, self.last = keys[new[:-1]], np.append(keys[new[1:]], -1)
        self.length = np.append((self.last[:-1] - self.first) // 2 + 1, 0)
        self.rows = way, line, position, side = np.unravel_index(self.first, self.shape)
        heads = np.flatnonzero(position == 0)
        tails = self.row(way[heads], line[heads], -1, side[heads])
        heads, tails = np.compress((tails >= 0) & (tails != heads), [heads, tails], axis=1)
        self.length[tails] += self.length[heads]
        self.length[heads] = self.length[tails]
        long = (self.length[:-1] >= _SHORTEST) | (self.length[:-1] == self.count[way])
        long[heads] = False
        self.long = np.flatnonzero(long & (way % 2 == 0))

    def keys(self, way: Indices, line: Indices, position: Indices | int, side: Indices) -> Indices:
        """Return the keys of faces, which rise along lines."""
        place = way, line % self.lines[way], position % self.count[way], side
        return np.ravel_multi_index(place, self.shape)

    def row(self, way: Indices, line: Indices, position: Indices | int, side: Indices) -> Indices:
        """Return the row of the run through each of these faces, -1 where there is none."""
        keys = self.keys(way, line, position, side)
        row = np.searchsorted(self.first, keys, side="right") - 1
        left = self.last[row] - keys
        return np.where((left >= 0) & (left % 2 == 0), row, -1)

    def beyond(self, other: Indices | int) -> Indices:
        """Return how far each long run is longer than another length, and all of a run that closes."""
        length, whole = self.length[self.long], self.count[self.rows[0][self.long]]
        return np.where(length == whole, length, np.maximum(length - other, 0))

    def excess(self) -> Indices:
        """Return how far each long run is longer than those at its ends: on lines beside it, or across."""
        way, line, position, side = (index[self.long] for index in self.rows)
        step, two = np.array([[-1], [1]]), np.arange(2)[:, None, None]
        end = np.array([position, position + self.length[self.long] - 1])
        on = self.length[self.row(way, line + 2 * two - 1, end + step, side)].max(axis=0)
        corner = np.minimum(end, end + step)
        turn = self.length[self.row(way + 1, corner, line + two[:, None], two)].max(axis=(0, 1))
        return self.beyond((on + turn).sum(axis=0))
