"""Influence coefficients as dense matrices: the plain reference, to be believed by reading."""

from __future__ import annotations

import math
from functools import cached_property

import numpy as np

from refimpl.grid import Array, Grid
from refimpl.kernels import normal_integral, tangential_integral


class DenseInfluence:
    """The matrices of Eq. (7), shape ``(M^2, M^2)``, element ``i M + j`` at row and column.

    >>> operator = DenseInfluence(Grid(side=1.0, M=3), direction=0.0)
    >>> bool(np.all(operator.shear_matrix == -operator.shear_matrix.T))    # c is odd
    True
    """

    def __init__(self, grid: Grid, direction: float, *, periodic: bool = False) -> None:
        self.grid = grid
        self.direction = direction
        self.periodic = periodic

    @cached_property
    def normal_matrix(self) -> Array:
        """``I[1/rho]`` between all pairs of elements (m), symmetric."""
        if self.periodic:
            return self._from_symbol(None)
        x, y, edge = self._offsets
        return self._pairs(normal_integral(x, y, edge, edge))

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
    def _offsets(self) -> tuple[Array, Array, float]:
        """All offsets ``-(M-1) ... M-1`` between centres along x and y (m), and the element's edge."""
        edge = self.grid.spacing
        steps = np.arange(1 - self.grid.M, self.grid.M, dtype=np.float64) * edge
        return steps[:, None], steps[None, :], edge

    def _along(self, angle: float) -> Array:
        cos, sin = math.cos(angle), math.sin(angle)
        if self.periodic:
            return self._from_symbol(angle)
        x, y, edge = self._offsets
        return self._pairs(
            cos * tangential_integral(x, y, edge, edge) + sin * tangential_integral(y, x, edge, edge)
        )

    def _pairs(self, by_offset: Array) -> Array:
        """Matrix over pairs (field, source) from values over the ``(2M-1, 2M-1)`` offsets."""
        M = self.grid.M
        i, j = np.divmod(np.arange(M * M), M)
        pairs: Array = by_offset[i[:, None] - i[None, :] + M - 1, j[:, None] - j[None, :] + M - 1]
        return pairs

    def _from_symbol(self, angle: float | None) -> Array:
        """Periodic matrix by summing the Fourier modes one by one: ``2 pi/q`` or ``-2 pi i q_s/q^2``."""
        M = self.grid.M
        modes = np.arange(M) - M // 2
        q = 2 * np.pi * modes / self.grid.side
        squared = q[:, None] ** 2 + q[None, :] ** 2
        squared[M // 2, M // 2] = np.inf  # the mean pressure displaces nothing
        if angle is None:
            symbol = 2 * np.pi / np.sqrt(squared) + 0j
        else:
            odd = np.where(2 * modes == -M, 0.0, q)  # a real field has no sine at the Nyquist frequency
            q_s = math.cos(angle) * odd[:, None] + math.sin(angle) * odd[None, :]
            symbol = -2j * np.pi * q_s / squared
        steps = np.arange(1 - M, M) * self.grid.spacing
        wave = np.exp(1j * q[:, None] * steps[None, :])
        return self._pairs(np.real(wave.T @ symbol @ wave) / M**2)
