"""Doubly periodic influence by the half-space's exact Fourier symbols.

``I[1/rho] <-> 2 pi / q`` and ``I[s/rho^2] <-> -2 pi i q_s / q^2`` (the latter is the gradient of
``ln rho <-> -2 pi / q^2``). The mean pressure displaces nothing: the approach counts from the mean
planes. Fields are the band-limited interpolants of the element values, as in periodic peers.
"""

from __future__ import annotations

import math
from functools import cached_property

import numpy as np
import scipy

from refimpl.grid import Array, Grid
from refimpl.operators.fft import Convolution, Counter
from refimpl.operators.transforms import Complex, fourier, threads


class PeriodicInfluence(Convolution):
    """Influence convolutions on the periodic rectangle; arrays of the grid's shape."""

    displaces_mean = False

    def __init__(self, grid: Grid, direction: float, *, counter: Counter | None = None) -> None:
        self.grid = grid
        self.direction = direction
        self.source, self._points = grid.window, grid.elements
        self.counter = counter if counter is not None else Counter()

    @property
    def circle(self) -> tuple[int, int]:
        """The grid's shape."""
        return self.grid.shape

    @property
    def symbol(self) -> Array:
        """``2 pi / q`` (m), half along the first axis; zero for the mean."""
        return self._normal_hat

    @cached_property
    def _wavevectors(self) -> tuple[Array, Array, Array]:
        """``q_x`` (column), ``q_y`` (row) and ``q^2`` with its zero replaced by infinity (1/m)."""
        (n, m), (dx, dy) = self.grid.shape, self.grid.spacings
        q_x = 2 * np.pi * scipy.fft.rfftfreq(n, dx)[:, None]
        q_y = 2 * np.pi * scipy.fft.fftfreq(m, dy)[None, :]
        squared = q_x**2 + q_y**2
        squared[0, 0] = np.inf
        return q_x, q_y, squared

    @cached_property
    def _normal_hat(self) -> Array:
        return 2 * np.pi / np.sqrt(self._wavevectors[2])

    @property
    def _shear_hat(self) -> Complex:
        return self._tangential_hat(self.direction)

    @property
    def _across_hat(self) -> Complex:
        return self._tangential_hat(self.direction + math.pi / 2)

    def _tangential_hat(self, angle: float) -> Complex:
        q_x, q_y, squared = self._wavevectors
        (n, m), q_x, q_y = self.grid.shape, q_x.copy(), q_y.copy()
        if n % 2 == 0:  # a real field has no sine at the Nyquist frequency
            q_x[n // 2] = 0.0
        if m % 2 == 0:
            q_y[0, m // 2] = 0.0
        q_s: Array = math.cos(angle) * q_x + math.sin(angle) * q_y
        return np.complex128(-2j * np.pi) * q_s / squared

    def _convolve(self, source: Array, hat: Array | Complex) -> Array:
        workers = threads(source.size)
        spectrum = fourier.plane(source, source.shape, workers)
        return fourier.plane_back(spectrum * hat, source.shape, workers)
