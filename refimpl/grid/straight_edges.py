"""Straight edges of a contact: runs of element faces that come in and out together.

An edge along a direction v of small whole numbers of elements meets the element centres in the same way after
every step v, so its errors do not cancel: a whole edge is in contact or not at once. With a step w of
``det(v, w) = +-1`` every element is ``s v + t w``, and such an edge is a run of faces between two lines of
elements along s. Along an axis these are the faces of elements; on a strip along (3, 2) there is one for five
of them. Where an edge crosses lines, the runs follow one another and their errors cancel. What counts is how
far a run is longer than those at its ends: on a strip that is all of it, on a large disc a quarter.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from refimpl.grid.fields import Mask
from refimpl.grid.grid import Grid

Indices = NDArray[np.intp]
Field = NDArray[np.int8]  # 1 in contact, 0 without, `_OUTSIDE` beyond the domain
Step = tuple[int, int]

_OUTSIDE = 2
_SHORTEST = 3  # faces; a shorter run is never longer than those at its ends
_CROSSING = 2  # faces of a run where an edge crosses the axis
_AXES: tuple[tuple[Step, Step], ...] = ((0, 1), (1, 0)), ((1, 0), (0, 1))
_BETWEEN: tuple[tuple[Step, Step], ...] = (
    ((1, 1), (0, 1)), ((1, -1), (0, 1)),
    ((2, 1), (1, 1)), ((2, -1), (1, -1)), ((1, 2), (1, 1)), ((1, -2), (1, -1)),
    ((3, 1), (1, 0)), ((3, -1), (1, 0)), ((1, 3), (0, 1)), ((1, -3), (0, 1)),
    ((3, 2), (1, 1)), ((3, -2), (1, -1)), ((2, 3), (1, 1)), ((2, -3), (1, -1)),
)  # fmt: skip
"""Steps v and w. On a disc the share of direction v in the variance falls as ``|v|^-3``: 2 % at (3, 2)."""


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
    field = contact.astype(np.int8)
    if not grid.periodic:
        field = np.pad(field, (0, 1), constant_values=_OUTSIDE)
    axes = [_Runs.of(field, v, w) for v, w in _AXES]
    lengths = [axes[0].excess(axes[1]), axes[1].excess(axes[0])]
    if field.shape[0] != field.shape[1]:  # between the axes lines close on squares alone
        padding = [(0, max(field.shape) + 1 - count) for count in field.shape]
        field = np.pad(field, padding, constant_values=_OUTSIDE)
    lengths += [_Runs.of(field, v, w).excess(_Runs.of(field, w, v)) for v, w in _BETWEEN]
    straight = np.concatenate(lengths)
    faces = sum(int(runs.beyond(_CROSSING).sum()) for runs in axes)
    return StraightEdges(faces, int(np.count_nonzero(straight)), int((straight**2).sum()))


@dataclass(frozen=True)
class _Runs:
    """Runs along v of faces between an element and the one at w from it, by first and last position s.

    ``side`` is 0 where the element itself is in contact, 1 where the other is. Lines close: a run may begin
    before position 0. ``keys`` of all faces rise, ``run_of`` is the run of each.
    """

    lines: int
    count: int
    keys: Indices
    run_of: Indices
    line: Indices
    first: Indices
    last: Indices
    side: Indices

    @classmethod
    def of(cls, field: Field, v: Step, w: Step) -> _Runs:
        """Return the runs of a field."""
        other = np.roll(field, (-w[0], -w[1]), axis=(0, 1))
        i, j = np.nonzero(field + other == 1)
        det = v[0] * w[1] - v[1] * w[0]
        lines, count = field.shape[0 if w[0] else 1], field.shape[0 if v[0] else 1]
        line, position = det * (v[0] * j - v[1] * i) % lines, det * (w[1] * i - w[0] * j) % count
        keys = np.sort((line * count + position) * 2 + other[i, j])
        new = np.ones(keys.size + 1, dtype=bool)
        new[1:-1] = (np.diff(keys) != 2) | (keys[1:] // 2 % count == 0)
        first, last = keys[np.flatnonzero(new[:-1])], keys[np.flatnonzero(new[1:])]
        line, side, first, last = first // 2 // count, first % 2, first // 2 % count, last // 2 % count
        # a run at the end of a line goes on at its beginning
        heads, tails = (np.flatnonzero(np.diff(line, **{end: -1})) for end in ("prepend", "append"))
        joined = (
            (first[heads] == 0) & (last[tails] == count - 1) & (side[heads] == side[tails]) & (heads < tails)
        )
        heads, tails = heads[joined], tails[joined]
        first[heads] = first[tails] - count
        kept, to = np.ones(line.size, dtype=bool), np.arange(line.size)
        kept[tails], to[tails] = False, heads
        run_of = (np.cumsum(kept) - 1)[to][np.cumsum(new[:-1]) - 1]
        return cls(lines, count, keys, run_of, line[kept], first[kept], last[kept], side[kept])

    @property
    def length(self) -> Indices:
        """Number of faces of each run."""
        return self.last - self.first + 1

    def length_at(self, line: Indices, position: Indices, side: Indices | int) -> Indices:
        """Return the length of the run through each of these faces, 0 where there is none."""
        if not self.keys.size:
            return np.zeros_like(line)
        wanted = (line % self.lines * self.count + position % self.count) * 2 + side
        place = np.minimum(np.searchsorted(self.keys, wanted), self.keys.size - 1)
        return np.where(self.keys[place] == wanted, self.length[self.run_of[place]], 0)

    def beyond(self, other: Indices | int) -> Indices:
        """Return how far each run is longer than another length, and all of a run that closes."""
        return np.where(self.length == self.count, self.length, np.maximum(self.length - other, 0))

    def excess(self, across: _Runs) -> Indices:
        """Return how far each run is longer than those at its ends: on the lines beside it, or ``across``."""
        long = np.flatnonzero(self.length >= _SHORTEST)
        line, side, ends = self.line[long], self.side[long], self.length.copy()
        ends[long] = 0
        for end, step in ((self.first[long], -1), (self.last[long], 1)):
            on = [self.length_at(line + up, end + step, side) for up in (-1, 1)]
            corner = np.minimum(end, end + step)
            turn = [across.length_at(corner, line + up, other) for up in (0, 1) for other in (0, 1)]
            ends[long] += np.maximum(*on) + np.maximum.reduce(turn)
        return self.beyond(ends)
