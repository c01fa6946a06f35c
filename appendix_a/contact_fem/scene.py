"""Two sinusoidal half-planes in sliding contact: geometry, materials, friction.

Lengths in wavelengths, heights z upwards.  The lower surface has its crest at x = -shift/2, the upper one at
+shift/2, both of the same maximum slope, so that the gap is a sinusoid with its minimum at x = 0 and contact
sits on a flank.  The upper body slides along +x: with shift < 0 it climbs the lower asperity's flank.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from appendix_a.errors import InputError, real

Array = NDArray[np.float64]
WAVENUMBER = 2.0 * math.pi


@dataclass(frozen=True)
class Material:
    """Young's modulus (any unit of stress) and Poisson's ratio."""

    E: float
    nu: float

    def __post_init__(self) -> None:
        if not 0 < real(self.E) < math.inf:
            raise InputError("E", self.E, "a positive, finite Young's modulus")
        if not -1.0 < real(self.nu) < 0.5:
            raise InputError("nu", self.nu, "a Poisson ratio, -1 < nu < 0.5")


@dataclass(frozen=True)
class WavyPair:
    """Two wavy bodies: `slope_deg` the maximum slope of each surface, `shift` between crests in wavelengths.

    `tau` and `beta` of the local friction r = tau + beta f; `tau` in the moduli's unit.
    """

    slope_deg: float
    shift: float
    lower: Material
    upper: Material
    tau: float = 0.0
    beta: float = 0.0

    def __post_init__(self) -> None:
        if not 0.0 < real(self.slope_deg) <= 20.0:
            raise InputError("slope_deg", self.slope_deg, "a maximum slope above 0 and up to 20 degrees")
        if not abs(real(self.shift)) < 0.5:
            raise InputError("shift", self.shift, "a fraction of the wavelength, below a half either way")
        if not (real(self.tau) >= 0 and real(self.beta) >= 0):
            raise InputError("tau, beta", (self.tau, self.beta), "numbers that are not negative")

    @property
    def amplitude(self) -> float:
        """Amplitude of either surface, tan(slope) / k."""
        return math.tan(math.radians(self.slope_deg)) / WAVENUMBER

    @property
    def gap_amplitude(self) -> float:
        """Delta of the gap Delta (1 - cos k x); also the mean planes' distance at first contact."""
        return 2.0 * self.amplitude * math.cos(WAVENUMBER * self.shift / 2.0)

    @property
    def reduced_modulus(self) -> float:
        """E*, from 1 / E* = sum of (1 - nu^2) / E."""
        return 1.0 / sum((1.0 - m.nu**2) / m.E for m in (self.lower, self.upper))

    @property
    def coupling(self) -> float:
        """Dundurs' constant d, E* times lower minus upper (1 + nu)(1 - 2 nu) / (2 E)."""
        lower, upper = ((1.0 + m.nu) * (1.0 - 2.0 * m.nu) / (2.0 * m.E) for m in (self.lower, self.upper))
        return self.reduced_modulus * (lower - upper)

    @property
    def full_contact_pressure(self) -> float:
        """Westergaard's p* = pi E* Delta / lambda, mean pressure of frictionless full contact."""
        return math.pi * self.reduced_modulus * self.gap_amplitude

    def lower_height(self, x: Array) -> Array:
        """Return z of the lower surface about its mean plane."""
        return self.amplitude * np.cos(WAVENUMBER * (x + self.shift / 2.0))

    def upper_height(self, x: Array) -> Array:
        """Return z of the upper surface about its mean plane."""
        return -self.amplitude * np.cos(WAVENUMBER * (x - self.shift / 2.0))
