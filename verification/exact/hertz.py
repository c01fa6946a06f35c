"""Hertz contact of a paraboloid, round or elliptical, with a half-space.

Sources: Hertz 1882; Johnson 1985, sections 3.4 and 4.2. The elliptical case is written in Carlson's integrals
(DLMF 19.16), which have no special case for the circle.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq
from scipy.special import elliprd, elliprf

from refimpl.grid import Array

UNCERTAINTY = 1e-14
"""Relative error of the closed forms below: rounding only."""


@dataclass(frozen=True)
class Sphere:
    """Paraboloid r^2/2R under ``load`` (N), ``radius`` R (m), reduced ``modulus`` E* (Pa)."""

    load: float
    radius: float
    modulus: float

    @property
    def contact_radius(self) -> float:
        """a (m), Johnson (4.22)."""
        return float((3 * self.load * self.radius / (4 * self.modulus)) ** (1 / 3))

    @property
    def peak_pressure(self) -> float:
        """p0 (Pa), Johnson (4.24)."""
        return 3 * self.load / (2 * np.pi * self.contact_radius**2)

    @property
    def approach(self) -> float:
        """delta = a^2/R (m), Johnson (4.23)."""
        return self.contact_radius**2 / self.radius

    def pressure(self, r: ArrayLike) -> Array:
        """Return p (Pa) at distance ``r`` (m) from the axis, any shape."""
        rho = np.asarray(r, dtype=float) / self.contact_radius
        return self.peak_pressure * np.sqrt(np.maximum(0.0, 1 - rho**2))

    def displacement(self, r: ArrayLike) -> Array:
        """Return both bodies' normal displacement (m), inside and outside: Johnson (3.41a), (3.42a)."""
        rho = np.asarray(r, dtype=float) / self.contact_radius
        outer = np.maximum(rho, 1.0)
        inside = np.pi / 2 * (2 - rho**2)
        outside = (2 - outer**2) * np.arcsin(1 / outer) + np.sqrt(outer**2 - 1)
        return (
            self.peak_pressure
            * self.contact_radius
            / (2 * self.modulus)
            * np.where(rho <= 1, inside, outside)
        )


@dataclass(frozen=True)
class Ellipse:
    """Paraboloid ``curvature_x`` x^2/2 + ``curvature_y`` y^2/2 (1/m), ``load`` (N), ``modulus`` E* (Pa)."""

    load: float
    curvature_x: float
    curvature_y: float
    modulus: float

    @property
    def semi_axes(self) -> tuple[float, float]:
        """Semi-axes along x and y (m): equal curvature ratio and R_D ratio, then the load."""
        wanted = np.log(self.curvature_y / self.curvature_x)

        def mismatch(log_ratio: float) -> float:
            k2 = np.exp(2 * log_ratio)
            return float(np.log(elliprd(0, 1, k2) / elliprd(0, k2, 1)) - wanted)

        k = np.exp(brentq(mismatch, -12.0, 12.0, xtol=1e-15, rtol=1e-15))
        along_x = (self.load * elliprd(0, k**2, 1) / (np.pi * self.modulus * self.curvature_x)) ** (1 / 3)
        return float(along_x), float(k * along_x)

    @property
    def peak_pressure(self) -> float:
        """p0 (Pa)."""
        a, b = self.semi_axes
        return 3 * self.load / (2 * np.pi * a * b)

    @property
    def approach(self) -> float:
        """delta (m), the displacement at the centre."""
        a, b = self.semi_axes
        return float(self.peak_pressure * a * b / self.modulus * elliprf(0, a**2, b**2))

    def pressure(self, x: ArrayLike, y: ArrayLike) -> Array:
        """Return p (Pa) at ``(x, y)`` (m), shapes broadcast."""
        a, b = self.semi_axes
        inside = 1 - (np.asarray(x, dtype=float) / a) ** 2 - (np.asarray(y, dtype=float) / b) ** 2
        return self.peak_pressure * np.sqrt(np.maximum(0.0, inside))

    def displacement(self, x: ArrayLike, y: ArrayLike) -> Array:
        """Return the normal displacement of both bodies together (m), inside and outside, shapes broadcast.

        Potential of the ellipsoidal pressure (Johnson 3.35): the integral over w of
        (1 - x^2/(a^2+w) - y^2/(b^2+w)) / sqrt((a^2+w)(b^2+w)w) from the confocal ellipse through (x, y).
        """
        a, b = self.semi_axes
        x2, y2 = np.asarray(x, dtype=float) ** 2, np.asarray(y, dtype=float) ** 2
        middle = (a**2 + b**2 - x2 - y2) / 2
        # larger root of x^2/(a^2 + w) + y^2/(b^2 + w) = 1, zero inside; the discriminant as a sum of squares
        w = np.maximum(0.0, np.sqrt(((a**2 - b**2 - x2 + y2) / 2) ** 2 + x2 * y2) - middle)
        alpha, beta = a**2 + w, b**2 + w
        curved = x2 * elliprd(w, beta, alpha) + y2 * elliprd(w, alpha, beta)
        return np.asarray(self.peak_pressure * a * b / self.modulus * (elliprf(w, alpha, beta) - curved / 3))
