"""A cylinder sliding on a half-plane of another material: the singular-exponent solution, and its trailing
shift.

Sources: Galin 1953; Johnson 1985, section 8.3; Hills, Nowell and Sackfield 1993. Derived here in the
conventions of the model: the upper body slides along +x, the traction on the lower one is q = tau + beta p
along +x, and d = E* [(1 + nu)(1 - 2 nu)/(2 E) of the lower body minus that of the upper] (Dundurs' second
constant). Lines of the kernels 1/rho and s/rho^2 integrate to -2 ln|x| and pi sign(x), so that in contact
(slope of u + x^2/2R vanishes)

    PV integral of p(s)/(x - s) ds - pi d q(x) = pi E* x/(2R).

With S(z) the integral of p(s)/(z - s) and contact on -l < x < t,
S = (pi E*/2R) [z - (z + l)^g (z - t)^(1-g)] solves it for tau = 0 and cot(pi g) = d beta. S must vanish at
infinity like P/z, which asks

    g l = (1 - g) t,   P = (pi E*/2R) g (1 - g) (l + t)^2/2,   p = (E*/2R) sin(pi g) (x + l)^g (t - x)^(1-g).

A constant tau only moves all this by -2 R d tau/E*. A hard cylinder on a softer flat has d > 0, so g < 1/2
and the contact reaches further to the trailing side, -x.

Where tau > 0, the traction jumps at the leading edge and the free surface would pierce the cylinder there; it
instead lies against it without pressure and with 0 < q < tau over a width of about (2 R d tau/E*)^2/(2 a);
p is unchanged, because in the plane the shear of that zone acts only where it is.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from refimpl.grid import Array

UNCERTAINTY = 1e-14
"""Relative error of the closed forms: rounding only."""


def dundurs(lower: tuple[float, float], upper: tuple[float, float]) -> tuple[float, float]:
    """Return the reduced modulus E* (Pa) and coupling d of two bodies given as ``(E in Pa, nu)``.

    >>> dundurs((1.0, 0.3), (1.0, 0.3))[1], dundurs((1.0, 0.0), (1e30, 0.3))
    (0.0, (1.0, 0.5))
    """
    compliance = sum((1 - nu**2) / E for E, nu in (lower, upper))
    lower_c, upper_c = ((1 + nu) * (1 - 2 * nu) / (2 * E) for E, nu in (lower, upper))
    return 1 / compliance, (lower_c - upper_c) / compliance


@dataclass(frozen=True)
class SlidingCylinder:
    """``line_load`` (N/m), ``radius`` R (m), ``modulus`` E* (Pa), ``coupling`` d, ``tau`` (Pa), ``beta``."""

    line_load: float
    radius: float
    modulus: float
    coupling: float
    tau: float
    beta: float

    @property
    def exponent(self) -> float:
        """g of the trailing edge; the leading one has 1 - g; tan(pi (1/2 - g)) = d beta."""
        return float(0.5 - np.arctan(self.coupling * self.beta) / np.pi)

    @property
    def half_width(self) -> float:
        """a (m): a^2 = P R / (pi E* g (1 - g))."""
        g = self.exponent
        return float(np.sqrt(self.line_load * self.radius / (np.pi * self.modulus * g * (1 - g))))

    @property
    def centre(self) -> float:
        """Middle of the contact (m) from the cylinder's lowest line: -(1 - 2 g) a - 2 R d tau/E*."""
        return self._tau_shift - (1 - 2 * self.exponent) * self.half_width

    @property
    def _tau_shift(self) -> float:
        return -2 * self.radius * self.coupling * self.tau / self.modulus

    def pressure(self, x: ArrayLike) -> Array:
        """Return p (Pa) at ``x`` (m) from the lowest line, any shape."""
        g, xi = self.exponent, np.asarray(x, dtype=float) - self.centre
        behind, ahead = np.maximum(0.0, self.half_width + xi), np.maximum(0.0, self.half_width - xi)
        height = self.modulus / (2 * self.radius) * np.sin(np.pi * g)
        return np.asarray(height * behind**g * ahead ** (1 - g))

    @property
    def pressure_centroid(self) -> float:
        """Centroid of p (m): a beta distribution's mean, centre + a (2 (1 + g)/3 - 1)."""
        return self.centre + self.half_width * (2 * (1 + self.exponent) / 3 - 1)
