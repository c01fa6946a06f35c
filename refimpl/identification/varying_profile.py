"""Profile likelihood where a part of the covariance changes with the parameters.

Realisations scatter in proportion to ``tau``, which multiplies their areas. The scatter at the fit belongs to
the fitted tau. Where tau is too low by chance, so is the scatter, and the interval ends below the truth. So
each value is judged by its own scatter: ``theta`` is inside the 95 % interval where
``Q = (theta - c)^T C(theta)^-1 (theta - c)`` exceeds the least by at most the squared quantile of Student's
t. A value whose scatter grows as fast as its distance from the fit is never outside: that end is infinite.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from refimpl.grid import Array
from refimpl.identification.profile import BOUNDED, Profile, floor, interval_ends


class VaryingProfile:
    """Likelihood of parameters about ``centre`` with the covariance ``fixed + estimated(theta)``.

    ``estimated`` has ``degrees`` degrees of freedom; ``theta`` is the fit, within the bounds.
    """

    def __init__(
        self,
        centre: Array,
        fixed: Array,
        estimated: Callable[[Array], Array],
        degrees: float,
        theta: Array,
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
