"""One-dimensional waviness pressed flat: gap Delta (1 - cos(2 pi x/lambda)), frictionless.

Source: Westergaard 1939; Johnson 1985, section 13.2. The approach of the mean planes is integrated here from
Johnson's flat-punch increment: d(approach)/d(mean pressure) = -(2 lambda/(pi E*)) ln sin(pi a/lambda).
"""

from __future__ import annotations

from dataclasses import dataclass

import mpmath as mp
import numpy as np
from numpy.typing import ArrayLike

from refimpl.errors import InputError
from refimpl.grid import Array

UNCERTAINTY = 1e-14
"""Relative error of the closed forms: rounding only."""


@dataclass(frozen=True)
class Wave:
    """``mean_pressure`` (Pa), ``amplitude`` Delta and ``wavelength`` lambda (m), ``modulus`` E* (Pa)."""

    mean_pressure: float
    amplitude: float
    wavelength: float
    modulus: float

    def __post_init__(self) -> None:
        if not self.mean_pressure > 0:
            raise InputError("mean_pressure", self.mean_pressure, "a positive pressure in Pa")

    @property
    def full_contact_pressure(self) -> float:
        """p* = pi E* Delta/lambda (Pa)."""
        return np.pi * self.modulus * self.amplitude / self.wavelength

    @property
    def _sin2(self) -> float:
        return min(1.0, self.mean_pressure / self.full_contact_pressure)

    @property
    def contact_fraction(self) -> float:
        """2a/lambda, from mean pressure = p* sin^2(pi a/lambda)."""
        return float(2 / np.pi * np.arcsin(np.sqrt(self._sin2)))

    @property
    def approach(self) -> float:
        """Approach of mean planes from first contact (m): Delta s^2 (1 - ln s^2), then constant."""
        return float(self.amplitude * self._sin2 * (1 - np.log(self._sin2)))

    def pressure(self, x: ArrayLike) -> Array:
        """Return p (Pa) at ``x`` (m) from a crest, any shape."""
        psi = np.pi * np.asarray(x, dtype=float) / self.wavelength
        if self.mean_pressure >= self.full_contact_pressure:
            return self.mean_pressure + self.full_contact_pressure * np.cos(2 * psi)
        root = np.sqrt(np.maximum(0.0, self._sin2 - np.sin(psi) ** 2))
        return 2 * self.full_contact_pressure * np.abs(np.cos(psi)) * root


def displacement_by_quadrature(wave: Wave, x: float) -> tuple[float, float]:
    """Return ``wave``'s mean-free displacement at ``x`` and its error (m); partial contact.

    The line load's periodic kernel -(2/(pi E*)) ln|2 sin(pi s/lambda)|, written anew in mpmath from the
    pressure formula.
    """
    with mp.workdps(20):
        s2 = mp.mpf(wave.mean_pressure) / wave.full_contact_pressure
        edge, at = mp.asin(mp.sqrt(s2)), mp.pi * mp.mpf(x) / wave.wavelength

        def integrand(psi: mp.mpf) -> mp.mpf:
            distance = abs(mp.sin(psi - at))
            if distance == 0:
                return mp.mpf(0)  # the outermost node, of no weight, on the logarithm
            root = mp.sqrt(max(mp.mpf(0), s2 - mp.sin(psi) ** 2))
            return 2 * wave.full_contact_pressure * mp.cos(psi) * root * mp.log(2 * distance)

        ends = [-edge, at, edge] if abs(at) < edge else [-edge, edge]
        value, error = mp.quad(integrand, ends, error=True)
        scale = -2 * wave.wavelength / (mp.pi**2 * wave.modulus)
        return float(scale * value), float(abs(scale) * error)
