"""Observed orders of convergence, extrapolated values, and the grid uncertainty that follows from them.

Two situations: errors against a known value (`fit_order`), and values whose limit is unknown (`extrapolate`:
Richardson's extrapolation with Roache's grid convergence index). Both fit all grids, at least three, by least
squares, since two or three grids alone make noise look like an order (Eca and Hoekstra 2014).

The rule for trust: an order is *credible* when the fitted one and every local one lie within 0.5 of the order
that theory expects; the second half is the check that the grids are in the asymptotic range. A credible order
earns the safety factor 1.25, any other series 3 (Roache 1994).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar

Array = NDArray[np.float64]

CREDIBLE_WITHIN = 0.5
TRUSTED_FACTOR, CAUTIOUS_FACTOR = 1.25, 3.0
ORDER_RANGE = (0.05, 10.0)  # an unknown limit's order is sought here; outside, no discretisation is meant


@dataclass(frozen=True)
class Order:
    """Fit of ``error = constant * spacing**order``; `local` are the orders of neighbouring grids."""

    order: float
    constant: float
    local: tuple[float, ...]
    scatter: float  # rms of the residuals of log(error)

    def credible(self, expected: float) -> bool:
        """True if the fitted and all local orders lie within 0.5 of the expected one."""
        return all(abs(p - expected) <= CREDIBLE_WITHIN for p in (self.order, *self.local))


@dataclass(frozen=True)
class Extrapolation:
    """Richardson value and grid uncertainty; `value` and `uncertainty` in the unit of the values.

    `uncertainty` belongs to the finest grid's own value `finest`. `order` is None, and `extrapolated` is
    `finest`, where the series is not strictly monotone, because it then has no order.
    """

    finest: float
    extrapolated: float
    uncertainty: float
    order: float | None
    local: tuple[float, ...]
    credible: bool
    safety_factor: float


def fit_order(spacing: Sequence[float], error: Sequence[float]) -> Order:
    """Order of `error` (positive, one per grid) in `spacing`, from coarse to fine.

    Raises ValueError for fewer than three grids, spacings that do not fall, or errors not finite and > 0.

    >>> round(fit_order([0.4, 0.2, 0.1], [16.0, 4.0, 1.0]).order, 12)
    2.0
    """
    h, e = _series(spacing, error)
    if np.any(e <= 0):
        raise ValueError("an error of zero (or less) has no logarithm: this series has no order")
    order, intercept = np.polyfit(np.log(h), np.log(e), 1)
    residual = np.log(e) - (order * np.log(h) + intercept)
    local = np.diff(np.log(e)) / np.diff(np.log(h))
    scatter = float(np.sqrt(np.mean(residual**2)))
    return Order(float(order), float(np.exp(intercept)), tuple(local.tolist()), scatter)


def extrapolate(spacing: Sequence[float], value: Sequence[float], expected_order: float) -> Extrapolation:
    """Limit of `value` for spacing to zero, and the uncertainty of the finest grid's value.

    Credible: least-squares fit of ``limit + C h**p``; the uncertainty at the finest h is ``1.25 |C h**p| +
    |misfit|`` with p no higher than the expected order q. Else: ``3 max(|C h**q|, range of the values)``.
    Raises ValueError as `fit_order` does, and for an expected order that is not positive.

    >>> found = extrapolate([0.4, 0.2, 0.1], [1.16, 1.04, 1.01], expected_order=2.0)
    >>> round(found.extrapolated, 9), round(found.uncertainty, 9), found.safety_factor
    (1.0, 0.0125, 1.25)
    """
    h, v = _series(spacing, value)
    if not expected_order > 0:
        raise ValueError(f"expected_order {expected_order!r} is not positive")
    local = _local_orders(h, v)
    if local is None:
        return _cautious(h, v, expected_order, None, ())
    order = _best_order(h, v)
    if any(abs(p - expected_order) > CREDIBLE_WITHIN for p in (order, *local)):
        return _cautious(h, v, expected_order, order, local)
    limit, _ = _fit_limit(h, v, order)
    # An observed order above the expected one is mostly the coarse grids' higher terms, and flatters.
    bounded = min(order, expected_order)
    bounded_limit, bounded_factor = _fit_limit(h, v, bounded)
    correction = bounded_factor * h[-1] ** bounded
    misfit = abs(v[-1] - bounded_limit - correction)
    return Extrapolation(
        finest=float(v[-1]),
        extrapolated=limit,
        uncertainty=float(TRUSTED_FACTOR * abs(correction) + misfit),
        order=order,
        local=local,
        credible=True,
        safety_factor=TRUSTED_FACTOR,
    )


def _cautious(
    h: Array, v: Array, expected: float, order: float | None, local: tuple[float, ...]
) -> Extrapolation:
    """Where the order cannot be trusted: the larger of the expected order's correction and the range."""
    limit, factor = _fit_limit(h, v, expected)
    doubt = max(abs(factor) * h[-1] ** expected, float(np.ptp(v)))
    return Extrapolation(
        finest=float(v[-1]),
        extrapolated=float(v[-1]) if order is None else limit,
        uncertainty=float(CAUTIOUS_FACTOR * doubt),
        order=order,
        local=local,
        credible=False,
        safety_factor=CAUTIOUS_FACTOR,
    )


def _local_orders(h: Array, v: Array) -> tuple[float, ...] | None:
    """Orders of neighbouring triplets; None for a series that is not strictly monotone.

    A difference over ``[h2, h1]`` belongs to the geometric mean of its spacings and goes as the slope
    ``h**(p - 1)`` times the interval; exact for a constant refinement ratio.
    """
    difference = np.diff(v)
    if np.any(difference == 0) or np.any(difference[1:] * difference[:-1] < 0):
        return None
    slope, middle = np.log(np.abs(difference / np.diff(h))), np.log(h[1:] * h[:-1]) / 2
    return tuple((1 + np.diff(slope) / np.diff(middle)).tolist())


def _fit_limit(h: Array, v: Array, order: float) -> tuple[float, float]:
    """Least-squares ``limit`` and ``C`` of ``v = limit + C h**order``."""
    powers = (h / h[-1]) ** order
    (limit, factor), *_ = np.linalg.lstsq(np.column_stack([np.ones_like(h), powers]), v, rcond=None)
    return float(limit), float(factor / h[-1] ** order)


def _best_order(h: Array, v: Array) -> float:
    """The order whose fit leaves the smallest squares; limit and C are eliminated (variable projection)."""

    def misfit(order: float) -> float:
        limit, factor = _fit_limit(h, v, order)
        return float(np.sum((v - limit - factor * h**order) ** 2) / np.ptp(v) ** 2)

    coarse = min(np.linspace(*ORDER_RANGE, 200), key=misfit)
    step = (ORDER_RANGE[1] - ORDER_RANGE[0]) / 199
    near = (max(coarse - step, ORDER_RANGE[0]), min(coarse + step, ORDER_RANGE[1]))
    return float(minimize_scalar(misfit, bounds=near, method="bounded", options={"xatol": 1e-12}).x)


def _series(spacing: Sequence[float], value: Sequence[float]) -> tuple[Array, Array]:
    h, v = np.asarray(spacing, dtype=float), np.asarray(value, dtype=float)
    if h.ndim != 1 or h.shape != v.shape or len(h) < 3:
        raise ValueError("an order needs at least three grids, and one number for each")
    if not (np.all(np.isfinite(h)) and np.all(np.isfinite(v))):
        raise ValueError("a spacing or a value is not finite")
    if np.any(h <= 0) or np.any(np.diff(h) >= 0):
        raise ValueError("spacings must be positive and fall from grid to grid")
    return h, v
