"""The wavy boundary (A2), y = 2 h_a sin^2(pi x / lambda), y into the body, so that x = 0 is a crest.

h_a is the amplitude of the sinusoid, half the height from trough to crest ("an asperity height" in the
paper).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from appendix_a.errors import InputError, real

Real = NDArray[np.float64]


@dataclass(frozen=True)
class Sinusoid:
    """Profile seen from a strip's centre at x = position * wavelength; lengths in the strip's half-width a.

    ``slope_deg`` is the profile's maximum slope: ``tan(slope) = 2 pi h_a / lambda``. Raises InputError.
    """

    slope_deg: float
    wavelength: float
    position: float

    def __post_init__(self) -> None:
        if not 0 <= real(self.slope_deg) < 90:
            raise InputError("slope_deg", self.slope_deg, "a maximum slope in [0, 90) degrees")
        if not 0 < real(self.wavelength) < np.inf:
            raise InputError("wavelength", self.wavelength, "a positive length in units of a")
        if not np.isfinite(real(self.position)):
            raise InputError("position", self.position, "a finite x / wavelength")

    @property
    def amplitude(self) -> float:
        """h_a in units of a."""
        return float(np.tan(np.radians(self.slope_deg)) * self.wavelength / (2 * np.pi))

    def depth(self, offset: ArrayLike) -> Real:
        """Return the depth of the boundary below the strip's centre, at horizontal offsets from it."""
        phase = np.pi * np.asarray(offset, dtype=float) / self.wavelength
        # sin^2(A + B) - sin^2(B) = sin(A + 2B) sin(A): no cancellation for short offsets
        return np.asarray(2 * self.amplitude * np.sin(phase + 2 * np.pi * self.position) * np.sin(phase))

    def slope(self, offset: ArrayLike) -> Real:
        """Return the slope angle of the boundary, rad, positive where it goes down with x."""
        phase = 2 * np.pi * (np.asarray(offset, dtype=float) / self.wavelength + self.position)
        return np.arctan(2 * np.pi * self.amplitude / self.wavelength * np.sin(phase))
