"""Rigid axisymmetric indenters C r^n: the cone (Sneddon), the paraboloid (Hertz), the load doubling of each.

Sources: Sneddon 1965; Galin 1961; Johnson 1985, section 5.2 (cone). Popov's g(x) = kappa_n C x^n: delta =
g(a), P = 2 E* a delta n/(n + 1), p(r) = (E*/pi) integral of g'(x)/sqrt(x^2 - r^2) over r < x < a.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import gamma, hyp2f1

from refimpl.grid import Array

UNCERTAINTY = 1e-13
"""Relative error of the closed forms: rounding, and scipy's 2F1 (checked against mpmath in the tests)."""


@dataclass(frozen=True)
class PowerLaw:
    """Indenter ``coefficient`` * r^``exponent`` (m^(1-n)), ``load`` (N), reduced ``modulus`` E* (Pa)."""

    load: float
    coefficient: float
    exponent: float
    modulus: float

    @property
    def _kappa(self) -> float:
        n = self.exponent
        return float(np.sqrt(np.pi) * gamma(n / 2 + 1) / gamma((n + 1) / 2))

    @property
    def contact_radius(self) -> float:
        """a (m)."""
        n = self.exponent
        stiffness = 2 * self.modulus * self._kappa * self.coefficient * n / (n + 1)
        return float((self.load / stiffness) ** (1 / (n + 1)))

    @property
    def approach(self) -> float:
        """delta (m)."""
        return float(self._kappa * self.coefficient * self.contact_radius**self.exponent)

    @property
    def mean_pressure(self) -> float:
        """P / (pi a^2) (Pa)."""
        return self.load / (np.pi * self.contact_radius**2)

    def pressure(self, r: ArrayLike) -> Array:
        """Return p (Pa) at distance ``r`` (m), any shape; infinite on the axis when the exponent is 1."""
        n, a = self.exponent, self.contact_radius
        rho2 = np.minimum(1.0, (np.asarray(r, dtype=float) / a) ** 2)
        shape = np.sqrt(1 - rho2) * hyp2f1(1 - n / 2, 1, 1.5, 1 - rho2)
        return np.asarray(self.modulus * self._kappa * self.coefficient * n * a ** (n - 1) / np.pi * shape)


@dataclass(frozen=True)
class Cone:
    """Rigid cone of surface ``slope`` (m/m), ``load`` (N), ``modulus`` E* (Pa): Sneddon's closed forms."""

    load: float
    slope: float
    modulus: float

    @property
    def mean_pressure(self) -> float:
        """E* slope / 2 (Pa), independent of the load."""
        return self.modulus * self.slope / 2

    @property
    def contact_radius(self) -> float:
        """a (m)."""
        return float(np.sqrt(self.load / (np.pi * self.mean_pressure)))

    @property
    def approach(self) -> float:
        """delta = (pi/2) slope a (m)."""
        return np.pi / 2 * self.slope * self.contact_radius

    def pressure(self, r: ArrayLike) -> Array:
        """Return p (Pa) at distance ``r > 0`` (m): mean pressure times arccosh(a/r), infinite on the axis."""
        return self.mean_pressure * np.arccosh(
            np.maximum(1.0, self.contact_radius / np.asarray(r, dtype=float))
        )

    def displacement(self, r: ArrayLike) -> Array:
        """Return the normal displacement (m) inside and outside."""
        rho = np.asarray(r, dtype=float) / self.contact_radius
        outer = np.maximum(rho, 1.0)
        # sqrt(rho^2 - 1) - rho = -1/(sqrt(rho^2 - 1) + rho) without the cancellation far away
        outside = np.arcsin(1 / outer) - 1 / (np.sqrt(outer**2 - 1) + outer)
        return self.slope * self.contact_radius * np.where(rho <= 1, np.pi / 2 - rho, outside)
