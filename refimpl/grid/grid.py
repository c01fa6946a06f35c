"""The square grid of traction elements; element centres at (i + 1/2) side / M."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from refimpl.errors import InputError, keep_doubles, require_size

Array = NDArray[np.float64]

_ONE_THREAD = 10_000  # numbers whose product OpenBLAS sums by one thread


def inner(a: Array, b: Array) -> float:
    """``sum a b`` of two fields: the same to the last bit on any number of threads.

    BLAS is quickest, but splits long sums over its threads, which changes the last bits: those go row by row.

    >>> inner(np.ones((2, 3)), np.full((2, 3), 2.0))
    12.0
    """
    if a.size <= _ONE_THREAD:
        return float(np.vdot(a, b))
    rows = np.vecdot(a, b) if a.shape[1] <= _ONE_THREAD else np.einsum("ij,ij->i", a, b)
    return float(rows.sum())


@dataclass(frozen=True)
class Grid:
    """``M x M`` square elements on a square of edge ``side`` (m).

    >>> Grid(side=1.0, M=4).centres
    array([0.125, 0.375, 0.625, 0.875])
    """

    side: float
    M: int

    def __post_init__(self) -> None:
        if not (isinstance(self.M, int | np.integer) and not isinstance(self.M, bool) and self.M >= 1):
            raise InputError("grid", self.M, "a whole number of elements per side, at least 1")
        require_size("side", self.side, "a positive length in m")
        keep_doubles(self, "side")
        object.__setattr__(self, "M", int(self.M))

    @property
    def spacing(self) -> float:
        """Edge of one element (m)."""
        return self.side / self.M

    @property
    def element_area(self) -> float:
        """Area dA of one element (m^2)."""
        return self.spacing**2

    @property
    def centres(self) -> Array:
        """Element centres along one axis, shape ``(M,)`` (m)."""
        return (np.arange(self.M, dtype=np.float64) + 0.5) * self.spacing


def resampled(values: Array, M: int) -> Array:
    """Bilinear interpolation from element centres to those of M per side, level beyond the outermost.

    >>> resampled(np.array([[0.0, 8.0], [0.0, 8.0]]), 4)[0]
    array([0., 2., 6., 8.])
    """
    n = len(values)
    if n == M:
        return values
    if n == 2 * M:
        return _halved(_halved(values).T).T
    place = np.clip((np.arange(M) + 0.5) * (n / M) - 0.5, 0, n - 1)
    left = np.minimum(place.astype(np.intp), n - 2)
    share = place - left
    rows = (1 - share)[:, None] * values[left]
    rows += share[:, None] * values[left + 1]
    found: Array = (1 - share) * rows.take(left, axis=1)
    found += share * rows.take(left + 1, axis=1)
    return found


def _halved(values: Array) -> Array:
    """Means of pairs of rows."""
    found: Array = values[::2] + values[1::2]
    found *= 0.5
    return found


def differences(values: Array, axis: int) -> Array:
    """Central differences from element to element, one-sided at the border; zero where there is one.

    NumPy's gradient to the last bit, at a quarter of its seconds along both axes of 256 x 256 elements.

    >>> differences(np.array([[0.0, 1.0, 4.0, 9.0]]), axis=1)
    array([[1., 2., 4., 5.]])
    """
    if values.shape[axis] == 1:
        return np.zeros_like(values)
    found = np.empty_like(values)
    z, d = (values, found) if axis == 0 else (values.T, found.T)
    np.subtract(z[2:], z[:-2], out=d[1:-1])
    d[1:-1] *= 0.5
    np.subtract(z[1], z[0], out=d[0])
    np.subtract(z[-1], z[-2], out=d[-1])
    return found
