"""Wedge stresses to any number of digits, by a formulation that shares nothing with ``fast``.

Polar stress kernels straight from the Airy function (no potentials), nothing subtracted, and a hyperbola in
place of the line: it opens to the left for r < 1 and to the right for r >= 1, so that ``r^-z`` falls off
exponentially on it, on the faces too, and the trapezoidal rule converges geometrically (Weideman &
Trefethen 2007). Its asymptotes stand 58 degrees off the real axis; no zero of D = sin(2 alpha z) + z sin(2
alpha) stands further off than 28.1 degrees, which the first zero of sin w + w attains (gamma -> pi/2), so
all poles stay on their side.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import mpmath as mp

BEND, RISE = 0.5, 0.8
"""z(u) = -1/2 -+ BEND (cosh u - 1) + i RISE sinh u: analytic and decaying for |Im u| < 0.5."""
GUARD = 25
"""Extra working digits: arguments reach |z| = 1e10 (r = 1, 1e-8 off a face), and 10 more for the sums."""
HALVINGS = 6
QUIET_TERMS = 8
"""The sum ends after so many negligible terms in a row: one alone may be a zero of the oscillation."""
NEGLIGIBLE = 1e-5


class NotConverged(ArithmeticError):
    """The step was halved as often as allowed and two sums still differ by more than the tolerance."""


@dataclass(frozen=True)
class Reference:
    """(sigma_r, sigma_theta, tau) as mpf, and their last change under halving the step (error estimate)."""

    values: tuple[Any, Any, Any]
    error: Any


def kernels(z: Any, theta: Any, gamma: Any) -> tuple[Any, Any, Any]:
    """Return the kernels k of (sigma_r, sigma_theta, tau): r sigma = (1/2 pi i) int k(z) r^-z dz."""
    alpha = mp.pi / 2 - gamma
    d = mp.sin(2 * alpha * z) + z * mp.sin(2 * alpha)
    plus, minus = mp.sin((1 + z) * alpha), mp.sin((1 - z) * alpha)
    a, b = (1 + z) * plus * mp.cos((1 - z) * theta), minus * mp.cos((1 + z) * theta)
    shear = minus * mp.sin((1 + z) * theta) - plus * mp.sin((1 - z) * theta)
    return (a + (3 + z) * b) / ((1 + z) * d), -(a - (1 - z) * b) / ((1 + z) * d), shear / d


def stresses(r: Any, theta: Any, gamma: Any, digits: int = 30) -> Reference:
    """Return the stresses of unit pressure on 0 < r < 1 of both faces, to ``digits`` digits after the point.

    Any point but the ends of the load (r = 1 on a face). Raises NotConverged.
    """
    with mp.workdps(digits + GUARD):
        point = mp.mpf(r), mp.mpf(theta), mp.mpf(gamma)
        small, step = mp.mpf(10) ** -digits, mp.mpf("1.3") / digits
        total = [step * f for f in _sum(point, mp.mpf(0), step, small)]
        for _ in range(HALVINGS):
            between = _sum(point, step / 2, step, small)
            finer = [(t + step * f) / 2 for t, f in zip(total, between, strict=True)]
            error = max(abs(f - t) for f, t in zip(finer, total, strict=True))
            total, step = finer, step / 2
            if error < small:
                return Reference((total[0], total[1], total[2]), error)
    raise NotConverged(f"wedge stresses at {r}, {theta}, {gamma}: last change {mp.nstr(error, 3)}")


def _sum(point: tuple[Any, Any, Any], start: Any, step: Any, small: Any) -> list[Any]:
    """Sum of (1/pi) Im kernel r^(-1-z) dz/du over u = start, start + step, ... until the terms are small.

    The lower half of the path is the conjugate of the upper one; u = 0 counts half.
    """
    r, theta, gamma = point
    side, log_r = (1 if r >= 1 else -1), mp.log(r)
    sums, quiet, u = [mp.mpf(0)] * 3, 0, start
    while quiet < QUIET_TERMS:
        cosh, sinh = mp.cosh(u), mp.sinh(u)
        z = mp.mpc(side * BEND * (cosh - 1) - mp.mpf(1) / 2, RISE * sinh)
        weight = mp.exp(-(1 + z) * log_r) * mp.mpc(side * BEND * sinh, RISE * cosh) / (2 if u == 0 else 1)
        terms = [(k * weight).imag / mp.pi for k in kernels(z, theta, gamma)]
        sums = [s + t for s, t in zip(sums, terms, strict=True)]
        quiet = quiet + 1 if max(abs(t) for t in terms) < small * NEGLIGIBLE else 0
        u += step
    return sums
