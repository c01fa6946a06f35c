"""Profile likelihood of a linear combination of parameters, of which the first may not be negative.

With ``Q = (theta - c)^T C^-1 (theta - c)``, the combination ``g theta = m`` is inside the 95 % interval where
``min Q`` over ``theta >= 0`` on that line exceeds the least of all by at most 1.96^2 (Wilks 1938). Where no
bound is active the interval is that of the ellipse, ``g c +- 1.96 sqrt(g C g)``.

A part S of the covariance may be estimated from few draws, with ``nu`` degrees of freedom. Then 1.96 becomes
the quantile of Student's t with the effective ``nu (g C g)^2 / (g S g)^2`` of them (Welch 1947).

The minimum of a convex Q is the minimum on one face of the bounds (some parameters at zero, the rest free),
and there are few faces: each is tried.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq
from scipy.stats import t as student

from refimpl.grid import Array

_PROBABILITY = 0.975  # quantile of two-sided 95 %
BOUNDED = 2  # parameters that may not be negative, the first ones: tau and beta
_FARTHEST = 1e3  # spreads from the optimum to an end that counts as infinite
_ROUNDING = 1e-12  # below zero, in standard deviations, that still counts as zero

Indices = NDArray[np.intp]


def quantile(degrees: float) -> float:
    """Return Student's t of a two-sided 95 % interval, 1.96 for infinite degrees of freedom."""
    return float(student.ppf(_PROBABILITY, degrees))


def floor(gradient: Array) -> float:
    """Return the least value of a combination: 0 where the bounds keep it from less."""
    bounded = np.all(gradient[:BOUNDED] >= 0) and not np.any(gradient[BOUNDED:])
    return 0.0 if bounded else -math.inf


def interval_ends(
    excess: Callable[[float], float], middle: float, spread: float, least: float
) -> tuple[float, float]:
    """Return the ends of an interval, where ``excess`` changes its sign below and above ``middle``.

    The low end is ``least`` if that is inside. An end further than `_FARTHEST` spreads is infinite.
    """
    high, low = middle + spread, max(middle - spread, least)
    while excess(high) < 0:
        high += high - middle
        if high - middle > _FARTHEST * spread:
            high = math.inf
            break
    while low > least and excess(low) < 0:
        low = max(low - (middle - low), least)
        if middle - low > _FARTHEST * spread:
            least = low = -math.inf
    upper = high if math.isinf(high) else float(brentq(excess, middle, high, xtol=1e-9 * spread))
    if low == least and (math.isinf(low) or excess(low) <= 0):
        return low, upper
    return float(brentq(excess, low, middle, xtol=1e-9 * spread)), upper


class Profile:
    """Likelihood of parameters about ``centre`` (the optimum without bounds), covariance (n, n).

    ``estimated`` is the part of the covariance that draws give with ``degrees`` degrees of freedom.
    """

    def __init__(
        self, centre: Array, covariance: Array, estimated: Array | None = None, degrees: float = math.inf
    ) -> None:
        self.covariance, self.degrees = covariance, degrees
        self.estimated = np.zeros_like(covariance) if estimated is None else estimated
        self.scale = np.sqrt(np.diag(covariance))
        self.centre = centre / self.scale
        self.precision = np.linalg.inv(covariance / np.outer(self.scale, self.scale))
        inside = [theta for _, theta, _ in self._faces() if np.all(theta[:BOUNDED] >= 0)]
        self.optimum: Array = min(inside, key=self._misfit) * self.scale  # inside the bounds, or on a face
        self.least = self._misfit(self.optimum / self.scale)

    def _misfit(self, theta: Array) -> float:
        away = theta - self.centre
        return float(away @ self.precision @ away)

    def _faces(self) -> Iterator[tuple[Indices, Array, Array]]:
        """Yield each face: its free parameters, the optimum on it, and the covariance of the free ones."""
        n = len(self.centre)
        for count in range(BOUNDED + 1):
            for chosen in itertools.combinations(range(BOUNDED), count):
                at_zero = np.array(chosen, dtype=np.intp)
                free = np.setdiff1d(np.arange(n), at_zero)
                covariance = np.linalg.inv(self.precision[np.ix_(free, free)])
                theta = np.zeros(n)
                pull = self.precision[np.ix_(free, at_zero)] @ self.centre[at_zero]
                theta[free] = self.centre[free] + covariance @ pull
                yield free, theta, covariance

    def on_line(self, gradient: Array, value: float) -> float:
        """Return the least misfit on ``gradient theta = value`` within the bounds; infinite outside them."""
        g, least = gradient * self.scale, math.inf
        for free, theta, covariance in self._faces():
            along = covariance @ g[free]
            slope = float(g[free] @ along)
            if slope > 0:
                theta[free] += along * (value - float(g @ theta)) / slope
                if np.all(theta[:BOUNDED] >= -_ROUNDING):
                    least = min(least, self._misfit(theta))
        return least

    def quantile(self, gradient: Array) -> float:
        """Return the quantile of Student's t for ``gradient theta``."""
        estimated = float(gradient @ self.estimated @ gradient)
        if estimated <= 0 or math.isinf(self.degrees):
            return quantile(math.inf)
        share = estimated / float(gradient @ self.covariance @ gradient)
        return quantile(self.degrees / share**2)

    def interval(self, gradient: Array) -> tuple[float, float]:
        """Return the 95 % interval of ``gradient theta``.

        Its low end is 0 if the bounds allow no less and 0 is inside.
        """
        middle, g = float(gradient @ self.optimum), gradient * self.scale
        spread = math.sqrt(float(g @ np.linalg.inv(self.precision) @ g))
        return interval_ends(lambda value: self.excess(gradient, value), middle, spread, floor(gradient))

    def excess(self, gradient: Array, value: float) -> float:
        """Return how far ``gradient theta = value`` is outside the 95 % interval; negative inside."""
        return self.on_line(gradient, value) - self.least - self.quantile(gradient) ** 2

    @property
    def is_bounded(self) -> bool:
        """True where the bounds cut the 95 % intervals of the ellipse."""
        return any(
            self.centre[j] < self.quantile(axis) for j, axis in enumerate(np.eye(len(self.centre))[:BOUNDED])
        )


class VaryingProfile:
    """Likelihood of parameters about ``centre`` with the covariance ``fixed + estimated(theta)``.

    ``estimated`` has ``degrees`` degrees of freedom; ``theta`` is the fit, within the bounds. Realisations
    scatter in proportion to ``tau``, which multiplies their areas: where tau is too low by chance, so is the
    scatter at the fit, and its interval ends below the truth. So each value is judged by its own scatter.
    A value whose scatter grows as fast as its distance from the fit is never outside: that end is infinite.
    """

    def __init__(
        self, centre: Array, fixed: Array, estimated: Callable[[Array], Array], degrees: float, theta: Array
    ) -> None:
        self.centre, self.fixed, self.estimated, self.degrees = centre, fixed, estimated, degrees
        self.base = self._at(theta)

    def _at(self, theta: Array) -> Profile:
        estimated = self.estimated(theta)
        return Profile(self.centre, self.fixed + estimated, estimated, self.degrees)

    def interval(self, gradient: Array) -> tuple[float, float]:
        """Return the 95 % interval of ``gradient theta``, as `Profile.interval` does."""
        middle, spread = float(gradient @ self.base.optimum), math.sqrt(self._variance(gradient))
        return interval_ends(lambda value: self.excess(gradient, value), middle, spread, floor(gradient))

    def excess(self, gradient: Array, value: float) -> float:
        """Return how far ``gradient theta = value`` is outside the 95 % interval; negative inside."""
        step = (value - float(gradient @ self.base.optimum)) / self._variance(gradient)
        theta = self.base.optimum + step * (self.base.covariance @ gradient)
        theta[:BOUNDED] = np.maximum(theta[:BOUNDED], 0.0)
        return self._at(theta).excess(gradient, value)

    def _variance(self, gradient: Array) -> float:
        return float(gradient @ self.base.covariance @ gradient)

    @property
    def is_bounded(self) -> bool:
        """True where the bounds cut the 95 % intervals of the ellipse at the fit."""
        return self.base.is_bounded


Likelihood = Profile | VaryingProfile
