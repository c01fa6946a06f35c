"""Profile likelihood of a linear combination of parameters that may not be negative.

With ``Q = (theta - c)^T C^-1 (theta - c)``, the combination ``g theta = m`` is inside the 95 % interval where
``min Q`` over ``theta >= 0`` on that line exceeds the least of all by at most 3.84 (Wilks 1938). Where no
bound is active the interval is that of the ellipse, ``g c +- 1.96 sqrt(g C g)``.
"""

from __future__ import annotations

import math

import numpy as np
from scipy.optimize import brentq

from refimpl.grid import Array

LEVEL = 3.841458820694124  # 95 % quantile of chi-square, one degree of freedom


class Profile:
    """Likelihood of two parameters about ``centre`` (the optimum without bounds), covariance (2, 2)."""

    def __init__(self, centre: Array, covariance: Array) -> None:
        self.scale = np.sqrt(np.diag(covariance))
        self.centre = centre / self.scale
        self.precision = np.linalg.inv(covariance / np.outer(self.scale, self.scale))
        self.optimum = self._optimum()
        self.least = self._misfit(self.optimum / self.scale)

    def _misfit(self, theta: Array) -> float:
        away = theta - self.centre
        return float(away @ self.precision @ away)

    def _optimum(self) -> Array:
        """The optimum within the bounds: inside, on one of both axes, or the origin."""
        if np.all(self.centre >= 0):
            return np.asarray(self.centre * self.scale)
        axes = []
        for k in (0, 1):
            other = 1 - k
            moved = self.centre[k] + self.precision[k, other] / self.precision[k, k] * self.centre[other]
            axes.append(np.eye(2)[k] * max(float(moved), 0.0))
        return np.asarray(min(axes, key=self._misfit) * self.scale)

    def on_line(self, gradient: Array, value: float) -> float:
        """Return the least misfit on ``gradient theta = value`` within the bounds; gradient >= 0."""
        g = gradient * self.scale
        direction = np.array([-g[1], g[0]])
        direction = direction / np.linalg.norm(direction)
        start = g * value / float(g @ g)
        slope = float(direction @ self.precision @ direction)
        best = -float(direction @ self.precision @ (start - self.centre)) / slope
        low, high = -math.inf, math.inf
        for at, along in zip(start, direction, strict=True):
            if along > 0:
                low = max(low, -at / along)
            elif along < 0:
                high = min(high, -at / along)
        return self._misfit(start + min(max(best, low), high) * direction)

    def interval(self, gradient: Array) -> tuple[float, float]:
        """Return the 95 % interval of ``gradient theta``; its low end is 0 where the bound is inside."""
        middle = float(gradient @ self.optimum)
        spread = math.sqrt(
            float((gradient * self.scale) @ np.linalg.inv(self.precision) @ (gradient * self.scale))
        )

        def excess(value: float) -> float:
            return self.on_line(gradient, value) - self.least - LEVEL

        high = middle + spread
        while excess(high) < 0:
            high += spread
        upper = float(brentq(excess, middle, high, xtol=1e-9 * spread))
        low = 0.0 if excess(0.0) <= 0 else float(brentq(excess, 0.0, middle, xtol=1e-9 * spread))
        return low, upper

    @property
    def is_bounded(self) -> bool:
        """True where the bounds cut the 95 % intervals of the ellipse."""
        return bool(np.any(self.centre < math.sqrt(LEVEL)))
