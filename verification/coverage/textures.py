"""Surfaces whose contacts do not end like a ball's: rounded punches, pads, dimples, steps, teeth."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import scipy

import refimpl as rf
from refimpl.grid import Array


@dataclass(frozen=True)
class RoundedPunch(rf.Surface):
    """A flat of radius b, rim ``-(r - b)^2 / (2 R)`` for r > b; ``centre`` from the domain's middle (m)."""

    b: float
    R: float
    centre: tuple[float, float] = (0.0, 0.0)
    kind: ClassVar[str] = "rounded_punch"

    def heights_on(self, grid: rf.Grid, offset: tuple[float, float]) -> Array:
        middle = (0.5 * length + shift for length, shift in zip(grid.lengths, self.centre, strict=True))
        x, y = (
            centres + shift - at for centres, shift, at in zip((grid.x, grid.y), offset, middle, strict=True)
        )
        beyond = np.maximum(np.hypot(x[:, None], y[None, :]) - self.b, 0.0)
        return np.asarray(-(beyond**2) / (2 * self.R))

    def load(self, a: float, modulus: float) -> float:
        """Return the load (N) of contact radius a > b, without friction or small slopes' shear.

        ``P = 2 E* int_0^a r^2 f'(r) / sqrt(a^2 - r^2) dr`` with f' = (r - b) / R (Galin 1946; Sneddon 1965).

        >>> punch = RoundedPunch(1e-12, 2.0)
        >>> round(punch.load(1.0, 3.0) / (4 * 3.0 / (3 * 2.0)), 6)  # Hertz
        1.0
        """
        u, b = math.sqrt(a**2 - self.b**2), self.b
        cubic = a**2 * u - u**3 / 3
        square = 0.5 * (a**2 * math.acos(b / a) + b * u)
        return 2 * modulus / self.R * (cubic - b * square)

    def contact_radius(self, load: float, modulus: float) -> float:
        """Return the contact radius (m) under a load (N).

        >>> punch = RoundedPunch(0.8, 2.0)
        >>> round(punch.contact_radius(punch.load(1.0, 3.0), 3.0), 6)
        1.0
        """
        most = 2 * self.b
        while self.load(most, modulus) < load:
            most *= 2
        return float(scipy.optimize.brentq(lambda a: self.load(a, modulus) - load, self.b, most, rtol=1e-12))


@dataclass(frozen=True)
class Profile(rf.Surface):
    """A periodic profile along ``(m x / Lx + n y / Ly)``: tops and valleys with walls, saw teeth, ridges (m).

    shape : "steps", trapezoids whose tops are ``top`` of a period and whose walls ``wall``; "teeth", a saw
        that rises on ``top`` of a period and falls on the rest; "ridges", parabolas ``top`` of a period wide
    """

    shape: str
    amplitude: float
    numbers: tuple[int, int]
    phase: float
    top: float
    wall: float = 0.0
    kind: ClassVar[str] = "profile"

    def heights_on(self, grid: rf.Grid, offset: tuple[float, float]) -> Array:
        along, across = (
            number * (centres + shift) / length
            for number, centres, shift, length in zip(
                self.numbers, (grid.x, grid.y), offset, grid.lengths, strict=True
            )
        )
        s = (along[:, None] + across[None, :] + self.phase) % 1.0
        return self.amplitude * self._unit(s)

    def _unit(self, s: Array) -> Array:
        """Return the heights of amplitude one at shares s of a period."""
        if self.shape == "teeth":
            return np.where(s < self.top, s / self.top, (1 - s) / (1 - self.top))
        from_middle = np.abs(s - 0.5)
        if self.shape == "ridges":
            return np.maximum(1 - (2 * from_middle / self.top) ** 2, 0.0)
        return np.clip((0.5 * self.top + self.wall - from_middle) / self.wall, 0.0, 1.0)


@dataclass(frozen=True)
class Pads(rf.Surface):
    """Pads, or dimples of a negative height, in a lattice of ``numbers`` cells (m).

    They are round, or ``square``, of ``radius``, with a rim of width ``rim`` that falls as a straight wall,
    or as a parabola where ``rounded``; every one is moved at random within its cell.
    """

    height: float
    numbers: tuple[int, int]
    radius: float
    rim: float
    seed: int
    square: bool = False
    rounded: bool = False
    kind: ClassVar[str] = "spots"

    def heights_on(self, grid: rf.Grid, offset: tuple[float, float]) -> Array:
        cells = tuple(length / number for length, number in zip(grid.lengths, self.numbers, strict=True))
        free = [max(0.5 * cell - self.radius - self.rim, 0.0) for cell in cells]
        moves = np.random.default_rng(self.seed).uniform(-1, 1, (2, *self.numbers))
        x, y = grid.x[:, None] + offset[0], grid.y[None, :] + offset[1]
        i, j = (
            np.floor(at / cell).astype(int) % number
            for at, cell, number in zip((x, y), cells, self.numbers, strict=True)
        )
        dx = np.abs(x % cells[0] - 0.5 * cells[0] - free[0] * moves[0, i, j])
        dy = np.abs(y % cells[1] - 0.5 * cells[1] - free[1] * moves[1, i, j])
        beyond = (np.maximum(dx, dy) if self.square else np.hypot(dx, dy)) - self.radius
        fallen = np.clip(beyond / self.rim, 0.0, 1.0)
        return np.asarray(self.height * (1 - (fallen**2 if self.rounded else fallen)))
