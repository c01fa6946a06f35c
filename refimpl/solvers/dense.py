"""The plain reference: dense matrices, principal pivoting, Newton on the approach, Picard on the slopes.

Every step is a textbook statement about the matrices of Eq. (7); nothing is approximated except by
rounding. Shared with the production solver are the kernels, the force sums and the rule for tau's active
set, each verified on its own.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from refimpl.grid import Array, Mask
from refimpl.model.certificate import State, approach_from, certify
from refimpl.model.problem import Problem, no_elements
from refimpl.model.slopes import Slopes
from refimpl.model.state import CycleState, SolverResult, Status, cycle_state
from refimpl.operators.dense import DenseInfluence
from refimpl.solvers.pivoting import complementarity, restricted_solve
from refimpl.solvers.tau_active_set import iterate

_SLOPE_TOLERANCE = 1e-13  # share of the peak pressure: 450 eps; or until slope changes no longer shrink
_ROUNDING_FLOOR = 1e-11  # a smaller change that no longer shrinks is rounding of the linear solves
_SLOPE_ITERATIONS = 200
_APPROACH_ITERATIONS = 200
_SOLVES = 2000  # linear ones in all (shipped scenes: 44 at most, 32 x 32), since limits of loops multiply


@dataclass
class _Frozen:
    """The problem with slopes and held traction fixed: ``u = G f + g``, ``u >= K (approach - h)``."""

    G: Array
    g: Array
    K: Array
    weights: Array
    offset: float


def solve_dense(problem: Problem) -> tuple[SolverResult, State]:
    """Return the result and its certified state; statuses `CONVERGED`, `CYCLED`, `ITERATION_LIMIT`.

    The result's status concerns the loops only. Raises `ArithmeticError` when the frozen problem has no
    solution: no approach balances the load, or the matrix is no P-matrix.
    """
    operator = DenseInfluence(problem.grid, problem.direction)
    solver = _DenseSolver(problem, operator)
    ended = iterate(solver, problem.friction, _SLOPE_TOLERANCE)
    result = SolverResult(
        pressure=solver.pressure,
        traction=solver.traction,
        slopes=solver.slopes,
        indentation=solver.indentation,
        status=ended.status(solver.contact) if solver.converged else Status.ITERATION_LIMIT,
        excluded=ended.excluded,
        cycle_states=ended.cycle_states,
        iterations={"linear solves": solver.solves, "slopes": solver.picard, "active sets": ended.solves},
    )
    found = result.pressure, result.traction, result.slopes, result.indentation
    return result, certify(problem, operator, *found)


class _DenseSolver:
    """State of the reference solution: pressure, slopes, contact set; a `TauSolver`."""

    stagnated = window_too_small = False  # it has no window, and its budget alone ends it early
    residual = 0.0  # a state is solved to rounding, or the budget is spent

    def __init__(self, problem: Problem, operator: DenseInfluence) -> None:
        self.problem = problem
        self.pressure = np.zeros(problem.gap.shape)
        self.traction = np.zeros(problem.gap.shape)
        self.slopes = Slopes.flat(problem.gap.shape)
        self.indentation: Array | None = None
        self.converged = False
        self.solves = self.picard = 0
        self._operator = operator
        self._free: Mask = problem.gap.ravel() <= np.quantile(problem.gap, 0.05)
        self._capped: Mask = np.zeros_like(self._free)
        self._a = problem.elasticity.normal_matrix(operator)

    @property
    def exhausted(self) -> bool:
        """True if the solver has taken more linear solves than states that converge do."""
        return self.solves >= _SOLVES

    @property
    def contact(self) -> Mask:
        """Elements with positive pressure."""
        return self.pressure > 0

    def cycle_state(self) -> CycleState:
        """Return the numbers of the present state."""
        return cycle_state(self.problem, self.pressure, self.traction, self.slopes)

    def solve(self, tolerance: float, active: Mask, excluded: Mask | None = None) -> bool:
        """Picard iteration on slopes and held traction, with tau on ``active``, to the rounding floor."""
        problem, law = self.problem, self.problem.friction
        self.converged, last = False, np.inf
        for _ in range(_SLOPE_ITERATIONS):
            before, slopes_before = self.pressure, self.slopes
            self._solve_frozen(law.held_traction(self.pressure, active))
            self.picard += 1
            self.traction = law.traction(self.pressure, active)
            lower, upper = problem.displacements(self._operator, self.pressure, self.traction, self.slopes)
            K = self.slopes.obliqueness
            approach = approach_from(self.pressure, (lower + upper) / K + problem.gap, problem.cap)
            approach = approach if problem.approach is None else problem.approach
            self.indentation = problem.indentation(self.pressure, lower + upper, K, approach)
            self.slopes = problem.slopes(lower, upper, self.indentation)
            change = float(np.abs(self.pressure - before).max() / self.pressure.max(initial=1e-300))
            change = max(change, self.slopes.distance(slopes_before, ~no_elements(problem)))
            at_floor = change <= _ROUNDING_FLOOR and change >= last
            lags = problem.terms.oblique or not law.is_linear
            if change <= tolerance or at_floor or not lags:
                self.converged = True
                break
            if self.exhausted:
                break
            last = change
        return self.converged

    def _solve_frozen(self, held_traction: Array) -> None:
        """Solve with slopes and held traction fixed."""
        frozen = self._freeze(held_traction)
        h = self.problem.gap.ravel()
        if self.problem.approach is None:
            self._solve_load(frozen, h)
        else:
            self.pressure = self._contact(frozen, h, self.problem.approach).reshape(self.pressure.shape)

    def _contact(self, frozen: _Frozen, h: Array, approach: float) -> Array:
        """The pressure at an approach (Pa); the sets of free and capped elements are kept for the next
        one."""
        q = frozen.g - frozen.K * (approach - h)
        found = complementarity(frozen.G, q, self._free, self.problem.cap, self._capped)
        self.solves += found.solves
        self._free, self._capped = found.free, found.capped
        return found.pressure

    def _solve_load(self, frozen: _Frozen, h: Array) -> None:
        """Newton on the piecewise linear ``N(approach)``, kept within a bracket, until the sets stay."""
        assert self.problem.load is not None
        target = (self.problem.load + frozen.offset) / self.problem.grid.element_area
        low, high = -np.inf, np.inf
        for _ in range(_APPROACH_ITERATIONS):
            if self.exhausted:
                return
            at_cap = np.where(self._capped, self.problem.cap, 0.0) if self._capped.any() else np.zeros(len(h))
            at_zero = frozen.K * h + frozen.g + frozen.G @ at_cap
            per_approach, less = restricted_solve(
                frozen.G, np.stack([frozen.K, at_zero], axis=1), self._free
            ).T
            stiffness = float(frozen.weights @ per_approach)
            if stiffness == 0:  # nothing presses: shear on slopes alone bears the load, or more than that
                break
            approach = (target + frozen.weights @ (less - at_cap)) / stiffness
            if not low < approach < high:
                approach = 0.5 * (low + high)
            before = self._free, self._capped
            pressure = self._contact(frozen, h, approach)
            self.solves += 1
            same = all(np.array_equal(a, b) for a, b in zip(before, (self._free, self._capped), strict=True))
            total = float(frozen.weights @ pressure)
            if same and abs(total - target) <= 1e-12 * abs(target):
                self.pressure = pressure.reshape(self.pressure.shape)
                return
            low, high = (approach, high) if total < target else (low, approach)
            if not self._free.any():
                self._release(frozen, h, pressure, more=total < target)
        raise ArithmeticError("no approach balances the load")

    def _release(self, frozen: _Frozen, h: Array, pressure: Array, *, more: bool) -> None:
        """Free the element that is the next to change as the approach grows (``more``) or falls, if any."""
        candidates = ~self._capped if more else self._capped
        if not candidates.any():
            return
        v = (frozen.G @ pressure + frozen.g) / frozen.K + h
        next_one = int(np.argmin(np.where(candidates, v if more else -v, np.inf)))
        self._free[next_one], self._capped[next_one] = True, False

    def _freeze(self, held_traction: Array) -> _Frozen:
        """Eq. (7) for ``f`` alone, after ``r = held + beta f`` and, on request, facet tractions."""
        problem, beta = self.problem, self.problem.friction.slope
        K = self.slopes.obliqueness.ravel()
        weights, offset = problem.load_weights(self.slopes, held_traction)
        held = held_traction.ravel()
        G, g = self._a, np.zeros(len(K))
        if problem.terms.slope_correction:
            tan_x, tan_y = self.slopes.tan_x.ravel(), self.slopes.tan_y.ravel()
            c = problem.elasticity.shear_matrix(self._operator)
            c_across = problem.elasticity.shear_across_matrix(self._operator)
            G = self._a * (1 - beta * tan_x) + c * (beta + tan_x) + c_across * tan_y
            g = c @ held - self._a @ (held * tan_x)
        elif problem.terms.coupled:
            c = problem.elasticity.shear_matrix(self._operator)
            G, g = self._a + beta * c, c @ held
        if problem.load is not None and not self._operator.displaces_mean:
            # A mean pressure displaces nothing, so near full contact G is singular. Under a load any
            # compliance of the mean will do: it moves the approach by itself, and the pressure not at all.
            mean_compliance = problem.elasticity.mean_compliance(problem.grid) / K.size
            G = G + mean_compliance * np.outer(K, K)
        return _Frozen(G, g, K, weights.ravel(), offset)
