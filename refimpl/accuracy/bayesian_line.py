"""A Bayesian line through the numbers found on a sequence of grids: the continuous problem's, and its bound.

A number ``y_k`` found on grid k is modelled as

    y_k = q + c e_k + r_k,   c ~ N(c0, s_c^2),   r_k ~ N(0, (sigma w_k)^2),   sigma^2 ~ scaled inverse chi^2.

``q``, the number of the continuous problem, is normal given c and sigma; sigma integrates to a Student
distribution, and c numerically (Gelman et al. 2013, ch. 3, 14).
"""

from __future__ import annotations

import math
from functools import cache
from typing import NamedTuple

import numpy as np
import scipy

from refimpl.grid import Array

DEFAULT_ORDER = 1.5  # at which the scatter of a number falls, where nothing else is known
_TWO_SIDED, _ONE_SIDED = 1.959964, 1.644854  # a normal distribution's 95 %
_HALVINGS = 17  # halvings of the interval of a bound: to 1e-5 of it


class Prior(NamedTuple):
    """Prior of sigma: its value on the finest grid in the number's unit, and its weight in grids."""

    scatter: float
    weight: float


class Bias(NamedTuple):
    """Bias of each grid's number: ``sizes`` times a factor of that mean and standard deviation."""

    sizes: Array
    mean: float
    spread: float


class Intercept(NamedTuple):
    """A number of the continuous problem, and the 95 % bound of its error.

    ``orders`` are those at which a grid's number approaches it and at which the bound falls, in element size.
    """

    value: float
    half_width: float
    orders: tuple[float, float] = (1.0, DEFAULT_ORDER)

    def widened(self, bound: float) -> Intercept:
        """Return the estimate with an independent error of that 95 % bound added."""
        return self._replace(half_width=math.hypot(self.half_width, bound))

    def predicted_bound(self, found: float, finer: float) -> float:
        """Return the error bound on a grid with elements ``finer`` times the size, from this grid's number.

        >>> first, second = Intercept(1.0, 0.0), Intercept(1.0, 0.0, orders=(2.0, 2.0))
        >>> first.predicted_bound(1.5, 0.5), second.predicted_bound(1.5, 0.5)
        (0.25, 0.125)
        """
        approaching, falling = self.orders
        return Intercept(self.value, self.half_width * finer**falling).error_bound(
            self.value + (found - self.value) * finer**approaching
        )

    def error_bound(self, found: float) -> float:
        """Return the 95 % bound of the error of a number found on a grid.

        A normal distribution's, of which the bound needs one side alone where the number found is far off.
        Of the wider tails that make ``half_width`` one side is shorter still.

        >>> [round(Intercept(1.0, 0.1).error_bound(found), 6) for found in (1.0, 1.05, 1.5)]
        [0.1, 0.134, 0.583923]
        """
        distance, deviation = abs(found - self.value), self.half_width / _TWO_SIDED
        if not distance < 3 * deviation:
            return distance + _ONE_SIDED * deviation
        return deviation * math.sqrt(scipy.special.chndtrix(0.95, 1.0, (distance / deviation) ** 2))


def fit_line(values: Array, weights: Array, prior: Prior, bias: Bias | None = None) -> Intercept:
    """Return the estimate of ``q`` from ``values`` on grids coarse to fine with ``w_k = weights``.

    ``prior.scatter`` is sigma of the finest grid in the number's unit. Zeros on all grids are exact only
    where that is zero too: symmetry alone leaves its scatter.

    >>> fit_line(np.array([1.04, 1.02, 1.01]), np.array([8.0, 2.8, 1.0]), Prior(0.001, 1.0)).value < 1.015
    True
    """
    if not (np.any(values) or prior.scatter > 0):
        return Intercept(0.0, 0.0)
    factors, shares = (np.zeros(1), np.ones(1)) if bias is None else _factors(bias.mean, bias.spread)
    rest = values - factors[:, None] * (0 if bias is None else bias.sizes)
    precision = weights**-2.0
    centre = rest @ precision / precision.sum()
    squares = ((rest - centre[:, None]) ** 2) @ precision
    freedom = prior.weight + len(values) - 1
    variance = (prior.weight * prior.scatter**2 + squares) / freedom
    variance = np.maximum(variance, np.finfo(float).tiny + (np.finfo(float).eps * values[-1]) ** 2)
    shares = shares * (variance / variance.min()) ** (-0.5 * freedom)
    shares = shares / shares.sum()
    value = float(shares @ centre)
    scale = np.sqrt(variance / precision.sum())
    return Intercept(value, _bound(shares, centre - value, scale, freedom))


def _bound(shares: Array, centres: Array, scales: Array, freedom: float) -> float:
    """Return the bound that a mixture of Student distributions exceeds, in either direction, with 5 %."""
    widest = float(np.max(np.abs(centres)) + np.max(scales) * scipy.special.stdtrit(freedom, 0.975))
    if len(shares) == 1:
        return widest

    either_way = np.array([centres, -centres])

    def beyond(share: float) -> float:
        tails = scipy.special.stdtr(freedom, (either_way - share * widest) / scales)
        return float((tails @ shares).sum()) - 0.05

    if not beyond(1.0) < 0:
        return widest
    low, high = 0.0, 1.0  # bisection here: scipy.optimize takes longer to import than a small scene to solve
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if beyond(middle) > 0 else (low, middle)
    return widest * high


@cache
def _factors(mean: float, spread: float) -> tuple[Array, Array]:
    """Return nodes and weights of ``c``'s prior; nine give nine bars in ten to 1.5 % (a test)."""
    nodes, weights = np.polynomial.hermite_e.hermegauss(9)
    return mean + spread * nodes, weights / weights.sum()
