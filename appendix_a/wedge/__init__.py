"""Infinite elastic wedge under uniform pressure on both faces near its tip (Tranter 1948; paper Appendix A).

The printed series (A4)-(A9) has faults (see ``printed``), so the solution is derived anew: ``transform``
holds the kernels, ``fast`` sums them in double precision, ``reference`` to any number of digits from other
formulas on another path, ``enclosure`` with rigorous bounds.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from appendix_a.errors import InputError, real, reals
from appendix_a.wedge import fast

__all__ = ["displacements", "stresses"]

Real = NDArray[np.float64]

FACE_SLACK = 1e-12
"""Rad by which theta may exceed the face's angle: a face computed as pi/2 - gamma rounds at 2e-16."""
R_RANGE = (1e-300, 1e300)


def stresses(
    r: ArrayLike, theta: ArrayLike, gamma: float, half_width: float = 1.0
) -> tuple[Real, Real, Real]:
    """Return the stresses (sigma_r, sigma_theta, tau_rtheta) in units of the face pressure, tension positive.

    ``r`` (distance from the tip, the unit of ``half_width``) and ``theta`` (rad) broadcast to the shape of
    the result; faces at ``theta = +-(pi/2 - gamma)``, the bisector ``theta = 0`` points into the body,
    pressure on ``0 < r < half_width`` of both faces. Accurate to 1e-13 of the largest component for gamma
    in [0, 1.5] and r/half_width in [1e-4, 1e4]; at the load's end itself the values are the means of the
    limits along the face. The cost grows like ``1/(pi/2 - gamma)``. Raises InputError for a point outside
    the wedge or a gamma outside [0, pi/2).

    Far away only the radial field that carries the resultant is left (Michell 1900):

    >>> sigma_r, sigma_theta, tau = stresses(1e6, 0.3, gamma=0.2)
    >>> round(float(sigma_r) * 1e6, 5)
    -1.19615
    >>> round(float(-4 * np.cos(0.2) * np.cos(0.3) / (np.pi - 0.4 + np.sin(0.4))), 5)
    -1.19615
    """
    r, theta = _checked(r, theta, gamma, half_width)
    parts = fast.unit_stresses(r.ravel() / half_width, theta.ravel(), gamma)
    sigma_r, sigma_theta, tau = (part.reshape(r.shape) for part in parts)
    return sigma_r, sigma_theta, tau


def displacements(
    r: ArrayLike, theta: ArrayLike, gamma: float, nu: float, half_width: float = 1.0
) -> tuple[Real, Real]:
    """Return displacements relative to the tip: along the bisector, across it towards +theta.

    In units of face pressure times ``half_width`` over E; arguments and errors as for ``stresses``, and an
    InputError for a Poisson ratio ``nu`` outside [0, 1/2]. The bisector does not turn (symmetry), so the
    tip is the only datum.
    """
    r, theta = _checked(r, theta, gamma, half_width)
    if not 0 <= real(nu) <= 0.5:
        raise InputError("nu", nu, "a Poisson ratio in [0, 0.5]")
    along, across = fast.unit_displacements(r.ravel() / half_width, theta.ravel(), gamma, nu)
    return along.reshape(r.shape), across.reshape(r.shape)


def _checked(r: ArrayLike, theta: ArrayLike, gamma: float, half_width: float) -> tuple[Real, Real]:
    """Return ``r`` and ``theta`` broadcast, theta clipped to the faces."""
    if not 0 <= real(gamma) < np.pi / 2:
        raise InputError("gamma", gamma, "an angle of the faces to the mean plane in [0, pi/2) rad")
    if not 0 < real(half_width) < np.inf:
        raise InputError("half_width", half_width, "a positive length")
    allowed = f"positive distances of {R_RANGE[0]:g} to {R_RANGE[1]:g} half-widths"
    r, theta = np.broadcast_arrays(reals("r", r, allowed), reals("theta", theta, "angles in rad"))
    with np.errstate(over="ignore"):  # to infinity, which is refused
        ratio = r / half_width
    usable = (ratio >= R_RANGE[0]) & (ratio <= R_RANGE[1])
    if not np.all(usable):
        raise InputError("r", float(r[~usable][0]), allowed)
    face = np.pi / 2 - gamma
    inside = np.abs(theta) <= face + FACE_SLACK
    if not np.all(inside):
        raise InputError("theta", float(theta[~inside][0]), f"angles within the faces at +-{face!r} rad")
    return r, np.clip(theta, -face, face)
