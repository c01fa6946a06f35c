"""Indentation with friction coupling, in closed form: two three-dimensional problems with an exact answer.

Both rest on Gauss's law in the plane: under an axisymmetric traction q(r) along x the coupling displacement
is c0 x Q(r)/r^2, where Q(r) is the traction force within r and c0 = (1 + nu)(1 - 2 nu)/(2 pi E) of the lower
body minus that of the upper body.

1. `CoupledHertz` (any tau and beta): the sphere's gap less the coupling displacement of the Hertz pressure's
   own friction. Its exact sliding state is the unshifted Hertz pressure; everything (a, c, tau, beta) enters.
2. `ShearedSphere` (beta = 0): uniform tau on a disc displaces c0 pi tau x inside, a slope, so the paraboloid
   only moves: Hertz pressure about x = -pi c0 tau R. The jump of q at the leading edge presses the free
   surface against the sphere over a width ~ shift^2/2a, which is neglected: relative error (shift/a)^3.

`first_order_shift` has both, for a plain sphere: to first order in c0, by the reciprocal theorem.
"""

from __future__ import annotations

from dataclasses import dataclass

import mpmath as mp
import numpy as np
from numpy.typing import ArrayLike

from refimpl.grid import Array
from verification.exact.hertz import Sphere

UNCERTAINTY = 1e-13
"""Relative error of `CoupledHertz`: rounding (checked by two-dimensional quadrature)."""


@dataclass(frozen=True)
class CoupledHertz:
    """The ``hertz`` contact under friction ``tau`` (Pa) and ``beta`` along x, coupling ``c0`` (1/Pa)."""

    hertz: Sphere
    c0: float
    tau: float
    beta: float

    def traction_force(self, r: ArrayLike) -> Array:
        """Return Q(r) (N): tau pi r^2 + beta P (1 - (1 - r^2/a^2)^(3/2)), constant beyond a."""
        a = self.hertz.contact_radius
        rho2 = np.minimum(1.0, (np.asarray(r, dtype=float) / a) ** 2)
        return np.asarray(self.tau * np.pi * a**2 * rho2 + self.beta * self.hertz.load * _carried(rho2))

    def coupling_displacement(self, x: ArrayLike, y: ArrayLike) -> Array:
        """Return the normal displacement by friction alone (m) at ``(x, y)`` (m), shapes broadcast."""
        a = self.hertz.contact_radius
        x, r2 = np.asarray(x, dtype=float), np.asarray(x, dtype=float) ** 2 + np.asarray(y, dtype=float) ** 2
        rho2 = np.maximum(r2 / a**2, np.finfo(float).tiny)
        inner = np.minimum(1.0, rho2)
        # Q(r)/r^2 with r^2 cancelled inside: (1 - (1 - s)^(3/2))/s is smooth at s = 0
        force = self.tau * np.pi * a**2 * inner + self.beta * self.hertz.load * _carried(inner)
        return np.asarray(self.c0 * x * (force / rho2) / a**2)

    def gap(self, x: ArrayLike, y: ArrayLike) -> Array:
        """Return the gap (m) of this exact sliding state: (x^2 + y^2)/2R less coupling; not shifted."""
        r2 = np.asarray(x, dtype=float) ** 2 + np.asarray(y, dtype=float) ** 2
        return np.asarray(r2 / (2 * self.hertz.radius) - self.coupling_displacement(x, y))

    @property
    def friction_force(self) -> float:
        """F (N) = tau pi a^2 + beta P."""
        return float(self.traction_force(self.hertz.contact_radius))


def _carried(rho2: Array) -> Array:
    """Return the share of the Hertz load within r, 1 - (1 - rho^2)^(3/2), stable near the axis."""
    root = np.sqrt(1 - rho2)
    return np.asarray(rho2 * (1 + root + root**2) / (1 + root))


@dataclass(frozen=True)
class ShearedSphere:
    """The ``hertz`` sphere under uniform shear strength ``tau`` (Pa) along x, coupling ``c0`` (1/Pa)."""

    hertz: Sphere
    c0: float
    tau: float

    @property
    def shift(self) -> float:
        """Centre of the contact along x (m): negative, trailing, for a hard sphere on a softer flat."""
        return -np.pi * self.c0 * self.tau * self.hertz.radius

    @property
    def approach(self) -> float:
        """delta (m): Hertz's plus shift^2/2R."""
        return self.hertz.approach + self.shift**2 / (2 * self.hertz.radius)

    def pressure(self, x: ArrayLike, y: ArrayLike) -> Array:
        """Return p (Pa) at ``(x, y)`` (m) from the sphere's lowest point, shapes broadcast."""
        ahead = np.asarray(x, dtype=float) - self.shift
        return self.hertz.pressure(np.hypot(ahead, np.asarray(y, dtype=float)))

    @property
    def uncertainty(self) -> float:
        """Relative error by the pressureless zone at the leading edge."""
        return abs(self.shift / self.hertz.contact_radius) ** 3


def first_order_shift(hertz: Sphere, c0: float, tau: float, beta: float) -> float:
    """Return the pressure's centroid along x (m) under ``r = tau + beta p``, to order ``c0`` (1/Pa).

    By Betti's theorem with a tilted punch's pressure, (2 E*/pi) x (a^2 - r^2)^(-1/2) per unit tilt: the
    moment changes by -2 E* c0 times the integral of Q(r) r (a^2 - r^2)^(-1/2) over 0 < r < a. tau contributes
    -pi c0 tau R, as in `ShearedSphere`, and beta -(3/2) E* c0 beta a.
    """
    by_tau = np.pi * tau * hertz.radius
    return float(-c0 * (by_tau + 1.5 * hertz.modulus * beta * hertz.contact_radius))


def coupling_by_quadrature(state: CoupledHertz, x: float, y: float) -> tuple[float, float]:
    """Return the coupling displacement (m) at ``(x, y)`` (m) in contact by s/rho^2, and its error.

    In polar coordinates about the field point s/rho^2 rho = cos w, and the traction along each ray has an
    elementary integral: the Hertz part is half an ellipse's chord segment.
    """
    with mp.workdps(20):
        a, peak = mp.mpf(state.hertz.contact_radius), mp.mpf(state.hertz.peak_pressure)

        def ray(w: mp.mpf) -> mp.mpf:
            along = x * mp.cos(w) + y * mp.sin(w)
            half = mp.sqrt(a**2 - mp.mpf(x) ** 2 - mp.mpf(y) ** 2 + along**2)
            # rho from 0 to along + half; p = (peak/a) sqrt(half^2 - (rho - along)^2)
            behind = along * mp.sqrt(half**2 - along**2) + half**2 * mp.asin(along / half)
            segment = mp.pi / 4 * half**2 + behind / 2
            return mp.cos(w) * (state.tau * (along + half) + state.beta * peak / a * segment)

        value, error = mp.quad(ray, mp.linspace(-mp.pi, mp.pi, 5), error=True)
        return float(state.c0 * value), float(abs(state.c0) * error)
