"""Gauss-Legendre quadrature across an element seen from outside, with orders taken from an error bound.

The inner integral of either kernel, over one edge direction, is exact; the outer one runs over the other,
``half * integral_{-1}^{1} f(z) dz`` at the offset ``centre + half z``. Put ``q = centre / half > 1``.
Both kernels are powers of ``(s + i t)(s - i t)`` (and ``s``), so for complex ``|half z| <= kappa centre``,
``kappa < 1``, each factor keeps ``(1 - kappa) ... (1 + kappa)`` of its value at the centre, and

    |f(z)| <= (1 + kappa) / (1 - kappa)^2 f(0),      f >= (1 - 1/q) / (1 + 1/q)^2 f(0)  on [-1, 1].

Hence f is analytic in the Bernstein ellipse of semi-axis ``kappa q``, ``rho = kappa q + sqrt((kappa q)^2 -
1)``, whatever the other offset and the aspect ratio. Its Chebyshev coefficients are at most ``2 max|f|
rho^-k``, and an n-point rule (n >= 2) is exact below k = 2n, blind to odd k, and misses an even T_k by at
most ``2 + 2/(k^2 - 1) <= 32/15``. The sum of that geometric series, over ``2 min f``, bounds the relative
error: ``relative_error_bound``.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Integrand = Callable[[Array, Array, float], Array]
"""``(outer offset > 0, inner offset >= 0, inner edge)`` to the exact inner integral."""

# Truncation allowed to the quadrature: about the rounding of one evaluation, a hundredth of the promised
# 1e-13.
TRUNCATION = 1e-15
# Centre over half-width from which quadrature takes over (offsets of three elements and more). The closed
# form multiplies rounding by up to q_x + q_y + 2 (love.py), 14 here; nearer still, quadrature would need
# ever more points.
NEAR = 6.0
ORDERS = range(2, 10)  # 9 points suffice at NEAR


class Kernel(NamedTuple):
    """A kernel: closed form of ``(x, y, dx, dy)``, inner integrals for quadrature over x and over y."""

    closed_form: Callable[[Array, Array, float, float], Array]
    over_x: Integrand
    over_y: Integrand


class Rule(NamedTuple):
    """Gauss-Legendre nodes and weights on [-1, 1]."""

    nodes: Array
    weights: Array


def relative_error_bound(order: int, q: float) -> float:
    """Bound on the relative truncation error of ``order >= 2`` points at ``q = centre / half-width``.

    ``kappa = n/(n+1)`` minimises ``kappa^(-2n) (1-kappa)^(-2)``.

    >>> relative_error_bound(3, 400.0) < 1e-14 < relative_error_bound(3, 100.0)
    True
    """
    kappa = order / (order + 1)
    if kappa * q <= 1:
        return np.inf
    rho = kappa * q + np.sqrt((kappa * q) ** 2 - 1)
    growth = (1 + kappa) / (1 - kappa) ** 2 * (1 + 1 / q) ** 2 / (1 - 1 / q)
    return float(32 / 15 * growth * rho ** (-2 * order) / (1 - rho**-2))


@cache
def reach(order: int) -> float:
    """Return the least ``q >= NEAR`` from which ``order`` points stay within `TRUNCATION`."""
    low, high = NEAR, 1e9
    if relative_error_bound(order, low) <= TRUNCATION:
        return low
    while high / low > 1 + 1e-9:
        middle = np.sqrt(low * high)
        low, high = (low, middle) if relative_error_bound(order, middle) <= TRUNCATION else (middle, high)
    return float(high)


@cache
def rule(order: int) -> Rule:
    """Return the ``order``-point Gauss-Legendre rule."""
    return Rule(*np.polynomial.legendre.leggauss(order))


@cache
def order_for(q: float) -> int:
    """Return the fewest points that suffice from ``q >= NEAR`` on."""
    return min(order for order in ORDERS if reach(order) <= q)


@cache
def shells() -> list[tuple[float, float, int]]:
    """Return ``(q_from, q_to, order)``: the fewest points that suffice, from ``NEAR`` to infinity."""
    starts = sorted({reach(order) for order in ORDERS})
    return [(low, high, order_for(low)) for low, high in zip(starts, [*starts[1:], np.inf], strict=True)]


def across(
    inner: Integrand, outer: Array, other: Array, edge_outer: float, edge_other: float, order: int
) -> Array:
    """Return the quadrature of ``inner`` over the element's extent about ``outer``; shapes broadcast."""
    half = edge_outer / 2
    nodes, weights = rule(order)
    axes = np.broadcast(outer, other).ndim
    values = inner(outer + half * nodes.reshape(-1, *axes * [1]), other, edge_other)  # a call for all nodes
    total: Array = weights[0] * values[0]
    for weight, value in zip(weights[1:], values[1:], strict=True):
        total += weight * value
    return half * total
