"""The grid of traction elements: its shape, lengths and topology. Everything else asks it for these."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
import scipy

from refimpl.errors import InputError, is_whole, require_size
from refimpl.grid.fields import Array, Mask, differences
from refimpl.grid.window import Window

MAX_COUNT = 10**9  # elements a side; products of two are whole numbers of 64 bits
_ROUNDING = 1e-15  # relative difference of two edges: each is a quotient of rounded numbers


@dataclass(frozen=True)
class Grid:
    """``Mx x My`` equal elements on a rectangle ``Lx x Ly`` (m), free or doubly periodic.

    Element ``[i, j]`` has its centre at ``((i + 1/2) dx, (j + 1/2) dy)``.

    Raises `InputError` unless both counts are whole and positive and both lengths positive.

    >>> grid = Grid((4, 2), (1.0, 1.0))
    >>> grid.x, grid.y
    (array([0.125, 0.375, 0.625, 0.875]), array([0.25, 0.75]))
    """

    shape: tuple[int, int]
    lengths: tuple[float, float]
    periodic: bool = False

    def __post_init__(self) -> None:
        for count in self.shape:
            if not (is_whole(count) and 1 <= count <= MAX_COUNT):
                allowed = f"a whole number of elements per side, 1 to {MAX_COUNT}"
                raise InputError("grid", count, allowed)
        for length in self.lengths:
            require_size("side", length, "a positive length in m")
        object.__setattr__(self, "shape", tuple(int(count) for count in self.shape))
        object.__setattr__(self, "lengths", tuple(float(length) for length in self.lengths))

    @classmethod
    def square(cls, side: float, M: int, *, periodic: bool = False) -> Grid:
        """Return ``M x M`` elements on a square of edge ``side`` (m)."""
        return cls((M, M), (side, side), periodic)

    @property
    def spacings(self) -> tuple[float, float]:
        """Edges ``(dx, dy)`` of an element (m)."""
        return self.lengths[0] / self.shape[0], self.lengths[1] / self.shape[1]

    @property
    def aspect(self) -> float:
        """``dy / dx``: exactly 1 where the edges differ by rounding of lengths and quotients alone.

        >>> Grid((3, 2), (0.3, 0.2)).spacings, Grid((3, 2), (0.3, 0.2)).aspect
        ((0.09999999999999999, 0.1), 1.0)
        """
        dx, dy = self.spacings
        return 1.0 if math.isclose(dx, dy, rel_tol=_ROUNDING) else dy / dx

    @property
    def element_area(self) -> float:
        """Area dA of one element (m^2)."""
        dx, dy = self.spacings
        return dx * dy

    @property
    def element_size(self) -> float:
        """``sqrt(dx dy)``: the edge of a square element of the same area (m)."""
        return math.sqrt(self.element_area)

    @property
    def size(self) -> float:
        """``sqrt(Lx Ly)``: the edge of a square of the same area (m)."""
        return math.sqrt(self.lengths[0] * self.lengths[1])

    @property
    def nominal_area(self) -> float:
        """Area of the domain A0 (m^2)."""
        return self.lengths[0] * self.lengths[1]

    @property
    def elements(self) -> int:
        """Number of elements."""
        return self.shape[0] * self.shape[1]

    @property
    def x(self) -> Array:
        """Element centres along x, shape ``(Mx,)`` (m)."""
        return self._centres(0)

    @property
    def y(self) -> Array:
        """Element centres along y, shape ``(My,)`` (m)."""
        return self._centres(1)

    def _centres(self, axis: int) -> Array:
        return (np.arange(self.shape[axis], dtype=np.float64) + 0.5) * self.spacings[axis]

    def refined(self, shape: tuple[int, int]) -> Grid:
        """Return the same domain with another number of elements."""
        return replace(self, shape=shape)

    @property
    def zeros(self) -> Array:
        """A field of zeros."""
        return np.zeros(self.shape)

    @property
    def taper(self) -> Array:
        """Weights of a field before its spectrum is taken: ones if periodic, cosine bells if free."""
        if self.periodic:
            return np.ones(self.shape)
        return np.outer(*(np.hanning(n + 2)[1:-1] for n in self.shape))

    @property
    def window(self) -> Window:
        """The whole grid."""
        return Window.full(self.shape)

    def window_around(self, where: Mask, margin: int) -> Window:
        """Return the bounding box of the marked elements with a margin; the whole grid if it is periodic."""
        return self.window if self.periodic else Window.around(where, margin)

    @property
    def transform_shape(self) -> tuple[int, int]:
        """Shape of a field's Fourier transform: a free grid has an empty margin of its own size."""
        scale = 1 if self.periodic else 2
        return scale * self.shape[0], scale * self.shape[1]

    def transform_shape_near(self, where: Mask) -> tuple[int, int]:
        """Return the shape of a transform with an empty margin of the marked elements' own size."""
        if self.periodic:
            return self.shape
        nx, ny = Window.around(where, margin=0).shape
        return scipy.fft.next_fast_len(self.shape[0] + nx), scipy.fft.next_fast_len(self.shape[1] + ny)

    def about_datum(self, heights: Array, weights: Array) -> Array:
        """Return heights about their mean plane if periodic, about their weighted mean on a free grid."""
        if self.periodic or not weights.any():
            return heights - float(heights.mean())
        return heights - float(np.sum(weights * heights) / np.sum(weights))

    def gradient(self, heights: Array) -> tuple[Array, Array]:
        """Return ``(dz/dx, dz/dy)`` by central differences, one-sided at a free border.

        ``heights`` (m) may be a window of the grid if the grid is free.

        >>> Grid((2, 3), (2.0, 6.0)).gradient(np.array([[0.0, 2, 4], [1.0, 3, 5]]))[1]
        array([[1., 1., 1.],
               [1., 1., 1.]])
        """
        along_x, along_y = (differences(heights, axis, periodic=self.periodic) for axis in (0, 1))
        along_x /= self.spacings[0]
        along_y /= self.spacings[1]
        return along_x, along_y

    def faces(self, contact: Mask) -> int:
        """Return the number of element faces between contact and no contact.

        The border of a free domain is no such face: where contact ends there it ends exactly.

        >>> corner = np.array([[True, False], [False, False]])
        >>> Grid((2, 2), (1.0, 1.0)).faces(corner), Grid((2, 2), (1.0, 1.0), periodic=True).faces(corner)
        (2, 4)
        """
        count = 0
        for rows in (contact, contact.T):
            count += int(np.count_nonzero(rows[1:] != rows[:-1]))
            count += int(np.count_nonzero(rows[0] != rows[-1])) if self.periodic else 0
        return count

    def on_border(self, where: Mask) -> int:
        """Return how many of the marked elements lie on the border of a free domain; 0 if periodic."""
        if self.periodic:
            return 0
        return int(np.count_nonzero(where)) - int(np.count_nonzero(where[1:-1, 1:-1]))

    def padded(self, field: Array, width: int) -> Array:
        """Return a field, or a window of it, with a frame: repeated if periodic, else its border values."""
        return np.pad(field, width, mode="wrap" if self.periodic else "edge")

    @property
    def continuation(self) -> Literal["wrap", "constant"]:
        """Mode by which NumPy and SciPy continue a contact beyond the domain: repeated, or by zeros."""
        return "wrap" if self.periodic else "constant"

    @property
    def band_limited(self) -> bool:
        """True if element values stand for their band-limited interpolant instead of constant pressures."""
        return self.periodic

    def __str__(self) -> str:
        return f"{self.shape[0]} x {self.shape[1]}"
