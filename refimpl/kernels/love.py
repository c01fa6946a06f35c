"""The normal kernel: integral of 1/rho over a rectangle (Love 1929; Johnson 1985, Eq. 3.25).

Textbook form: second differences, over the four corners, of ``X asinh(Y/X) + Y asinh(X/Y)``. Each term
grows with distance while the sum decays, so n elements from the load the error is about n^2 eps: at a
million elements four of sixteen digits are left (case ``kernels/textbook-normal-fails``).

Cure. The potential of a uniformly charged segment, with its ends at s1 < s2 and t off its line, is

    strip = log[(R1 + R2 + (s2 - s1)) / (R1 + R2 - (s2 - s1))],    R = hypot(s, t).

With ``R1 + s1`` and ``R2 - s2`` written free of cancellation the argument is ``1 + a positive number``, and
log1p keeps its relative accuracy near and far. The rectangle is then either four such strips, each times
its distance from the field point (divergence theorem), or, from outside, quadrature over strips.

The four strips are positive, and each is at most ``(q + 1)/2`` of the whole, ``q = 2 offset / edge`` across
it: the strip is least on the far edge, and t times strip grows with t. So rounding grows at most by
``q_x + q_y + 2``.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from refimpl.kernels.quadrature import Kernel

Array = NDArray[np.float64]
_TINY = float(np.finfo(np.float64).tiny)


def strip(centre: Array, t: Array, length: float) -> Array:
    """Return the integral of 1/rho along a segment, seen from ``t > 0`` off it, ``centre >= 0`` along it.

    >>> bool(np.isclose(strip(np.array(0.0), np.array(1.0), 2.0), 2 * np.arcsinh(1.0), rtol=1e-15))
    True
    """
    near_end, far_end = centre - length / 2, centre + length / 2
    squared = t * t
    reach = np.sqrt(near_end * near_end + squared) + np.abs(near_end)
    near_sum = np.where(near_end < 0, squared / reach, reach)
    far_difference = squared / (np.sqrt(far_end * far_end + squared) + far_end)
    return np.log1p(2 * length / (near_sum + far_difference))


def weighted_edge(centre: Array, t: Array, length: float) -> Array:
    """Return ``t * strip`` at signed distance ``t``, 0 on its line; safe where ``t^2`` underflows."""
    distance = np.abs(t)
    near_end, far_end = centre - length / 2, centre + length / 2
    near_reach = np.maximum(np.hypot(near_end, distance) + np.abs(near_end), _TINY)
    far_reach = np.hypot(far_end, distance) + far_end
    near_sum = np.where(near_end < 0, distance * (distance / near_reach), near_reach)
    # Below the floor t < 1e-150 length, where t log(length / t) adds nothing to the other edges.
    excess = np.maximum(near_sum + distance * (distance / far_reach), _TINY)
    return np.asarray(t * np.log1p(2 * length / excess))


def closed_form(x: Array, y: Array, dx: float, dy: float) -> Array:
    """Return the integral over the whole rectangle, from ``x, y >= 0`` anywhere, as four edges."""
    across = weighted_edge(y, x + dx / 2, dy) - weighted_edge(y, x - dx / 2, dy)
    along = weighted_edge(x, y + dy / 2, dx) - weighted_edge(x, y - dy / 2, dx)
    return across + along


def over_x(s: Array, y: Array, dy: float) -> Array:
    """Return the inner integral over y at the x-offset ``s``: what the outer quadrature over x sums."""
    return strip(y, s, dy)


def over_y(t: Array, x: Array, dx: float) -> Array:
    """Return the inner integral over x at the y-offset ``t``: what the outer quadrature over y sums."""
    return strip(x, t, dx)


LOVE = Kernel(closed_form, over_x, over_y)
