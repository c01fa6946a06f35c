"""Influence coefficients as dense matrices: the plain reference, to be believed by reading."""

from __future__ import annotations

import math
from functools import cached_property

import numpy as np

from refimpl.grid import Array, Grid
from refimpl.kernels import normal_integral, tangential_integral


class DenseInfluence:
    """The square matrices of Eq. (7), element ``i My + j`` at row and column.

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
        return self._pairs(None)

    @cached_property
    def shear_matrix(self) -> Array:
        """``I[s/rho^2]`` between all pairs, ``s`` along the sliding direction (m), skew."""
        return self._pairs(self.direction)

    @cached_property
    def shear_across_matrix(self) -> Array:
        """``I[t/rho^2]`` between all pairs, ``t`` across the sliding direction (m), skew."""
        return self._pairs(self.direction + math.pi / 2)

    def normal(self, pressure: Array) -> Array:
        """Return ``I[1/rho]`` applied to a pressure."""
        return (self.normal_matrix @ pressure.ravel()).reshape(pressure.shape)

    def shear(self, traction: Array) -> Array:
        """Return ``I[s/rho^2]`` applied to a traction along the sliding direction."""
        return (self.shear_matrix @ traction.ravel()).reshape(traction.shape)

    def shear_across(self, traction: Array) -> Array:
        """Return ``I[t/rho^2]`` applied to a traction across the sliding direction."""
        return (self.shear_across_matrix @ traction.ravel()).reshape(traction.shape)

    def _pairs(self, angle: float | None) -> Array:
        """Return ``I[1/rho]``, or ``I[s/rho^2]`` with s at an angle, between all pairs (field, source)."""
        table = self._transformed(angle) if self.grid.periodic else self._integrated(angle)
        i, j = np.divmod(np.arange(self.grid.elements), self.grid.shape[1])
        pairs: Array = table[i[:, None] - i[None, :], j[:, None] - j[None, :]]  # negative: from the end
        return pairs

    def _integrated(self, angle: float | None) -> Array:
        """Return an element's integrals at offsets ``0 ... n - 1, 1 - n ... -1`` along both axes (m)."""
        (n, m), (dx, dy) = self.grid.shape, self.grid.spacings
        x, y = (np.r_[0:n, 1 - n : 0] * dx)[:, None], (np.r_[0:m, 1 - m : 0] * dy)[None, :]
        if angle is None:
            return normal_integral(x, y, dx, dy)
        along_x, along_y = tangential_integral(x, y, dx, dy), tangential_integral(y, x, dy, dx)
        return math.cos(angle) * along_x + math.sin(angle) * along_y

    def _transformed(self, angle: float | None) -> Array:
        """Return sums of the modes ``2 pi/q`` or ``-2 pi i q_s/q^2``, no mean, at offsets from 0 (m)."""
        axes = zip(self.grid.shape, self.grid.spacings, strict=True)
        q_x, q_y = np.meshgrid(*(2 * np.pi * np.fft.fftfreq(*axis) for axis in axes), indexing="ij")
        squared = q_x**2 + q_y**2
        squared[0, 0] = np.inf  # the mean pressure displaces nothing
        if angle is None:
            return np.fft.ifft2(2 * np.pi / np.sqrt(squared)).real
        q_s = math.cos(angle) * q_x + math.sin(angle) * q_y
        # real part: odd fields have no sine at the Nyquist frequency
        return np.fft.ifft2(-2j * np.pi * q_s / squared).real
