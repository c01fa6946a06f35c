"""Exact surface displacement of a body with a smooth bump under a strip of normal pressure, plane strain.

The upper half-plane of zeta is mapped onto the body by w = zeta + c / (zeta + i b), whose boundary has the
bump x = t + c t / (t^2 + b^2), y = -c b / (t^2 + b^2), y into the body.  For a rational map Muskhelishvili's
boundary equation  phi + w conj(phi' / w') + conj(psi) = f  is solved by a Cauchy integral and one complex
number.  Nothing here is shared with the finite elements it judges, and the slope is finite.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import quad
from scipy.optimize import brentq

Array = NDArray[np.float64]


@dataclass(frozen=True)
class RationalBump:
    """Bump of strength c (length^2) and breadth b under unit pressure between t1 and t2; E = 1.

    Lengths in units of half the strip's arc length, if t1 and t2 are chosen by `centred_at`.
    """

    c: float
    b: float
    t0: float
    t1: float
    t2: float

    @classmethod
    def centred_at(cls, c: float, b: float, t0: float) -> RationalBump:
        """Return the strip reaching arc length 1 to both sides of the boundary point w(t0)."""
        bare = cls(c, b, t0, t0, t0)

        def end(direction: int) -> float:
            def excess(t: float) -> float:
                length, _ = quad(lambda s: abs(bare.slope_of_map(s)), t0, t, epsabs=1e-14, epsrel=1e-13)
                return float(direction * length - 1.0)

            return float(brentq(excess, t0, t0 + 3.0 * direction, xtol=1e-14))

        return cls(c, b, t0, end(-1), end(+1))

    def map(self, t: complex) -> complex:
        """Return w(zeta)."""
        return t + self.c / (t + 1j * self.b)

    def slope_of_map(self, t: complex) -> complex:
        """Return w'(zeta)."""
        return 1.0 - self.c / (t + 1j * self.b) ** 2

    def parameter(self, x: float) -> float:
        """Return t of the boundary point with abscissa x from the strip's centre."""
        target = x + self.map(self.t0).real
        span = abs(self.c) / self.b + 1.0
        return float(brentq(lambda t: self.map(t).real - target, target - span, target + span, xtol=1e-14))

    def height(self, x: Array) -> Array:
        """Return the profile y(x) relative to the strip's centre."""
        base = self.map(self.t0).imag
        flat = [self.map(self.parameter(value)).imag - base for value in np.ravel(x)]
        return np.array(flat).reshape(np.shape(x))

    def potential(self, t: float) -> complex:
        """Return phi(t) on the boundary, up to a constant: the Cauchy integral of f less the pole's part."""
        pole = -1j * self.b
        mirror = pole.conjugate()
        gain = self.c / (mirror - pole) ** 2
        # A = conj((Phi'(mirror) + gain A) / w'(mirror)): two real equations for A
        scale, source = 1.0 / self.slope_of_map(mirror), self._cauchy_slope(mirror)
        matrix = np.array(
            [
                [1.0 - (scale * gain).real, (scale * gain).imag],
                [(scale * gain).imag, 1.0 + (scale * gain).real],
            ]
        )
        known = (scale * source).conjugate()
        real, imag = np.linalg.solve(matrix, [known.real, known.imag])
        return self._cauchy(t) - self.c * complex(real, imag) / (t - pole)

    def displacement(self, x: float, nu: float) -> complex:
        """Return u_x + i u_y of the boundary at abscissa x, up to a constant; pressure length / E."""
        kappa, shear = 3.0 - 4.0 * nu, 0.5 / (1.0 + nu)
        t = self.parameter(x)
        pressed = self.map(min(max(t, self.t1), self.t2)) - self.map(self.t1)
        return ((kappa + 1.0) * self.potential(t) + pressed) / (2.0 * shear)

    def relative(self, x: Array, nu: float) -> Array:
        """Return u_y(x) - u_y(0) at abscissae x from the strip's centre."""
        centre = self.displacement(0.0, nu).imag
        return np.array([self.displacement(float(value), nu).imag - centre for value in x])

    def _cauchy(self, t: float) -> complex:
        """Return (1 / 2 pi i) times the integral of w'(s) ln(s - t) over the strip, from above."""
        cut = min(max(t, self.t1), self.t2)

        def part(component: str, lower: float, upper: float) -> float:
            if upper - lower < 1e-15:
                return 0.0
            value, _ = quad(
                lambda s: getattr(self.slope_of_map(s), component) * np.log(max(abs(s - t), 1e-300)),
                lower,
                upper,
                epsabs=1e-13,
                epsrel=1e-12,
                limit=200,
            )
            return float(value)

        real = sum(part("real", *ends) for ends in ((self.t1, cut), (cut, self.t2)))
        imag = sum(part("imag", *ends) for ends in ((self.t1, cut), (cut, self.t2)))
        passed = self.map(cut) - self.map(self.t1)  # where s < t the logarithm's argument is -pi
        return (complex(real, imag) - 1j * np.pi * passed) / (2j * np.pi)

    def _cauchy_slope(self, zeta: complex) -> complex:
        """Return -(1 / 2 pi i) times the integral of w'(s) / (s - zeta) over the strip, zeta inside."""
        nodes, weights = np.polynomial.legendre.leggauss(60)  # to rounding: zeta is b away from the strip
        s = (self.t1 + self.t2) / 2 + (self.t2 - self.t1) / 2 * nodes
        values = np.array([self.slope_of_map(float(v)) / (v - zeta) for v in s])
        return complex(-(self.t2 - self.t1) / 2 * (weights @ values) / (2j * np.pi))
