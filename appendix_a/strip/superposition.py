"""The paper's own strip theory, (A1)-(A3): pseudo tractions on the wavy line, and what they displace.

``theta`` of (A3) decides whether it holds. Cauchy's formula on a boundary with outward normal n gives the
components ``sigma_x n_x + tau n_y`` and ``tau n_x + sigma_y n_y``; (A3) is that for ``theta`` the direction
angle of the normal, ``n = (cos theta, sin theta)``. "The slope of the boundary", as printed, it cannot be:
on a flat boundary (slope 0) it would ask for a shear traction ``-sigma_x = p`` under the whole strip.
"""

from __future__ import annotations

from enum import StrEnum

import numpy as np
from numpy.typing import ArrayLike, NDArray

from appendix_a.errors import InputError, real, reals
from appendix_a.strip.field import flat_displacement, stresses
from appendix_a.strip.profile import Sinusoid

Real = NDArray[np.float64]

GAUSS = np.polynomial.legendre.leggauss(12)
REACH = 30.0
"""Wavelengths integrated on either side; twice as many change the result by less than 2e-9 p a / E."""
PANELS_PER_WAVE = 8
FINEST = 40
"""Panels shrink by halves down to 2^-40 towards the strip's ends and the logarithm's pole."""


class Theta(StrEnum):
    """Readings of theta in (A3)."""

    SLOPE = "slope"  # as printed: the boundary's slope
    NORMAL = "normal"  # the direction angle of the outward normal


def pseudo_tractions(x: ArrayLike, profile: Sinusoid, theta: Theta) -> tuple[Real, Real]:
    """Return (X, Y) of (A3) per unit pressure on the wavy line at x; ``profile`` has a crest at x = 0."""
    x = np.asarray(x, dtype=float)
    sigma_x, sigma_y, tau = stresses(x, profile.depth(x))
    angle = profile.slope(x) - (np.pi / 2 if theta is Theta.NORMAL else 0.0)
    cos, sin = np.cos(angle), np.sin(angle)
    return -(sigma_x * cos + tau * sin), -(sigma_y * sin + tau * cos)


def applied(x: ArrayLike, profile: Sinusoid) -> tuple[Real, Real]:
    """Return the traction of unit pressure along the local normal on |x| < 1."""
    x = np.asarray(x, dtype=float)
    inside, slope = np.abs(x) < 1, profile.slope(x)
    return np.where(inside, -np.sin(slope), 0.0), np.where(inside, np.cos(slope), 0.0)


def printed(
    slope_deg: float, wavelength: float, nu: float, *, offsets: ArrayLike, theta: Theta = Theta.NORMAL
) -> tuple[Real, Real]:
    """Return (wavy, flat) as ``first_order`` for a strip on a crest, by the paper's superposition.

    The pseudo tractions, plus the applied ones where (A3) would cancel the load itself, act on the flat
    boundary of a half-plane (Flamant). Exact to first order in the slope for ``Theta.NORMAL``, but for the
    strain between the flat and the wavy line, which the paper neglects. Raises InputError.
    """
    if not -1 < real(nu) <= 0.5:
        raise InputError("nu", nu, "a Poisson ratio, -1 < nu <= 0.5")
    profile = Sinusoid(slope_deg, wavelength, 0.0)
    offsets = np.atleast_1d(reals("offsets", offsets, "distances from the centre in half-widths"))
    flat = flat_displacement(offsets, nu)
    centre, *change = (_surface(x, profile, theta, nu) for x in (0.0, *offsets))
    return flat + np.array(change) - centre, flat


def flamant(x: float, s: Real, along: Real, down: Real, nu: float) -> float:
    """Return a half-plane's vertical displacement at x under forces (along, down) (n,) at s, E = 1.

    Up to the constant of the datum; Johnson 1985, Eqs (2.19) and (2.22).
    """
    normal = -2 * (1 - nu**2) / np.pi * down * np.log(np.abs(x - s))
    tangential = (1 + nu) * (1 - 2 * nu) / 2 * along * np.sign(x - s)
    return float(np.sum(normal + tangential))


def _surface(x: float, profile: Sinusoid, theta: Theta, nu: float) -> float:
    """Return the Flamant superposition of the net pseudo tractions at x, up to the datum's constant."""
    s, weights = graded_nodes([-1.0, 1.0, x, 0.0], profile.wavelength)
    along, down = pseudo_tractions(s, profile, theta)
    load_along, load_down = applied(s, profile)
    return flamant(x, s, weights * (along + load_along), weights * (down + load_down), nu)


def graded_nodes(centres: list[float], wavelength: float) -> tuple[Real, Real]:
    """Return Gauss nodes and weights on panels that resolve the waves and shrink towards ``centres``."""
    waves = np.arange(-REACH, REACH + 0.5 / PANELS_PER_WAVE, 1 / PANELS_PER_WAVE) * wavelength
    halves = 2.0 ** np.arange(np.ceil(np.log2(wavelength)), -FINEST, -1)
    graded = [np.concatenate([c - halves, [c], c + halves]) for c in centres]
    ends = np.unique(np.concatenate([waves, *graded]))
    middle, half = (ends[1:] + ends[:-1]) / 2, np.diff(ends) / 2
    return (middle[:, None] + half[:, None] * GAUSS[0]).ravel(), (half[:, None] * GAUSS[1]).ravel()
