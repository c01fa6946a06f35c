"""The sliding Westergaard problem: a wave pressed on a half-plane of another material, with friction.

Our own periodic extension of Westergaard 1939 by the exponents of `sliding_plane`. Gap Delta (1 - cos 2 psi),
psi = pi x/lambda; kernels cot(psi - psi') for 1/x, and a mean-free sign for the shear. The slope of u plus
gap vanishes in contact when

    PV integral of p cot(psi - psi') dpsi' - pi d (q - mean q) = (pi E* Delta/lambda) pi sin 2 psi.

Solution on -l < psi < t, with cot(pi g) = d beta and m = g l - (1 - g) t:

    p = 2 p* sin(pi g) sin^g(psi + l) sin^(1-g)(t - psi) cos(psi - m),      p* = pi E* Delta/lambda.

Boundedness at psi -> +- i infinity gives mean p = p* X/2 and d (beta mean p - tau (1 - c)) = p* Y/2 (c
contact fraction): X = cos 2m - g cos 2l - (1 - g) cos 2t, Y = -sin 2m - g sin 2l + (1 - g) sin 2t. With tau >
0 the note in `sliding_plane` on the leading edge holds here as well.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq

from refimpl.errors import InputError
from refimpl.grid import Array

UNCERTAINTY = 1e-12
"""Relative: the edges come from root finding to 1e-15 of a period, the rest is rounding."""


@dataclass(frozen=True)
class SlidingWave:
    """``mean_pressure`` (Pa), ``amplitude``, ``wavelength`` (m), E* (Pa), ``coupling`` d, tau (Pa), beta."""

    mean_pressure: float
    amplitude: float
    wavelength: float
    modulus: float
    coupling: float
    tau: float
    beta: float

    def __post_init__(self) -> None:
        if not 0 < self.mean_pressure < self.full_contact_pressure * np.sin(np.pi * self.exponent):
            raise InputError(
                "mean_pressure", self.mean_pressure, "a positive pressure below full contact, in Pa"
            )

    @property
    def full_contact_pressure(self) -> float:
        """Frictionless p* = pi E* Delta/lambda (Pa); with friction contact is full from p* sin(pi g) on."""
        return np.pi * self.modulus * self.amplitude / self.wavelength

    @property
    def exponent(self) -> float:
        """g of the trailing edge; cot(pi g) = d beta."""
        return float(0.5 - np.arctan(self.coupling * self.beta) / np.pi)

    def _offset(self, w: float) -> float:
        """Return the middle o of a contact of half-width w (both angles), NaN where none balances.

        Y - d beta X = -2 d tau (1 - c)/p* is linear in sin 2o and cos 2o once l = w - o, t = w + o are put
        in.
        """
        k, slip = 1 - 2 * self.exponent, self.coupling * self.beta
        sines = np.cos(2 * k * w) + np.cos(2 * w) + slip * (np.sin(2 * k * w) - k * np.sin(2 * w))
        cosines = np.sin(2 * k * w) + k * np.sin(2 * w) - slip * (np.cos(2 * k * w) - np.cos(2 * w))
        pull = -2 * self.coupling * self.tau * (1 - 2 * w / np.pi) / self.full_contact_pressure
        reach = np.hypot(sines, cosines)
        if abs(pull) > reach:
            return float("nan")
        return float((np.arcsin(pull / reach) - np.arctan2(cosines, sines)) / 2)

    def _load(self, w: float) -> float:
        """Return the mean pressure (Pa) at half-width w: p* X/2, X with l = w - o, t = w + o written out."""
        k, o = 1 - 2 * self.exponent, self._offset(w)
        even, odd = np.cos(2 * k * w) - np.cos(2 * w), np.sin(2 * k * w) - k * np.sin(2 * w)
        return float(self.full_contact_pressure / 2 * (np.cos(2 * o) * even - np.sin(2 * o) * odd))

    @cached_property
    def _angles(self) -> tuple[float, float]:
        """Edges (-l, t) as angles psi; the load is bracketed on 1000 widths (NaN compares false)."""
        widths = np.pi / 2 * np.arange(1, 1000) / 1000
        enough = [i for i, w in enumerate(widths) if self._load(w) >= self.mean_pressure]
        if not enough:
            raise InputError(
                "mean_pressure", self.mean_pressure, "a pressure that leaves 0.1 % of the wave open, in Pa"
            )
        upper = widths[enough[0]]
        lower = widths[enough[0] - 1] if enough[0] else 1e-9
        w = float(brentq(lambda w: self._load(w) - self.mean_pressure, lower, upper, xtol=1e-16, rtol=1e-15))
        o = self._offset(w)
        return o - w, o + w

    @property
    def edges(self) -> tuple[float, float]:
        """Trailing and leading edge (m) from a crest."""
        low, high = self._angles
        return low * self.wavelength / np.pi, high * self.wavelength / np.pi

    @property
    def contact_fraction(self) -> float:
        """Contact width over wavelength."""
        low, high = self._angles
        return (high - low) / np.pi

    def pressure(self, x: ArrayLike) -> Array:
        """Return p (Pa) at ``x`` (m) from a crest, within half a wavelength of it; any shape."""
        g, (low, high) = self.exponent, self._angles
        psi = np.pi * np.asarray(x, dtype=float) / self.wavelength
        m = -g * low - (1 - g) * high
        # both sines stay positive inside the contact; outside one clipped argument gives zero
        behind, ahead = np.sin(np.maximum(0.0, psi - low)), np.sin(np.maximum(0.0, high - psi))
        shape = np.maximum(0.0, behind) ** g * np.maximum(0.0, ahead) ** (1 - g) * np.cos(psi - m)
        return np.asarray(2 * self.full_contact_pressure * np.sin(np.pi * g) * shape)
