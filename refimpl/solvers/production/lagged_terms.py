"""The terms that lag: shear and slopes, held fixed while CG works and updated between its calls.

CG inverts ``a f``, and with it the coupling ``beta c f`` where that is weak. Cerruti's kernel is odd, so
``c`` is skew: it adds nothing to a curvature ``d.(a d)``, and one transform applies both kernels. What is
left of shear is then the shear offset of the friction law, which is constant on a given active set. Where
the coupling is strong, CG's directions lose their conjugacy; then all of shear lags, and its updates are
mixed. So do facet tractions, whose shear is no multiple of the pressure.
"""

from __future__ import annotations

import math
from copy import copy

import numpy as np

from refimpl.grid import Array, inner
from refimpl.model.certificate import load_rounding
from refimpl.model.elasticity import WindowOperator
from refimpl.model.forces import normal_terms
from refimpl.model.problem import Problem
from refimpl.model.slopes import Slopes
from refimpl.operators.preconditioner import Apply
from refimpl.solvers.production.anderson import AndersonMixing
from refimpl.solvers.production.constants import (
    LARGEST_DISPLACEMENT,
    NEGLIGIBLE_COUPLING,
    STEEPEST_COSINE,
    WEAK_COUPLING,
)
from refimpl.solvers.production.plastic import settled_indentation
from refimpl.solvers.production.projected_cg import ProjectedCG
from refimpl.solvers.tau_active_set import ActiveSet, first_set


def coupling_strength(problem: Problem) -> float:
    """Return the spectral radius of ``beta c f`` against ``a f``, at most; 0 where shear closes no gap."""
    return abs(problem.friction.slope * problem.elasticity.coupling_ratio)


def couples_weakly(problem: Problem) -> bool:
    """Return whether CG takes the coupling ``beta c f`` into its product.

    Beside slopes, which lag anyway, the weakest coupling lags as well: one shear product an update fewer.
    """
    if problem.terms.slope_correction:
        return False
    least = NEGLIGIBLE_COUPLING if problem.terms.oblique else 0.0
    return least < coupling_strength(problem) <= WEAK_COUPLING


def pressure_compliance(problem: Problem, operator: WindowOperator) -> Apply:
    """Return what CG inverts (m/Pa): ``f -> a f``, or ``f -> a f + beta c f`` where the coupling is weak."""
    elasticity = problem.elasticity
    if couples_weakly(problem):
        return elasticity.normal_with_shear(operator, problem.friction.slope)
    return lambda pressure: elasticity.normal(operator, pressure)


class LaggedTerms:
    """Shear displacement, slopes and load target of a window's problem, updated from the pressure of ``cg``.

    active : where adhesive shear acts
    slopes : those that the last update found
    slopes_used : those that the displacements of the present state came from
    diverged : slopes or shear displacements ran out of range
    scaling : relative change of the pressure to the load since the terms were computed; inf under a cap
    indentation : plastic indentation that the slopes contain (m), None without a cap
    """

    def __init__(self, problem: Problem, operator: WindowOperator, cg: ProjectedCG) -> None:
        self._problem, self._operator, self._cg = problem, operator, cg
        self.slopes = self.slopes_used = Slopes.flat(problem.gap.shape)
        self.active: ActiveSet = first_set(problem)
        self.diverged = False
        self.scaling = math.inf
        self.indentation: Array | None = None
        self._posed = False
        self._weakly_coupled = couples_weakly(problem)
        self._used: tuple[Array, Array] | None = None  # shear and weights that the present state came from
        self._requested: tuple[Array, Array]
        self._of_held: tuple[ActiveSet, Array] | None = None  # active set, and its traction's shear product
        self._of_pressure: tuple[float, Array] | None = None  # sum of a pressure, and its shear product
        self._set_problem(np.broadcast_to(0.0, problem.gap.shape), self.slopes.cosine_product, None)

    def on(self, cg: ProjectedCG) -> LaggedTerms:
        """Return the same terms for another state of CG; arrays are replaced, never changed."""
        other = copy(self)
        other._cg = cg
        return other

    def iterate(self) -> None:
        """Take one CG step; the shear product of the old pressure is dropped."""
        self._cg.iterate()
        self._of_pressure = None

    @property
    def has_lag(self) -> bool:
        """True if any lagged term depends on the pressure."""
        return self._problem.terms.oblique or self._shear_lags

    @property
    def _shear_lags(self) -> bool:
        """Whether shear displacements depend on the pressure beyond what CG takes in."""
        terms, law = self._problem.terms, self._problem.friction
        by_pressure = law.slope != 0 and not self._weakly_coupled
        return terms.slope_correction or (bool(terms.coupled) and (by_pressure or not self._held_is_constant))

    @property
    def _held_is_constant(self) -> bool:
        return self._problem.friction.is_linear and self.active.is_fixed

    def clearance(self) -> Array:
        """Return ``v - approach`` of the present state (m)."""
        return self._cg.separation - self._cg.approach

    @property
    def traction(self) -> Array:
        """The traction of the present pressure (Pa)."""
        return self.active.traction(self._problem.friction, self._cg.pressure, self.clearance)

    @property
    def _held(self) -> Array:
        return self.active.shear_offset(self._problem.friction, self._cg.pressure, self.clearance)

    def update(self) -> float:
        """Update all lagged terms from the present pressure; return the residual of the whole problem."""
        problem = self._problem
        shear, slopes = self._displacements()
        self.slopes_used, change = slopes, 0.0
        if problem.terms.slope_correction:  # the displacements are those of facets at the last slopes
            self.slopes_used = self.slopes
        if problem.terms.slope_correction or self.indentation is not None:  # no gap shows these changes
            change = slopes.distance(self.slopes, self._cg.pressure > 0)
        within = max(shear.max(), -shear.min()) < LARGEST_DISPLACEMENT * problem.grid.size
        self.diverged = not (slopes.cosine_product.min() > STEEPEST_COSINE and within)
        if not self.diverged:
            self.slopes = slopes
        K = self.slopes.cosine_product
        target, load_error = self._target(K)
        self.scaling = load_error if math.isinf(problem.cap) else math.inf
        self._requested = shear, K
        self._set_problem(shear, K, target)
        return math.inf if self.diverged else max(*self._cg.residuals(), load_error, change)

    def mix(self, mixing: AndersonMixing | None) -> None:
        """Replace the requested terms by a mixture with earlier ones, if updates are mixed."""
        if mixing is None or self._used is None:
            self._used = self._requested
            return
        oblique, sheared = bool(self._problem.terms.oblique), self._shear_lags
        fields = self._cg.normal_displacement, self._requested[0]
        scale = max(float(np.abs(field).max()) for field in fields) or 1.0

        def stacked(shear: Array, K: Array) -> Array:
            return np.vstack([shear / scale] * sheared + [K] * oblique)

        (shear, K), n = self._requested, self._problem.gap.shape[0]
        mixed = mixing.next(stacked(*self._used), stacked(shear, K))
        if sheared:
            shear = scale * mixed[:n]
        if oblique:
            K = np.clip(mixed[-n:], STEEPEST_COSINE, 1.0)
        self._used = shear, K
        self._set_problem(shear, K, self._target(K)[0])

    def _set_problem(self, shear: Array, K: Array, target: float | None) -> None:
        problem = self._problem
        self._cg.set_problem(K * problem.gap + shear, K, target=target, approach=problem.approach)
        self._posed = True

    def _target(self, K: Array) -> tuple[float | None, float]:
        """Return what ``sum K f`` must be for N = P, with Eq. (2) as it is now; and |N - P| / P."""
        problem, pressure = self._problem, self._cg.pressure
        if problem.load is None:
            return None, 0.0
        weights, offset = problem.load_weights(self.slopes, self._held)
        dA = problem.grid.element_area
        found = inner(weights, pressure)
        target = (problem.load + offset) / dA + inner(K, pressure) - found
        load_error = abs(found * dA - offset - problem.load) / problem.load
        if abs(offset) > problem.load:  # a difference of large terms
            terms = normal_terms(pressure, self.traction, self.slopes, dA)
            load_error = 0.0 if load_error <= load_rounding(terms, problem.load) else load_error
        # no balance exists if shear on slopes alone exceeds the load: keep some contact, report the error
        return max(target, 1e-3 * problem.load / dA), load_error

    def _displacements(self) -> tuple[Array, Slopes]:
        """Return what shear adds to CG's displacement (m), and the slopes under all tractions."""
        problem, operator, elasticity = self._problem, self._operator, self._problem.elasticity
        displacement, pressure = self._cg.normal_displacement, self._cg.pressure
        if not problem.terms.oblique:
            return self._gap_by_shear(), self.slopes
        if self._weakly_coupled:
            of_pressure = problem.friction.slope * self._shear_of_pressure()
            normal = displacement - elasticity.gap_by_shear(of_pressure)
            shear = of_pressure + self._shear_of_held()
            lower, upper = elasticity.body_displacements(normal, pressure, shear)
        else:
            lower, upper = problem.displacements(
                operator, pressure, self.traction, self.slopes, normal=displacement
            )
        closed = lower + upper

        def indentation(slopes: Slopes) -> Array | None:
            return problem.indentation(pressure, closed, slopes.cosine_product, self._approach())

        self.indentation, slopes = settled_indentation(problem, lower, upper, indentation, self.slopes)
        return closed - displacement, slopes

    def _approach(self) -> float:
        """Return the present approach; before the first problem is set, that of a contact without shear."""
        return self._cg.approach if self._posed else 0.0

    def _gap_by_shear(self) -> Array:
        """Return what shear that CG has not taken in adds to the closing of the gap (m)."""
        traction = self._held if self._weakly_coupled else self.traction
        if not self._problem.terms.coupled or not np.any(traction):
            return np.broadcast_to(0.0, traction.shape)
        return self._problem.elasticity.gap_by_shear(self._operator.shear(traction))

    def _shear_of_pressure(self) -> Array:
        """Return the pressure's shear product (Pa m); afterwards only its scale changes, but under a cap."""
        pressure = self._cg.pressure
        total = float(pressure.sum())
        scales = math.isinf(self._problem.cap)
        if self._of_pressure is None or not (scales or self._of_pressure[0] == total):
            self._of_pressure = total, self._operator.shear(pressure)
        applied, product = self._of_pressure
        return product if applied in (0.0, total) else (total / applied) * product

    def _shear_of_held(self) -> Array | float:
        """Return the offset's shear product (Pa m), of a linear law once for an active set."""
        law = self._problem.friction
        if law.is_linear and law.jump == 0:
            return 0.0
        if self._of_held is None or self._of_held[0] is not self.active or not self._held_is_constant:
            self._of_held = self.active, self._operator.shear(self._held)
        return self._of_held[1]
