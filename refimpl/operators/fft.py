"""Exact aperiodic convolution on a window by zero-padded real FFTs.

Transforms: ``scipy.fft``, unnormalised forward and ``1/n`` backward. Rows that are known to be zero
are not transformed, and rows of the result that nobody asked for are not transformed back.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
import scipy.fft as sfft

from numpy.typing import NDArray

from refimpl.grid import Array, Grid
from refimpl.operators.tables import signed_table, unit_table
from refimpl.operators.window import Window

Complex = NDArray[np.complex128]


@dataclass
class Counter:
    """How often operators were applied, each application with its ``n log2 n`` padded points."""

    applications: int = 0
    point_logs: float = 0.0
    tally: dict[str, int] = field(default_factory=dict)

    def add(self, what: str, points: int) -> None:
        """Count one application of ``what`` with a transform of ``points`` points."""
        self.applications += 1
        self.point_logs += points * math.log2(max(points, 2))
        self.tally[what] = self.tally.get(what, 0) + 1


class FFTInfluence:
    """Influence convolutions from a window onto itself (default: the whole grid).

    The padded size is at least twice the window's, so that no periodic image reaches it: the result
    is the dense product to rounding. Kernels are built when first used and never otherwise.
    """

    def __init__(
        self, grid: Grid, direction: float, *, window: Window | None = None, counter: Counter | None = None
    ) -> None:
        self.grid = grid
        self.direction = direction
        self.window = window or Window.full(grid.M)
        self.counter = counter if counter is not None else Counter()
        self._padded = tuple(sfft.next_fast_len(2 * n, real=True) for n in self.window.shape)

    def normal(self, pressure: Array) -> Array:
        """``I[1/rho]`` applied to a pressure on the window."""
        self.counter.add("normal", math.prod(self._padded))
        return self._convolve(pressure, self._normal_hat)

    def shear(self, traction: Array) -> Array:
        """``I[s/rho^2]`` applied to a traction along the sliding direction."""
        self.counter.add("shear", math.prod(self._padded))
        return self._convolve(traction, self._shear_hat)

    def shear_across(self, traction: Array) -> Array:
        """``I[t/rho^2]`` applied to a traction across the sliding direction."""
        self.counter.add("shear", math.prod(self._padded))
        return self._convolve(traction, self._across_hat)

    @cached_property
    def _normal_hat(self) -> Array:
        """The even kernel's transform, real."""
        rows, columns = (_wrapped(n) for n in self._padded)
        table = unit_table("normal", 1 + max(n // 2 for n in self._padded))
        kernel = table[np.ix_(np.abs(rows), np.abs(columns))] * self.grid.spacing
        return np.ascontiguousarray(sfft.rfft2(kernel).real)

    @cached_property
    def _shear_hat(self) -> Complex:
        return self._tangential_hat(self.direction)

    @cached_property
    def _across_hat(self) -> Complex:
        return self._tangential_hat(self.direction + math.pi / 2)

    def _tangential_hat(self, angle: float) -> Complex:
        """The odd kernel's transform, imaginary."""
        rows, columns = (_wrapped(n) for n in self._padded)
        along_x = signed_table("tangential", rows, columns)
        along_y = signed_table("tangential", columns, rows).T
        kernel = (math.cos(angle) * along_x + math.sin(angle) * along_y) * self.grid.spacing
        return sfft.rfft2(kernel)

    def _convolve(self, source: Array, hat: Array | Complex) -> Array:
        n, m = self.window.shape
        N, K = self._padded
        spectrum = sfft.fft(sfft.rfft(source, n=K, axis=1), n=N, axis=0)
        spectrum *= hat
        rows = sfft.ifft(spectrum, axis=0, overwrite_x=True)[:n]
        return sfft.irfft(rows, n=K, axis=1)[:, :m]


def _wrapped(n: int) -> NDArray[np.int_]:
    """Signed offsets ``0, 1, ..., -1`` of a circle of ``n`` points."""
    steps = np.arange(n)
    return np.where(steps <= n // 2, steps, steps - n)
