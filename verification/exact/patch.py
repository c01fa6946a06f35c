"""Uniform pressure on a rectangle of a half-space: Love 1929; Johnson 1985, Eq. (3.25); and by quadrature."""

from __future__ import annotations

from dataclasses import dataclass

import mpmath as mp
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

    @property
    def mean_displacement(self) -> float:
        """Displacement averaged over the patch (m): closed double integral of 1/rho."""
        a, b = self.width, self.height
        diagonal = np.hypot(a, b)
        pair = 2 * a * b * (a * np.arcsinh(b / a) + b * np.arcsinh(a / b))
        pair -= 2 / 3 * (diagonal**3 - a**3 - b**3)
        return float(self.pressure / (np.pi * self.modulus) * pair / (a * b))


def displacement_by_quadrature(patch: Patch, x: float, y: float) -> tuple[float, float]:
    """Return the displacement (m) at ``(x, y)`` (m) and the quadrature's error (m), from the definition.

    In polar coordinates about the field point 1/rho cancels the Jacobian: the chord along each ray remains.
    """
    with mp.workdps(20):
        px, py = mp.mpf(x), mp.mpf(y)
        left, right = -mp.mpf(patch.width) / 2 - px, mp.mpf(patch.width) / 2 - px
        low, high = -mp.mpf(patch.height) / 2 - py, mp.mpf(patch.height) / 2 - py

        def ray(angle: mp.mpf) -> mp.mpf:
            """Return the length of the patch along the ray at ``angle``."""
            c, s = mp.cos(angle), mp.sin(angle)
            enter, leave = mp.mpf(0), mp.inf
            for direction, near, far in ((c, left, right), (s, low, high)):
                if direction == 0:
                    if not near <= 0 <= far:
                        return mp.mpf(0)
                    continue
                first, second = sorted((near / direction, far / direction))
                enter, leave = max(enter, first), min(leave, second)
            return max(mp.mpf(0), leave - enter)

        corners = sorted(mp.atan2(v, u) for u in (left, right) for v in (low, high) if (u, v) != (0, 0))
        breaks = {-mp.pi, -mp.pi / 2, mp.mpf(0), mp.pi / 2, mp.pi, *corners}
        value, error = mp.quad(ray, sorted(breaks), error=True)
        scale = patch.pressure / (mp.pi * patch.modulus)
        return float(scale * value), float(scale * error)
