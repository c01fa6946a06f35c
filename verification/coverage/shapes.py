"""Continuous surfaces that only the study of error bars needs: a barrel, waves, and a measured-like array."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

import refimpl as rf
from refimpl.grid import Array


@dataclass(frozen=True)
class Barrel(rf.Surface):
    """The paraboloid of a barrel, ``x^2 / (2 across) + y^2 / (2 along)`` about the centre (radii in m)."""

    across: float
    along: float
    kind: ClassVar[str] = "barrel"

    def _sample(self, grid: rf.Grid, offset: tuple[float, float]) -> Array:
        x = grid.x + offset[0] - 0.5 * grid.lengths[0]
        y = grid.y + offset[1] - 0.5 * grid.lengths[1]
        return np.asarray(x[:, None] ** 2 / (2 * self.across) + y[None, :] ** 2 / (2 * self.along))


@dataclass(frozen=True)
class Waves(rf.Surface):
    """``amplitude (cos(2 pi m x / side + a) + cos(2 pi n y / side + b))``, numbers m, n, phases a, b (m)."""

    amplitude: float
    numbers: tuple[int, int]
    phases: tuple[float, float]
    kind: ClassVar[str] = "waves"

    def _sample(self, grid: rf.Grid, offset: tuple[float, float]) -> Array:
        x, y = (
            np.cos(2 * math.pi * number * (centres + shift) / length + phase)
            for number, phase, shift, centres, length in zip(
                self.numbers, self.phases, offset, (grid.x, grid.y), grid.lengths, strict=True
            )
        )
        return np.asarray(self.amplitude * (x[:, None] + y[None, :]))


def measured_like(rng: np.random.Generator, points: int, rms: float, hurst: float, roll_off: int) -> Array:
    """Self-affine heights (m), ``points x points``: white noise under a spectrum q^-(1 + hurst).

    Constant spectrum below ``roll_off`` waves per side, nothing above a quarter of the points, a negative
    skewness as of a run-in surface.
    """
    along, across = np.fft.fftfreq(points) * points, np.fft.rfftfreq(points) * points
    q = np.hypot(along[:, None], across[None, :])
    spectrum = np.maximum(q, roll_off) ** -(1 + hurst) * (q > 0) * (q <= points / 4)
    z = np.fft.irfft2(np.fft.rfft2(rng.standard_normal((points, points))) * spectrum, s=(points, points))
    z /= z.std()
    z -= 0.15 * z**2
    return np.asarray(rms * (z - z.mean()) / z.std())
