"""One grid of the production solver: projected CG on the contact's window, with lagged terms updated between.

CG inverts ``a f``, and weak coupling with it. The lagged terms (`lagged_terms`) are fixed while CG reduces
the residual as far as their error lets it, and are then updated. Where their feedback is weak few updates are
enough; where it is strong they are mixed (`anderson`).
"""

from __future__ import annotations

import math
from copy import copy
from typing import Any

import numpy as np
from numpy.typing import NDArray

from refimpl.grid import Array, Mask
from refimpl.model.certificate import mean_rounding
from refimpl.model.problem import Problem
from refimpl.model.state import SolverResult, Status
from refimpl.operators.influence import WindowInfluence, whole_grid_influence
from refimpl.operators.preconditioner import Apply
from refimpl.solvers.production import constants
from refimpl.solvers.production.anderson import MixingControl
from refimpl.solvers.production.capped_cg import CappedCG
from refimpl.solvers.production.coarse_grids import InitialGuess
from refimpl.solvers.production.lagged_terms import LaggedTerms, pressure_compliance
from refimpl.solvers.production.projected_cg import ProjectedCG
from refimpl.solvers.tau_active_set import ActiveSet, ContactTest, FixedSet, iterate


def projected_cg(
    problem: Problem, operator: WindowInfluence, precondition: Apply, pressure: Array
) -> ProjectedCG:
    """Return CG for a window's problem, with a second bound where pressures are capped."""
    compliance, rounding = pressure_compliance(problem, operator), mean_rounding(problem, operator)
    if math.isinf(problem.cap):
        return ProjectedCG(compliance, precondition, pressure, rounding)
    return CappedCG(compliance, precondition, np.minimum(pressure, problem.cap), problem.cap, rounding)


class LevelSolver:
    """One grid level: CG on a window, with slopes, shear and tau's active set updated; a `TauSolver`.

    ``needs_mixing`` says that the lagged terms feed back so strongly that updates are mixed from the first.
    """

    def __init__(
        self,
        problem: Problem,
        operator: WindowInfluence,
        precondition: Apply,
        pressure: Array,
        *,
        needs_mixing: bool = False,
    ) -> None:
        self.whole = problem
        self.counter = operator.counter
        self.cg_iterations = 0
        self.window = operator.source
        self.problem = problem.windowed(self.window)
        self.operator = operator
        self.cg = projected_cg(self.problem, operator, precondition, pressure)
        self.lagged = LaggedTerms(self.problem, operator, self.cg)
        self.stagnated = False
        self.residual = math.inf
        self._enough: ContactTest | None = None
        self._stiffness = 1 / problem.elasticity.element_compliance(problem.grid)
        self._slopes_need_mixing = needs_mixing
        self._control = MixingControl(math.inf, has_lag=True, needs_mixing=needs_mixing)
        self._feedback = constants.REDUCTION

    def initial_guess(self) -> InitialGuess:
        """Return the initial guess for a finer grid."""
        displacement = self.full(self.cg.separation - self.problem.gap)
        if self.window != self.whole.grid.window:
            onto_grid = whole_grid_influence(self.whole.grid, self.whole.direction, self.window, self.counter)
            outside = self.problem.elasticity.normal(onto_grid, self.full(self.cg.pressure))
            outside[self.window.slices] = displacement[self.window.slices]
            displacement = outside
        return InitialGuess(self.full(self.cg.pressure), displacement, self.cg.approach, self.needs_mixing)

    def result(self, tolerance: float) -> SolverResult:
        """Solve under the rule for tau's active set; not final where ``window_too_small``."""
        ended = iterate(self, self.problem, tolerance)
        used = self.lagged.indentation
        status = ended.status(self._status())
        if self._status() is not Status.CONVERGED and not (ended.settled or self.exhausted or self.stagnated):
            status = Status.ITERATION_LIMIT
        return SolverResult(
            pressure=self.full(self.cg.pressure),
            traction=self.full(self.lagged.traction),
            slopes=self.lagged.slopes_used.spread(self.window, self.whole.grid),
            status=status,
            excluded=self.full(ended.excluded),
            iterations={f"CG at {self.whole.grid}": self.cg_iterations},
            indentation=None if used is None else self.full(used),
        )

    def copy(self) -> LevelSolver:
        """Return the solver with a state of its own."""
        other = copy(self)
        other.cg = self.cg.copy()
        other.lagged = self.lagged.on(other.cg)
        return other

    def restore(self, copied: LevelSolver) -> None:
        """Go back to a copy; CG steps are counted on."""
        steps = self.cg_iterations
        vars(self).update(vars(copied))
        self.cg_iterations = steps

    @property
    def pressure(self) -> Array:
        return self.cg.pressure

    @property
    def contact(self) -> Mask:
        return self.cg.pressure > 0

    @property
    def exhausted(self) -> bool:
        """True if the lagged terms diverged, under pressures far beyond the moduli."""
        return self.lagged.diverged

    @property
    def needs_mixing(self) -> bool:
        """True if the lagged terms feed back so strongly that updates are mixed."""
        return self._control.mixing is not None

    @property
    def window_too_small(self) -> bool:
        """True if elements with shear meet the window's edge, which is not the grid's."""
        if self.problem.friction.jump == 0:
            return False
        return self.window.on_edge(self.contact | (self.lagged.traction > 0), self.whole.grid.shape)

    def solve(self, tolerance: float, active: ActiveSet, enough: ContactTest | None = None) -> bool:
        """Alternate CG and updates until the residual meets the tolerance, with tau on ``active``.

        Stop as soon as a contact set that passes ``enough`` is decided, of a gradual set after an update.
        """
        # mixing of the shares of tau has no bearing on a fixed set
        mixes = self.needs_mixing if self.lagged.active.is_fixed else self._slopes_need_mixing
        self.lagged.active, self._enough = active, enough
        least = constants.LEAST_REDUCTION if active.is_fixed else constants.REDUCTION
        goal, self._budget = constants.TOLERANCE_SHARE * tolerance, self.cg_iterations + constants.CG_LIMIT
        self._goal = goal
        self.residual = self.lagged.update()
        has_lag = self.lagged.has_lag
        self._control = MixingControl(self.residual, has_lag=has_lag, needs_mixing=mixes)
        self.stagnated = False
        for _ in range(constants.UPDATE_LIMIT):
            if has_lag and self.residual <= goal and not self._terms_are_current(goal):
                self.residual = self.lagged.update()
            if self.residual <= goal or self._contact_suffices():
                return self.residual <= goal
            if self.cg_iterations >= self._budget or self.exhausted or self._control.stagnated:
                break
            last = self.residual
            self.lagged.mix(self._control.mixing)
            fixed = self._reduce(self._cg_goal(tolerance))
            self.residual = self.lagged.update() if has_lag else fixed
            feedback = (self.residual - fixed) / last
            self._feedback = min(max(least, feedback), constants.REDUCTION)
            self._control.record(self.residual, feedback)
        self.stagnated = self.residual > goal
        return not self.stagnated

    def _terms_are_current(self, goal: float) -> bool:
        """Return whether the residual meets the goal after the scaling to the load as well."""
        return not self.needs_mixing and self.residual + self.lagged.scaling <= goal

    def _cg_goal(self, tolerance: float) -> float:
        """Return the residual to which CG reduces the fixed problem before the next update."""
        if not self.needs_mixing:
            share = constants.LAGGED_SHARE if self.lagged.has_lag else constants.PLAIN_SHARE
            return max(self._feedback * self.residual, share * tolerance)
        now = min(self.residual, max(self.cg.residuals()))
        return max(constants.REDUCTION * now, constants.MIXED_SHARE * tolerance)

    def _reduce(self, goal: float) -> float:
        """Take CG steps until the fixed problem's residual meets the goal or stagnates; return it."""
        residual = best = max(self.cg.residuals())
        since = 0
        while residual > goal and since < _patience(best) and self.cg_iterations < self._budget:
            # between mixed updates the state solves no problem of its own: its contact is not the rule's
            own = self.lagged.active.is_fixed and not self.needs_mixing
            if own and self._contact_suffices():
                break
            self.lagged.iterate()
            self.cg_iterations += 1
            residual = max(self.cg.residuals())
            best, since = (residual, 0) if residual < 0.9 * best else (best, since + 1)
        return residual

    def _contact_suffices(self) -> bool:
        """Return whether this state needs only a contact set, which is decided but for a small share."""
        if self._enough is None or not self._enough(self.cg.contact):
            return False
        active = self.lagged.active
        among = active.elements if isinstance(active, FixedSet) else None
        share = min(constants.UNDECIDED * self._goal, constants.MOST_UNDECIDED)
        return self.cg.undecided(self._stiffness, among) <= share * float(np.count_nonzero(self.cg.contact))

    def _status(self) -> Status:
        if self.residual <= self._goal:
            return Status.CONVERGED
        return Status.ITERATION_LIMIT if self.cg_iterations >= self._budget else Status.STAGNATED

    def full(self, values: NDArray[Any]) -> NDArray[Any]:
        """Return a window's array on the whole grid."""
        return self.window.spread(values, self.whole.grid.shape)


def _patience(residual: float) -> int:
    """Return the CG steps without progress that are allowed; few where only rounding is left."""
    return constants.CG_PATIENCE if residual > constants.NEAR_ROUNDING else constants.ROUNDING_PATIENCE
