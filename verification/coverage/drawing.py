"""Random numbers and surfaces of the scenes that error bars and identification are studied on."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

import refimpl as rf
from refimpl.grid import Array

SIDE = 1e-3  # m; the problem is scale-free, so one side stands for all


class Dice:
    """A generator of random numbers of its own for each key."""

    def __init__(self, *key: int) -> None:
        self.rng = np.random.default_rng(list(key))

    def log(self, low: float, high: float) -> float:
        """Return a log-uniform number."""
        return math.exp(self.rng.uniform(math.log(low), math.log(high)))

    def material(self) -> rf.Material:
        """Return one of 2 to 400 GPa."""
        return rf.Material(E=self.log(2e9, 400e9), nu=float(self.rng.uniform(0.1, 0.49)))

    def angle(self) -> float:
        """Return an angle of the whole circle (rad)."""
        return float(self.rng.uniform(0, 2 * math.pi))


@dataclass(frozen=True)
class Ball:
    """A Hertz contact (Hertz 1882) of radius R and contact radius a (m) at the reduced modulus (Pa)."""

    modulus: float
    R: float
    a: float

    @property
    def load(self) -> float:
        """Load (N)."""
        return 4 * self.modulus * self.a**3 / (3 * self.R)

    @property
    def pressure(self) -> float:
        """Mean pressure (Pa)."""
        return self.load / (math.pi * self.a**2)

    @property
    def approach(self) -> float:
        """Approach (m)."""
        return self.a**2 / self.R


@dataclass(frozen=True)
class Barrel(rf.Surface):
    """The paraboloid of a barrel, ``x^2 / (2 across) + y^2 / (2 along)`` about the centre (radii in m)."""

    across: float
    along: float
    kind: ClassVar[str] = "barrel"

    def heights_on(self, grid: rf.Grid, offset: tuple[float, float]) -> Array:
        x = grid.x + offset[0] - 0.5 * grid.lengths[0]
        y = grid.y + offset[1] - 0.5 * grid.lengths[1]
        return np.asarray(x[:, None] ** 2 / (2 * self.across) + y[None, :] ** 2 / (2 * self.along))


@dataclass(frozen=True)
class Wave(rf.Surface):
    """``amplitude cos(2 pi (m x / Lx + n y / Ly) + phase)``: grooves (m), or a zigzag of that height.

    Numbers m and n are those of periods along the sides.
    """

    amplitude: float
    numbers: tuple[int, int]
    phase: float
    zigzag: bool = False
    kind: ClassVar[str] = "wave"

    def heights_on(self, grid: rf.Grid, offset: tuple[float, float]) -> Array:
        along, across = (
            2 * math.pi * number * (centres + shift) / length
            for number, centres, shift, length in zip(
                self.numbers, (grid.x, grid.y), offset, grid.lengths, strict=True
            )
        )
        z = np.cos(along[:, None] + across[None, :] + self.phase)
        return np.asarray(self.amplitude * (1 - 2 / math.pi * np.arccos(z) if self.zigzag else z))


@dataclass(frozen=True)
class Waves(rf.Surface):
    """``amplitude (cos(2 pi m x / side + a) + cos(2 pi n y / side + b))``, numbers m, n, phases a, b (m)."""

    amplitude: float
    numbers: tuple[int, int]
    phases: tuple[float, float]
    kind: ClassVar[str] = "waves"

    def heights_on(self, grid: rf.Grid, offset: tuple[float, float]) -> Array:
        x, y = (
            Wave(1.0, numbers, phase).heights_on(grid, offset)
            for numbers, phase in zip(((self.numbers[0], 0), (0, self.numbers[1])), self.phases, strict=True)
        )
        return np.asarray(self.amplitude * (x + y))


def measured_like(rng: np.random.Generator, points: int, rms: float, hurst: float, roll_off: int) -> Array:
    """Return self-affine heights (m), ``points x points``: white noise under a spectrum q^-(1 + hurst).

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
