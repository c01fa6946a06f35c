"""Observed orders of convergence from errors against a known value, fitted over three grids at least.

Two or three grids alone make noise look like an order (Eca and Hoekstra 2014).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Order:
    """Fit of ``error = constant * spacing**order``; `local` are the orders of neighbouring grids."""

    order: float
    constant: float
    local: tuple[float, ...]


def fit_order(spacing: Sequence[float], error: Sequence[float]) -> Order:
    """Order of `error` in `spacing`, coarse to fine; ValueError below 3 grids, or if not falling and > 0."""
    h, e = np.asarray(spacing, dtype=float), np.asarray(error, dtype=float)
    if h.ndim != 1 or h.shape != e.shape or len(h) < 3:
        raise ValueError("an order needs at least three grids, and one number for each")
    if not (np.all(np.isfinite(h)) and np.all(np.isfinite(e))):
        raise ValueError("a spacing or an error is not finite")
    if np.any(h <= 0) or np.any(np.diff(h) >= 0):
        raise ValueError("spacings must be positive and fall from grid to grid")
    if np.any(e <= 0):
        raise ValueError("an error of zero (or less) has no logarithm: this series has no order")
    order, intercept = np.polyfit(np.log(h), np.log(e), 1)
    local = np.diff(np.log(e)) / np.diff(np.log(h))
    return Order(float(order), float(np.exp(intercept)), tuple(local.tolist()))
