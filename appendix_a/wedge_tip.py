"""A wedge tip on a half-space pressed near its tip, against the flat strip (paper Appendix A, Fig. 13).

The tip: faces at depth ``|x| tan(gamma)`` below the apex, base at ``|x| < half_base``, pressed over the
strip's half-width a = 1 along each face. As in the paper only the load is matched at the base: the base
tractions are those of the infinite wedge, and the displacement normal to the mean plane is

- on the half-space, beyond the base: what these tractions cause (Flamant); - on the faces: the same under
the point, plus the infinite wedge's own displacement of the face relative to the
  point of the base below it.

In two dimensions displacements need a datum: they count from the surface point x = ``datum``.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from appendix_a import wedge
from appendix_a.errors import InputError, real, reals
from appendix_a.strip.field import flat_displacement

Real = NDArray[np.float64]

GAUSS = np.polynomial.legendre.leggauss(12)
FINEST = 30
"""Panels shrink by halves down to 2^-30 half-bases towards all singular points; 2^-20 differs by 2e-8."""

APEX = 1e-15
"""The apex itself is taken this far off, in half-widths: displacements move by as much."""


def relative_difference(
    x_over_a: ArrayLike, gamma: float, nu: float, *, half_base: float = 10.0, datum: float = 100.0
) -> Real:
    """Return (tip - flat) / flat of the displacements normal to the mean plane at surface points x / a.

    ``gamma`` (rad) is the faces' slope, ``half_base`` half the tip's width and ``datum`` the surface point
    where both displacements are zero, in units of a; at ``x = datum`` the result is NaN. ``datum = 0``
    counts from the apex, as ``fem`` and ``strip`` do. Raises InputError.

    Without a slope there is no tip:

    >>> bool(abs(relative_difference(2.0, 0.0, 0.3)) < 1e-12)
    True
    """
    x = np.asarray(x_over_a, dtype=float)
    tip = tip_displacement(x, gamma, nu, half_base=half_base, datum=datum)
    flat = flat_displacement(x, nu) - flat_displacement(datum, nu)
    return np.divide(tip - flat, flat, out=np.full_like(flat, np.nan), where=flat != 0)


def tip_displacement(x: ArrayLike, gamma: float, nu: float, *, half_base: float, datum: float) -> Real:
    """Return displacements at x into the body, relative to x = datum, in p a / E (plane strain)."""
    if not 0 <= real(gamma) < np.pi / 2:
        raise InputError("gamma", gamma, "a slope angle in [0, pi/2) rad")
    if not real(half_base) > 1:
        raise InputError("half_base", half_base, "a length above the strip's half-width 1")
    if not 0 <= real(nu) <= 0.5:
        raise InputError("nu", nu, "a Poisson ratio in [0, 0.5]")
    x = reals("x", x, "distances from the tip in half-widths")
    zero = _half_space(abs(datum), gamma, nu, half_base) + _local(np.array(abs(datum)), gamma, nu, half_base)
    below = np.array([_half_space(abs(point), gamma, nu, half_base) for point in x.ravel()])
    return np.asarray(below.reshape(x.shape) + _local(np.abs(x), gamma, nu, half_base) - zero)


def base_tractions(x: ArrayLike, gamma: float, half_base: float) -> tuple[Real, Real]:
    """Return the infinite wedge's tractions (along x, into the half-space) on the base at x."""
    x = np.asarray(x, dtype=float)
    depth = half_base * np.tan(gamma)
    theta = np.arctan2(x, depth)
    sigma_r, sigma_theta, tau = wedge.stresses(np.hypot(x, depth), theta, gamma)
    cos, sin = np.cos(theta), np.sin(theta)
    down = sigma_r * cos**2 + sigma_theta * sin**2 - 2 * tau * sin * cos
    along = (sigma_r - sigma_theta) * sin * cos + tau * (cos**2 - sin**2)
    return -along, -down


def _local(x: Real, gamma: float, nu: float, half_base: float) -> Real:
    """Return the wedge's face displacement at x >= 0 less that of the base below it."""
    x = np.clip(x, APEX, half_base)
    depth, face = half_base * np.tan(gamma), np.pi / 2 - gamma
    on_face, _ = wedge.displacements(x / np.cos(gamma), np.full_like(x, face), gamma, nu)
    below = np.minimum(np.arctan2(x, depth), face)
    at_base, _ = wedge.displacements(np.hypot(x, depth), below, gamma, nu)
    return on_face - at_base


def _half_space(x: float, gamma: float, nu: float, half_base: float) -> float:
    """Return the half-space's displacement at x >= 0 under the base tractions, up to a datum.

    The pressure is even and the shear odd in s, so both sums run over 0 < s < half_base.
    """
    s, weights = graded_nodes([0.0, np.cos(gamma), min(x, half_base), half_base], half_base)
    along, down = base_tractions(s, gamma, half_base)
    logs = np.log(np.abs(x - s)) + np.log(x + s)
    normal = -2 * (1 - nu**2) / np.pi * down * logs
    tangential = -(1 + nu) * (1 - 2 * nu) * along * (s > x)
    return float(np.sum(weights * (normal + tangential)))


def graded_nodes(centres: list[float], end: float) -> tuple[Real, Real]:
    """Return Gauss nodes and weights on (0, end), on panels that shrink towards ``centres``."""
    halves = end * 2.0 ** np.arange(0, -FINEST, -1)
    graded = [c + side * halves for c in centres for side in (-1, 1)]
    edges = np.concatenate([*graded, [0.0, end, *centres]])
    ends = np.unique(edges[(edges >= 0) & (edges <= end)])
    middle, half = (ends[1:] + ends[:-1]) / 2, np.diff(ends) / 2
    return (middle[:, None] + half[:, None] * GAUSS[0]).ravel(), (half[:, None] * GAUSS[1]).ravel()
