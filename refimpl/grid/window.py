"""A rectangle of elements: the part of the grid that a convolution works on."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.fft as sfft
from numpy.typing import NDArray


@dataclass(frozen=True)
class Window:
    """Elements ``[i0, i1) x [j0, j1)`` of a grid.

    >>> Window(2, 5, 0, 4).shape
    (3, 4)
    """

    i0: int
    i1: int
    j0: int
    j1: int

    @classmethod
    def full(cls, M: int) -> Window:
        """The whole ``M x M`` grid."""
        return cls(0, M, 0, M)

    @classmethod
    def around(cls, where: NDArray[np.bool_], margin: int) -> Window:
        """The bounding box of the true elements, widened by ``margin`` within the grid."""
        rows, columns = np.flatnonzero(where.any(axis=1)), np.flatnonzero(where.any(axis=0))
        if not rows.size:
            return cls.full(len(where))
        return cls(
            max(0, int(rows[0]) - margin),
            min(where.shape[0], int(rows[-1]) + 1 + margin),
            max(0, int(columns[0]) - margin),
            min(where.shape[1], int(columns[-1]) + 1 + margin),
        )

    def filling(self, M: int) -> Window:
        """The window within an ``M x M`` grid, widened as far as its convolution costs no more.

        A window of n elements a side is padded to the least fast length of ``2 n - 1`` or more.
        """
        i0, i1 = _filled(self.i0, self.i1, M)
        j0, j1 = _filled(self.j0, self.j1, M)
        return Window(i0, i1, j0, j1)

    def interior(self, M: int) -> Window:
        """The window without its edge, but where that is the edge of the ``M x M`` grid."""
        return Window(
            self.i0 + (self.i0 > 0), self.i1 - (self.i1 < M), self.j0 + (self.j0 > 0), self.j1 - (self.j1 < M)
        )

    def on_edge(self, where: NDArray[np.bool_], M: int) -> bool:
        """Whether elements of the window are true on its edge, where that is not the grid's."""
        inside = self.interior(M)
        marked = where.copy()
        marked[inside.i0 - self.i0 : inside.i1 - self.i0, inside.j0 - self.j0 : inside.j1 - self.j0] = False
        return bool(marked.any())

    @property
    def shape(self) -> tuple[int, int]:
        """Numbers of elements along x and y."""
        return self.i1 - self.i0, self.j1 - self.j0

    @property
    def slices(self) -> tuple[slice, slice]:
        """Index of the window in an array of the grid's shape."""
        return slice(self.i0, self.i1), slice(self.j0, self.j1)

    def mask(self, M: int) -> NDArray[np.bool_]:
        """True on the window, in an ``(M, M)`` array."""
        return self.spread(np.ones(self.shape, dtype=bool), M)

    def spread(self, values: NDArray[Any], M: int) -> NDArray[Any]:
        """``(M, M)`` array with the window's values, zero elsewhere."""
        full = np.zeros((M, M), dtype=values.dtype)
        full[self.slices] = values
        return full


def padded_length(n: int) -> int:
    """The least even fast length of at least ``n``."""
    return 2 * int(sfft.next_fast_len((n + 1) // 2, real=True))


def _filled(start: int, stop: int, M: int) -> tuple[int, int]:
    size = min(M, padded_length(2 * (stop - start) - 1) // 2)
    start = min(max(0, start - (size - (stop - start)) // 2), M - size)
    return start, start + size
