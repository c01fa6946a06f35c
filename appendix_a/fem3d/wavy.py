"""The wavy surface: a ridge profile or an egg-box, seen from the centre of the loaded element."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from math import pi, radians, tan

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import quad
from scipy.optimize import brentq

Array = NDArray[np.float64]


class Kind(StrEnum):
    """Waviness in one direction or in two."""

    RIDGE = "ridge"  # A cos(kx)
    EGG_BOX = "egg-box"  # A cos(kx) cos(ky); a sum of two ridges is this one turned by 45 degrees


@dataclass(frozen=True)
class Waviness:
    """Heights `z = A cos(k x + 2 pi position) [cos(k y)]` above the mean plane, positive upwards, body below.

    `slope_deg` is the surface's maximum slope, `A k = tan(slope)`; the load's centre is at x = y = 0, on a
    crest line of y. Lengths in units of a, half the loaded element's edge.
    """

    slope_deg: float
    wavelength: float
    position: float
    kind: Kind = Kind.RIDGE

    @property
    def wavenumber(self) -> float:
        """k = 2 pi / lambda."""
        return 2 * pi / self.wavelength

    @property
    def amplitude(self) -> float:
        """A, half the height from valley to crest."""
        return tan(radians(self.slope_deg)) / self.wavenumber

    @property
    def local_slope(self) -> float:
        """dz/dx under the load's centre."""
        return float(self.gradient(np.zeros(1), np.zeros(1))[0][0])

    def _phase(self, x: Array) -> Array:
        return self.wavenumber * x + 2 * pi * self.position

    def _across(self, y: Array) -> Array:
        return np.cos(self.wavenumber * y) if self.kind is Kind.EGG_BOX else np.ones_like(y)

    def height(self, x: Array, y: Array) -> Array:
        """Return z(x, y); any shape."""
        return self.amplitude * np.cos(self._phase(x)) * self._across(y)

    def gradient(self, x: Array, y: Array) -> tuple[Array, Array]:
        """Return (dz/dx, dz/dy) at (x, y)."""
        rise = self.amplitude * self.wavenumber
        along = -rise * np.sin(self._phase(x)) * self._across(y)
        if self.kind is Kind.RIDGE:
            return along, np.zeros_like(along)
        return along, -rise * np.cos(self._phase(x)) * np.sin(self.wavenumber * y)

    def facet_edges(self, length: float = 1.0) -> tuple[float, float]:
        """Return the x of the two points at arc length -+`length` from the origin, along y = 0."""

        def arc(x: float) -> float:
            slope = self.amplitude * self.wavenumber

            def stretch(s: float) -> float:
                return float(np.hypot(1.0, slope * np.sin(self.wavenumber * s + 2 * pi * self.position)))

            return float(quad(stretch, 0.0, x, epsabs=1e-13)[0])

        left = brentq(lambda x: arc(x) + length, -length, 0.0, xtol=1e-13)
        right = brentq(lambda x: arc(x) - length, 0.0, length, xtol=1e-13)
        return float(left), float(right)
