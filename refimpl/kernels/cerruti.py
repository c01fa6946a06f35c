"""The tangential kernel: integral of s/rho^2 over a rectangle (Cerruti 1882; Johnson 1985, section 3.6).

Textbook form: second differences, over the corners, of ``Y/2 log(X^2 + Y^2) + X atan(Y/X)``. It loses
digits with distance as Love's does (case ``kernels/textbook-tangential-fails``) and, being odd in x, close
to x = 0 as well.

Cure. The part of the rectangle that lies symmetrically about the field point cancels exactly, so s may be
taken from ``|x - a|`` to ``x + a``, a = dx/2, and

    over x:  1/2 log1p(2 x dx / ((x - a)^2 + t^2)),        over y:  atan2(s dy, s^2 + (y - b)(y + b)),

both without cancellation and positive; the first vanishes with x to full relative accuracy. Outside they
are summed by quadrature. Inside, in closed form: Y times the first at the two y-ends and X times the second
at the two x-ends. For x < a/2 the latter pair would itself cancel as x -> 0; there the difference of the
angles is taken first:

    (a+x) A(a+x) - (a-x) A(a-x) = x [A(a+x) + A(a-x)] - a [psi(y+b) - psi(y-b)],
    psi(Y) = atan(Y/(a-x)) - atan(Y/(a+x)) = atan2(2 x Y, (a-x)(a+x) + Y^2).

Beyond a/2 that form would multiply rounding by a/b in a long thin element, hence the bound on x.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from refimpl.kernels.quadrature import Kernel

Array = NDArray[np.float64]
_FLOOR = 1e-150  # length whose square must not underflow; t log(length / t) vanishes below it


def over_x(s: Array, y: Array, dy: float) -> Array:
    """Return the angle that the width dy subtends at ``s >= 0``: the integral of s/rho^2 over y."""
    return np.arctan2(s * dy, s * s + (y - dy / 2) * (y + dy / 2))


def over_y(t: Array, x: Array, dx: float) -> Array:
    """Return the integral of s/rho^2 over x at the y-offset ``t``, from ``x >= 0``."""
    near = x - dx / 2
    return 0.5 * np.log1p(2 * dx * x / (near * near + t * t))


def closed_form(x: Array, y: Array, dx: float, dy: float) -> Array:
    """Return the integral over the whole rectangle, from ``x, y >= 0`` anywhere."""
    half = dx / 2
    far, near = x + half, np.abs(x - half)
    below, above = y - dy / 2, y + dy / 2
    logs = _weighted_log(above, x, dx) - _weighted_log(below, x, dx)
    angle_far, angle_near = over_x(far, y, dy), over_x(near, y, dy)
    # The near end is subtracted on either side of x = a, since X A(X) is even in X.
    apart = far * angle_far - near * angle_near
    spread = _angle_between_ends(above, x, half) - _angle_between_ends(below, x, half)
    together = x * (angle_far + angle_near) - half * spread
    return logs + np.where(x < half / 2, together, apart)


def _weighted_log(t: Array, x: Array, dx: float) -> Array:
    """Return ``t * over_y(t)``, 0 at t = 0 even at an end of the element; safe where squares underflow."""
    near = np.maximum(np.hypot(x - dx / 2, t), _FLOOR)
    return 0.5 * t * np.log1p(2 * dx * x / near / near)


def _angle_between_ends(t: Array, x: Array, half: float) -> Array:
    """Return psi(t), the angle between the x-ends seen from ``0 <= x < half``; odd in t."""
    return np.arctan2(2 * x * t, (half - x) * (half + x) + t * t)


CERRUTI = Kernel(closed_form, over_x, over_y)
