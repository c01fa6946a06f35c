"""Equilibrium and compatibility of the wedge stresses, from stress values alone.

In (l, theta), l = log r, equilibrium reads ``d sigma_r/dl + d tau/dtheta + sigma_r - sigma_theta = 0`` and
``d tau/dl + d sigma_theta/dtheta + 2 tau = 0`` (both are r div sigma), and compatibility says that
``sigma_r + sigma_theta`` is harmonic: its mean over any circle in this plane is its value at the centre.
"""

from __future__ import annotations

from math import factorial

import numpy as np
from numpy.typing import NDArray

from appendix_a.wedge import stresses

Real = NDArray[np.float64]

HALF_WIDTH = 8
"""Points on either side of the difference stencils (order 16)."""
STEP = 1 / 25
"""Step over the distance to the load's end: truncation (8!)^2 (1/25)^16 = 7e-14 of the stress there."""
CIRCLE = 64


def derivative_weights(n: int) -> Real:
    """Return w_1..w_n of the difference ``sum w_k (f(k s) - f(-k s)) / s`` of order 2n."""
    ratios = [factorial(n) ** 2 / (k * factorial(n - k) * factorial(n + k)) for k in range(1, n + 1)]
    return np.array([(-1) ** k * ratio for k, ratio in enumerate(ratios)])


def residuals(r: float, theta: float, gamma: float) -> tuple[float, float]:
    """Return (r |div sigma|, |mean - centre| of sigma_r + sigma_theta) over the largest, inside the wedge."""
    alpha, log_r = np.pi / 2 - gamma, np.log(r)
    to_face = alpha - abs(theta)
    to_end = np.hypot(log_r, to_face)
    step = min(STEP * to_end, 0.99 * to_face / HALF_WIDTH)
    offsets = step * np.arange(1, HALF_WIDTH + 1)
    turn = 2 * np.pi * np.arange(CIRCLE) / CIRCLE
    radius = min(0.5 * to_end, 0.99 * to_face)
    zero = np.zeros(HALF_WIDTH)
    along = np.concatenate([[0.0], offsets, -offsets, zero, zero, radius * np.cos(turn)])
    across = np.concatenate([[0.0], zero, zero, offsets, -offsets, radius * np.sin(turn)])
    values = np.array(stresses(np.exp(log_r + along), theta + across, gamma))
    centre = values[:, 0]
    forward, back, left, right = np.split(values[:, 1 : 1 + 4 * HALF_WIDTH], 4, axis=1)
    weights = derivative_weights(HALF_WIDTH) / step
    by_log, by_theta = (forward - back) @ weights, (left - right) @ weights
    radial = by_log[0] + by_theta[2] + centre[0] - centre[1]
    hoop = by_log[2] + by_theta[1] + 2 * centre[2]
    mean = (values[0] + values[1])[-CIRCLE:].mean() - centre[0] - centre[1]
    largest = np.max(np.abs(centre))
    return float(np.hypot(radial, hoop) / largest), float(abs(mean) / largest)
