"""What CG holds while it works: shear that it has not taken in, slopes, the load's weights, tau's support."""

from __future__ import annotations

import math

import numpy as np

from refimpl.grid import Array, inner
from refimpl.model.friction import Mask, local_friction
from refimpl.model.problem import Problem
from refimpl.model.slopes import Slopes
from refimpl.solvers.production.anderson import Mixing
from refimpl.solvers.production.flexibility import Flexibility
from refimpl.solvers.production.projected_cg import ProjectedCG

_STEEPEST = 1e-6  # cosine of slopes that have run off, under pressures far beyond the moduli
_FARTHEST = 1e30  # sides; shear displacements beyond have run off, while their squares still fit a double


class Held:
    """The rest of a window's problem, brought up to date with the pressure of ``cg`` and held from then on.

    ``support`` is where tau is; ``slopes`` are those that the last update left, and ``entered`` those that
    the displacements of the present state came from. ``ran_off`` says that slopes or shear did.
    """

    def __init__(self, problem: Problem, flexibility: Flexibility, cg: ProjectedCG) -> None:
        self._problem, self._flexibility, self._cg = problem, flexibility, cg
        self.slopes = self.entered = Slopes.flat(problem.gap.shape)
        self.support: Mask = np.zeros(problem.gap.shape, dtype=bool)
        self.ran_off = False
        self._led: tuple[Array, Array] | None = None  # shear and weights that the present state came from

    @property
    def lags(self) -> bool:
        """Whether anything that is held depends on the pressure."""
        return self._problem.terms.oblique or self._shear_lags

    @property
    def _shear_lags(self) -> bool:
        """Whether shear does, beyond what CG has taken in and tau, which stays on its support."""
        terms, beta = self._problem.terms, self._problem.friction.beta
        return terms.slope_correction or (terms.coupled and beta > 0 and not self._flexibility.coupled)

    @property
    def traction(self) -> Array:
        """That of the present pressure, with tau on its support (Pa)."""
        return local_friction(self._problem.friction, self._cg.pressure, self.support)

    def update(self, step: int) -> float:
        """Bring all up to date with the pressure of CG's ``step``; the residual of the whole problem."""
        problem, pressure = self._problem, self._cg.pressure
        shear, slopes = self._flexibility.displaced(
            pressure, step, self.support, self.slopes, self._cg.normal_displacement
        )
        self.entered, change = slopes, 0.0
        if problem.terms.slope_correction:  # the displacements are those of facets at the last slopes
            self.entered, change = self.slopes, slopes.distance(self.slopes, pressure > 0)
        within = max(shear.max(), -shear.min()) < _FARTHEST * problem.grid.side
        self.ran_off = not (slopes.obliqueness.min() > _STEEPEST and within)
        if not self.ran_off:
            self.slopes = slopes
        K = self.slopes.obliqueness
        target, balance = self._target(K)
        self._asked = shear, K
        self._hold(shear, K, target)
        return math.inf if self.ran_off else max(*self._cg.residuals(), balance, change)

    def mix(self, mixing: Mixing | None) -> None:
        """Go on from a mixture in place of what the present state asks for, if updates are mixed."""
        if mixing is None or self._led is None:
            self._led = self._asked
            return
        oblique, sheared = self._problem.terms.oblique, self._shear_lags
        scale = float(np.abs(self._cg.normal_displacement).max()) or 1.0

        def stacked(shear: Array, K: Array) -> Array:
            return np.vstack([shear / scale] * sheared + [K] * oblique)

        (shear, K), n = self._asked, self._problem.gap.shape[0]
        mixed = mixing.mixed(stacked(*self._led), stacked(shear, K))
        if sheared:
            shear = scale * mixed[:n]
        if oblique:
            K = np.clip(mixed[-n:], _STEEPEST, 1.0)
        self._led = shear, K
        self._hold(shear, K, self._target(K)[0])

    def _hold(self, shear: Array, K: Array, target: float | None) -> None:
        problem = self._problem
        self._cg.freeze(K * problem.gap + shear, K, target=target, approach=problem.approach)

    def _target(self, K: Array) -> tuple[float | None, float]:
        """What ``sum K f`` must be for N = P, with the rest of Eq. (2) as it is now; and |N - P| / P."""
        problem, pressure = self._problem, self._cg.pressure
        if problem.load is None:
            return None, 0.0
        weights, offset = problem.load_weights(self.slopes, self.support)
        dA = problem.grid.element_area
        found = inner(weights, pressure)
        target = (problem.load + offset) / dA + inner(K, pressure) - found
        balance = abs(found * dA - offset - problem.load) / problem.load
        # shear on slopes that alone exceeds the load leaves no balance: keep some contact and fail by it
        return max(target, 1e-3 * problem.load / dA), balance
