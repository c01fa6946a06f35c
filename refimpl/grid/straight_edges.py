"""Straight edges of a contact along the grid: runs of element faces that come in and out together.

The edge of a contact is a staircase of runs of faces. Where it crosses rows of elements, the runs follow one
another and their errors cancel. Where it lies along a row - on a strip, a groove, or the flank of a long
patch - a whole run is in contact or not at once. What counts is how far a run is longer than those at its
ends: on a strip that is all of it, on a large disc a quarter.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from refimpl.grid.fields import Mask
from refimpl.grid.grid import Grid

Indices = NDArray[np.intp]


@dataclass(frozen=True)
class StraightEdges:
    """``faces`` in straight edges, ``runs`` that they form, and the sum of ``squares`` of their lengths."""

    faces: int
    runs: int
    squares: int


NO_STRAIGHT_EDGES = StraightEdges(0, 0, 0)


def straight_edges(contact: Mask, grid: Grid) -> StraightEdges:
    """Return the straight edges along the grid of a contact, an array of the grid's shape.

    On a periodic grid a run that crosses the row or column with the least contact counts as two.

    >>> strip = np.zeros((8, 8), dtype=bool)
    >>> strip[3:5] = True
    >>> straight_edges(strip, Grid.square(1.0, 8, periodic=True))
    StraightEdges(faces=16, runs=2, squares=128)
    >>> straight_edges(np.pad([[True, True], [True, True]], 3), Grid.square(1.0, 8))
    StraightEdges(faces=0, runs=0, squares=0)
    """
    if grid.periodic:
        for axis in (0, 1):
            contact = np.roll(contact, -int(contact.sum(axis=1 - axis).argmin()), axis)
    across, along = _Runs.of(contact, grid.periodic), _Runs.of(contact.T, grid.periodic)
    excess = np.concatenate([across.excess(along), along.excess(across)])
    straight = excess[excess > 0]
    return StraightEdges(int(straight.sum()), straight.size, int((straight**2).sum()))


@dataclass(frozen=True)
class _Runs:
    """Runs of faces between row ``line`` and the next one, by first and last position along the rows.

    ``side`` is 0 where the row itself is in contact, 1 where the next one is. ``keys`` of all faces rise;
    ``run_of`` is the run of each.
    """

    count: int
    keys: Indices
    run_of: Indices
    line: Indices
    first: Indices
    last: Indices
    side: Indices

    @classmethod
    def of(cls, contact: Mask, periodic: bool) -> _Runs:
        """Return the runs of a contact; those of a periodic one also between the last row and the first."""
        following = np.roll(contact, -1, axis=0) if periodic else contact[1:]
        line, position = np.nonzero(contact[: len(following)] != following)
        side = following[line, position].astype(np.intp)
        new = np.ones(line.size + 1, dtype=bool)
        new[1:-1] = (np.diff(line) != 0) | (np.diff(position) != 1) | (np.diff(side) != 0)
        first, last = np.flatnonzero(new[:-1]), np.flatnonzero(new[1:])
        count = contact.shape[1]
        return cls(
            count=count,
            keys=(line * count + position) * 2 + side,
            run_of=np.cumsum(new[:-1]) - 1,
            line=line[first],
            first=position[first],
            last=position[last],
            side=side[first],
        )

    @property
    def length(self) -> Indices:
        """Number of faces of each run."""
        return self.last - self.first + 1

    def length_at(self, line: Indices, position: Indices, side: Indices) -> Indices:
        """Return the length of the run through each of these faces, 0 where there is none."""
        if not self.keys.size:
            return np.zeros_like(line)
        wanted = (line * self.count + position) * 2 + side
        place = np.minimum(np.searchsorted(self.keys, wanted), self.keys.size - 1)
        found = (self.keys[place] == wanted) & (position >= 0) & (position < self.count)
        return np.where(found, self.length[self.run_of[place]], 0)

    def excess(self, across: _Runs) -> Indices:
        """Return how far each run is longer than the runs at its ends: of the next rows, and ``across``."""
        beyond = np.zeros_like(self.line)
        for end, step in ((self.first, -1), (self.last, 1)):
            on = [self.length_at(self.line + up, end + step, self.side) for up in (-1, 1)]
            corner = np.minimum(end, end + step)
            turn = [
                across.length_at(corner, self.line + row, np.full_like(corner, side))
                for row in (0, 1)
                for side in (0, 1)
            ]
            beyond += np.maximum(*on) + np.maximum.reduce(turn)
        closed = self.length == self.count
        return np.where(closed, self.length, np.maximum(self.length - beyond, 0))
