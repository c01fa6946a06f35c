"""Influence coefficients as dense matrices: the plain reference, to be believed by reading."""

from __future__ import annotations

import math
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from refimpl.grid import Array, Grid
from refimpl.kernels import normal_integral, tangential_integral


class DenseInfluence:
    """The matrices of Eq. (7), of as many rows and columns as elements; element ``i My + j`` at row and
    column.

    >>> operator = DenseInfluence(Grid.square(1.0, 3), direction=0.0)
    >>> bool(np.all(operator.shear_matrix == -operator.shear_matrix.T))    # c is odd
    True
    """

    def __init__(self, grid: Grid, direction: float) -> None:
        self.grid = grid
        self.direction = direction
        self.displaces_mean = not grid.periodic

    @cached_property
    def normal_matrix(self) -> Array:
        """``I[1/rho]`` between all pairs of elements (m), symmetric."""
        if self.grid.periodic:
            return self._from_symbol(None)
        return self._pairs(normal_integral(*self._offsets, *self.grid.spacings))

    @cached_property
    def shear_matrix(self) -> Array:
        """``I[s/rho^2]`` between all pairs, ``s`` along the sliding direction (m), skew."""
        return self._along(self.direction)

    @cached_property
    def shear_across_matrix(self) -> Array:
        """``I[t/rho^2]`` between all pairs, ``t`` across the sliding direction (m), skew."""
        return self._along(self.direction + math.pi / 2)

    def normal(self, pressure: Array) -> Array:
        """``I[1/rho]`` applied to a pressure."""
        return (self.normal_matrix @ pressure.ravel()).reshape(pressure.shape)

    def shear(self, traction: Array) -> Array:
        """``I[s/rho^2]`` applied to a traction along the sliding direction."""
        return (self.shear_matrix @ traction.ravel()).reshape(traction.shape)

    def shear_across(self, traction: Array) -> Array:
        """``I[t/rho^2]`` applied to a traction across the sliding direction."""
        return (self.shear_across_matrix @ traction.ravel()).reshape(traction.shape)

    @property
    def _offsets(self) -> tuple[Array, Array]:
        """All offsets between centres along x (a column) and y (a row) (m)."""
        along = (
            np.arange(1 - count, count, dtype=np.float64) * edge
            for count, edge in zip(self.grid.shape, self.grid.spacings, strict=True)
        )
        x, y = along
        return x[:, None], y[None, :]

    def _along(self, angle: float) -> Array:
        if self.grid.periodic:
            return self._from_symbol(angle)
        (x, y), (dx, dy) = self._offsets, self.grid.spacings
        along_x, along_y = tangential_integral(x, y, dx, dy), tangential_integral(y, x, dy, dx)
        return self._pairs(math.cos(angle) * along_x + math.sin(angle) * along_y)

    def _pairs(self, by_offset: Array) -> Array:
        """Matrix over pairs (field, source) from values over the ``(2 Mx - 1, 2 My - 1)`` offsets."""
        n, m = self.grid.shape
        i, j = np.divmod(np.arange(n * m), m)
        pairs: Array = by_offset[i[:, None] - i[None, :] + n - 1, j[:, None] - j[None, :] + m - 1]
        return pairs

    def _from_symbol(self, angle: float | None) -> Array:
        """Periodic matrix by summing the Fourier modes one by one: ``2 pi/q`` or ``-2 pi i q_s/q^2``."""
        (q_x, odd_x, wave_x), (q_y, odd_y, wave_y) = self._modes(0), self._modes(1)
        squared = q_x[:, None] ** 2 + q_y[None, :] ** 2
        squared[squared == 0] = np.inf  # the mean pressure displaces nothing
        if angle is None:
            symbol = 2 * np.pi / np.sqrt(squared) + 0j
        else:
            q_s = math.cos(angle) * odd_x[:, None] + math.sin(angle) * odd_y[None, :]
            symbol = -2j * np.pi * q_s / squared
        return self._pairs(np.real(wave_x.T @ symbol @ wave_y) / self.grid.elements)

    def _modes(self, axis: int) -> tuple[Array, Array, NDArray[np.complex128]]:
        """Wavenumbers along an axis (1/m), the same of odd fields, and ``exp(i q s)`` at all offsets s."""
        count, length = self.grid.shape[axis], self.grid.lengths[axis]
        modes = np.arange(count) - count // 2
        q: Array = (2 * np.pi / length) * modes.astype(np.float64)
        odd: Array = np.where(
            2 * modes == -count, 0.0, q
        )  # a real field has no sine at the Nyquist frequency
        steps = np.arange(1 - count, count) * self.grid.spacings[axis]
        return q, odd, np.exp(1j * q[:, None] * steps[None, :])
