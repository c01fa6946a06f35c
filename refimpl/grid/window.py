"""A rectangle of elements: the part of the grid that a convolution works on."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy
from numpy.typing import NDArray

Shape = tuple[int, int]


@dataclass(frozen=True)
class Window:
    """Elements ``[i0, i1) x [j0, j1)`` of a grid."""

    i0: int
    i1: int
    j0: int
    j1: int

    @classmethod
    def full(cls, shape: Shape) -> Window:
        """Return the window that is the whole grid."""
        return cls(0, shape[0], 0, shape[1])

    @classmethod
    def around(cls, where: NDArray[np.bool_], margin: int) -> Window:
        """Return the true elements' bounding box, ``margin`` wider; the whole grid where none is true."""
        rows, columns = np.flatnonzero(where.any(axis=1)), np.flatnonzero(where.any(axis=0))
        if not rows.size:
            return cls.full((where.shape[0], where.shape[1]))
        return cls(
            max(0, int(rows[0]) - margin),
            min(where.shape[0], int(rows[-1]) + 1 + margin),
            max(0, int(columns[0]) - margin),
            min(where.shape[1], int(columns[-1]) + 1 + margin),
        )

    def filling(self, shape: Shape) -> Window:
        """Return the window widened within a grid as far as its transform's fast length goes."""
        return Window(*_filled(self.i0, self.i1, shape[0]), *_filled(self.j0, self.j1, shape[1]))

    def interior(self, shape: Shape) -> Window:
        """Return the window without its edge, but where that is the edge of the grid."""
        return Window(
            self.i0 + (self.i0 > 0),
            self.i1 - (self.i1 < shape[0]),
            self.j0 + (self.j0 > 0),
            self.j1 - (self.j1 < shape[1]),
        )

    def on_edge(self, where: NDArray[np.bool_], shape: Shape) -> bool:
        """Return whether elements of the window are true on its edge, where that is not the grid's."""
        inside = self.interior(shape)
        marked = where.copy()
        marked[inside.i0 - self.i0 : inside.i1 - self.i0, inside.j0 - self.j0 : inside.j1 - self.j0] = False
        return bool(marked.any())

    @property
    def shape(self) -> Shape:
        """Numbers of elements along x and y."""
        return self.i1 - self.i0, self.j1 - self.j0

    @property
    def slices(self) -> tuple[slice, slice]:
        """Index of the window in an array of the grid's shape."""
        return slice(self.i0, self.i1), slice(self.j0, self.j1)

    def mask(self, shape: Shape) -> NDArray[np.bool_]:
        """Return an array of the grid's shape, true on the window."""
        return self.spread(np.ones(self.shape, dtype=bool), shape)

    def spread(self, values: NDArray[Any], shape: Shape) -> NDArray[Any]:
        """Return an array of the grid's shape with the window's values, zero elsewhere."""
        full = np.zeros(shape, dtype=values.dtype)
        full[self.slices] = values
        return full


def padded_length(n: int) -> int:
    """Return the least even fast length of a transform of at least ``n`` points."""
    return 2 * int(scipy.fft.next_fast_len((n + 1) // 2, real=True))


def _filled(start: int, stop: int, count: int) -> tuple[int, int]:
    size = min(count, padded_length(2 * (stop - start) - 1) // 2)
    start = min(max(0, start - (size - (stop - start)) // 2), count - size)
    return start, start + size
