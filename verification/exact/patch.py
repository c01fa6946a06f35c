"""Uniform pressure on a rectangle of a half-space: Love 1929; Johnson 1985, Eq. (3.25)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from appendix_a.fem3d.patch import normal_integral
from refimpl.grid import Array

UNCERTAINTY = 1e-13
"""Relative error of the closed form within ten patch sizes: rounding, amplified by the cancellation of four
corners.
"""


@dataclass(frozen=True)
class Patch:
    """``pressure`` (Pa) on ``width`` (along x) by ``height`` (m) about the origin, ``modulus`` E* (Pa)."""

    pressure: float
    width: float
    height: float
    modulus: float

    def displacement(self, x: ArrayLike, y: ArrayLike) -> Array:
        """Return the normal displacement of both bodies together (m) at ``(x, y)`` (m), shapes broadcast."""
        x, y = np.broadcast_arrays(np.asarray(x, dtype=float), np.asarray(y, dtype=float))
        integral = normal_integral(x, y, self.width / 2, self.height / 2)
        return self.pressure / (np.pi * self.modulus) * integral
