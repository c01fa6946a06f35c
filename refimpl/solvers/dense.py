"""The plain reference: dense matrices, principal pivoting, Newton on the approach, Picard on the slopes.

Every step is a textbook statement about the matrices of Eq. (7); nothing is approximated but by
rounding. Shared with the production solver are the kernels, the force sums and the rule for tau's
support, each verified on its own.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from refimpl.grid import Array
from refimpl.model.certificate import State, certify
from refimpl.model.friction import Mask, TauSupport, local_friction
from refimpl.model.problem import Problem, visit
from refimpl.model.slopes import Slopes
from refimpl.model.state import Outcome, Status, Visited
from refimpl.operators.dense import DenseInfluence
from refimpl.solvers.pivoting import complementarity, restricted_solve

_SLOPE_TOLERANCE = 1e-13  # of the peak pressure: 450 eps, or where changes of slopes stop shrinking before
_ROUNDING_FLOOR = 1e-11  # a change below this that no longer shrinks is rounding of the linear solves
_SLOPE_ITERATIONS = 200
_SUPPORT_ITERATIONS = 200
_APPROACH_ITERATIONS = 200
_SOLVES = 2000  # linear ones in all (shipped scenes: 44 at most, 32 x 32), since limits of loops multiply


@dataclass
class _Frozen:
    """The problem with slopes and tau's support held: ``u = G f + g``, ``u >= K (approach - h)``."""

    G: Array
    g: Array
    K: Array
    weights: Array
    offset: float


def solve_dense(problem: Problem, operator: DenseInfluence) -> tuple[Outcome, State]:
    """Outcome and certified state; statuses `CONVERGED`, `CYCLED`, `ITERATION_LIMIT`.

    The outcome's status speaks of the loops only. Raises `ArithmeticError` when the frozen problem
    has no solution: no approach balances the load, or the matrix is no P-matrix.
    """
    solver = _DenseSolver(problem, operator)
    rule = TauSupport(problem.gap.shape)
    states: list[Visited] = []
    in_cycles: list[Visited] = []
    for _ in range(_SUPPORT_ITERATIONS):
        traction = solver.settle_slopes(rule.current)
        states.append(visit(problem, solver.pressure, traction, solver.slopes))
        if problem.friction.tau > 0:
            rule.next(solver.pressure > 0)
            in_cycles += states[len(states) - len(rule.cycle) :]
        if rule.settled or rule.given_up or problem.friction.tau == 0 or solver.spent:
            break
    lawful = not np.any(rule.withheld & (solver.pressure > 0))
    ended = solver.slopes_settled and (rule.settled or problem.friction.tau == 0)
    outcome = Outcome(
        pressure=solver.pressure,
        traction=traction,
        slopes=solver.slopes,
        status=Status.ITERATION_LIMIT if not ended else Status.CONVERGED if lawful else Status.CYCLED,
        withheld=rule.withheld,
        visited=tuple(in_cycles),
        iterations={"linear solves": solver.solves, "slopes": solver.picard, "tau supports": len(states)},
    )
    return outcome, certify(problem, operator, solver.pressure, traction, solver.slopes)


class _DenseSolver:
    """State of the reference solution: pressure, slopes, active set."""

    def __init__(self, problem: Problem, operator: DenseInfluence) -> None:
        self.problem = problem
        self.operator = operator
        self.pressure = np.zeros(problem.gap.shape)
        self.slopes = Slopes.flat(problem.gap.shape)
        self.slopes_settled = False
        self.active: Mask = problem.gap.ravel() <= np.quantile(problem.gap, 0.05)
        self.solves = 0
        self.picard = 0
        self._symmetric = problem.pair.normal_compliance * operator.normal_matrix

    @property
    def spent(self) -> bool:
        """Whether it has taken more linear solves than states that settle do."""
        return self.solves >= _SOLVES

    def settle_slopes(self, support: Mask) -> Array:
        """Picard iteration on the slopes at a fixed support of tau, to the rounding floor; the traction."""
        self.slopes_settled = False
        last = np.inf
        for _ in range(_SLOPE_ITERATIONS):
            before, slopes_before = self.pressure, self.slopes
            self._solve_frozen(support)
            self.picard += 1
            traction = local_friction(self.problem.friction, self.pressure, support)
            self.slopes = self.problem.slopes(
                *self.problem.displacements(self.operator, self.pressure, traction, self.slopes)
            )
            change = float(np.abs(self.pressure - before).max() / self.pressure.max(initial=1e-300))
            change = max(change, self.slopes.distance(slopes_before, np.ones_like(support)))
            at_floor = change <= _ROUNDING_FLOOR and change >= last
            if change <= _SLOPE_TOLERANCE or at_floor or not self.problem.terms.oblique:
                self.slopes_settled = True
                break
            if self.spent:
                break
            last = change
        return traction

    def _solve_frozen(self, support: Mask) -> None:
        frozen = self._freeze(support)
        h = self.problem.gap.ravel()
        if self.problem.approach is not None:
            q = frozen.g - frozen.K * (self.problem.approach - h)
            found = complementarity(frozen.G, q, self.active)
            self.solves += found.solves
            self.active = found.active
            self.pressure = found.pressure.reshape(self.pressure.shape)
            return
        self._solve_load(frozen, h)

    def _solve_load(self, frozen: _Frozen, h: Array) -> None:
        """Newton on the piecewise linear ``N(approach)``, kept within a bracket, until the set stays."""
        assert self.problem.load is not None
        target = (self.problem.load + frozen.offset) / self.problem.grid.element_area
        low, high = -np.inf, np.inf
        for _ in range(_APPROACH_ITERATIONS):
            if self.spent:
                return
            right = np.stack([frozen.K, frozen.K * h + frozen.g], axis=1)
            per_approach, at_zero = restricted_solve(frozen.G, right, self.active).T
            stiffness = float(frozen.weights @ per_approach)
            if stiffness == 0:  # nothing presses: shear on slopes alone bears the load, or more than that
                break
            approach = (target + frozen.weights @ at_zero) / stiffness
            if not low < approach < high:
                approach = 0.5 * (low + high)
            found = complementarity(frozen.G, frozen.g - frozen.K * (approach - h), self.active)
            self.solves += found.solves + 1
            same = np.array_equal(found.active, self.active)
            self.active = found.active
            total = float(frozen.weights @ found.pressure)
            if same and abs(total - target) <= 1e-12 * abs(target):
                self.pressure = found.pressure.reshape(self.pressure.shape)
                return
            if total < target:
                low = approach
                if not found.active.any():
                    self.active[np.argmin(h + frozen.g / frozen.K)] = True
            else:
                high = approach
        raise ArithmeticError("no approach balances the load")

    def _freeze(self, support: Mask) -> _Frozen:
        """Eq. (7) for ``f`` alone, after ``r = tau chi + beta f`` and, on request, facet tractions."""
        problem, operator = self.problem, self.operator
        tau, beta = problem.friction.tau, problem.friction.beta
        K = self.slopes.obliqueness.ravel()
        weights, offset = problem.load_weights(self.slopes, support)
        chi = tau * support.ravel()
        C = problem.pair.shear_compliance
        G, g = self._symmetric, np.zeros(len(K))
        if problem.terms.slope_correction:
            tan_x, tan_y = self.slopes.tan_x.ravel(), self.slopes.tan_y.ravel()
            G = (
                self._symmetric * (1 - beta * tan_x)
                + C * operator.shear_matrix * (beta + tan_x)
                + C * operator.shear_across_matrix * tan_y
            )
            g = C * (operator.shear_matrix @ chi) - self._symmetric @ (chi * tan_x)
        elif problem.terms.coupled:
            G = self._symmetric + beta * C * operator.shear_matrix
            g = C * (operator.shear_matrix @ chi)
        if problem.periodic and problem.load is not None:
            # A mean pressure displaces nothing, so near full contact G is singular. Under a load any
            # compliance of the mean will do: it moves the approach by itself, and the pressure not at all.
            mean_compliance = problem.pair.normal_compliance * problem.grid.side / K.size
            G = G + mean_compliance * np.outer(K, K)
        return _Frozen(G, g, K, weights.ravel(), offset)
