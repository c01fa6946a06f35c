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
from refimpl.operators.tables import signed_table
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
    """Influence convolutions from a source window to a target window, by default the same one.

    The padded size holds every offset that occurs exactly once, so no periodic image reaches the
    target: the result is the dense product to rounding. Kernels are built when first used and never
    otherwise. Arguments have the source's shape, results the target's.
    """

    def __init__(
        self,
        grid: Grid,
        direction: float,
        *,
        source: Window | None = None,
        target: Window | None = None,
        counter: Counter | None = None,
    ) -> None:
        self.grid = grid
        self.direction = direction
        self.source = source or Window.full(grid.M)
        self.target = target or self.source
        self.counter = counter if counter is not None else Counter()
        rows, columns = (n + m for n, m in zip(self.source.shape, self.target.shape, strict=True))
        # the transform along columns is real, the one along rows complex, with more fast lengths
        self._padded = sfft.next_fast_len(rows), sfft.next_fast_len(columns, real=True)

    def normal(self, pressure: Array) -> Array:
        """``I[1/rho]`` applied to a pressure."""
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
    def _offsets(self) -> tuple[NDArray[np.int_], NDArray[np.int_]]:
        """Signed element offsets, target minus source, around the circle of each axis."""
        shifts = (self.target.i0 - self.source.i0, self.target.j0 - self.source.j0)
        even = self.source == self.target
        rows, columns = (
            _circle(n, targets, shift, even=even)
            for n, targets, shift in zip(self._padded, self.target.shape, shifts, strict=True)
        )
        return rows, columns

    @cached_property
    def _normal_hat(self) -> Array | Complex:
        """The kernel's transform; real, and kept so, when source and target coincide."""
        rows, columns = self._offsets
        hat = sfft.rfft2(signed_table("normal", rows, columns) * self.grid.spacing)
        return np.ascontiguousarray(hat.real) if self.source == self.target else hat

    @cached_property
    def _shear_hat(self) -> Complex:
        return self._tangential_hat(self.direction)

    @cached_property
    def _across_hat(self) -> Complex:
        return self._tangential_hat(self.direction + math.pi / 2)

    def _tangential_hat(self, angle: float) -> Complex:
        rows, columns = self._offsets
        along_x = signed_table("tangential", rows, columns)
        along_y = signed_table("tangential", columns, rows).T
        hat: Complex = sfft.rfft2(
            (math.cos(angle) * along_x + math.sin(angle) * along_y) * self.grid.spacing
        )
        return hat

    def _convolve(self, source: Array, hat: Array | Complex) -> Array:
        n, m = self.target.shape
        N, K = self._padded
        spectrum = sfft.fft(sfft.rfft(source, n=K, axis=1), n=N, axis=0)
        spectrum *= hat
        rows = sfft.ifft(spectrum, axis=0, overwrite_x=True)[:n]
        result: Array = sfft.irfft(rows, n=K, axis=1)[:, :m]
        return result


class WholeGridInfluence(FFTInfluence):
    """From a source window to the whole grid, with arguments of the grid's shape.

    Tractions outside the source are taken to be zero: the caller chose the source to hold them all.
    """

    def _convolve(self, source: Array, hat: Array | Complex) -> Array:
        return super()._convolve(source[self.source.slices], hat)


def _circle(n: int, targets: int, shift: int, *, even: bool) -> NDArray[np.int_]:
    """Offsets met around a circle of ``n`` points: ``0 ... targets - 1``, then the negative ones.

    ``even`` splits the circle in halves, so that an even kernel has a real transform: for equal windows.
    """
    steps = np.arange(n)
    if even:
        return np.where(steps <= n // 2, steps, steps - n)
    return np.where(steps < targets, steps, steps - n) + shift
