"""One grid of the production solver: projected CG on the contact's window, with the rest lagged.

CG inverts ``a f``, and weak coupling with it (`flexibility`). The rest is held (`lagged_terms`) while CG
reduces the residual as far as that lets it, and is then brought up to date. Where its own feedback is weak
few updates suffice; where it is not they are mixed (`anderson`).
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from refimpl.grid import Array
from refimpl.grid.window import Window
from refimpl.model.friction import Mask, TauSupport
from refimpl.model.problem import Problem, visit
from refimpl.model.state import Outcome, Status, Visited
from refimpl.operators.fft import Counter, FFTInfluence, WholeGridInfluence
from refimpl.operators.periodic import PeriodicInfluence
from refimpl.solvers.production.coarse_grids import Start
from refimpl.solvers.production.flexibility import Flexibility
from refimpl.solvers.production.lagged_terms import Held
from refimpl.solvers.production.projected_cg import Apply, ProjectedCG
from refimpl.solvers.production.updates import Updates
from refimpl.solvers.tau_active_set import followed

_REDUCTION = 0.1  # of the residual is as much as CG leaves between updates of what is held
_LEAST_FEEDBACK = 1e-3  # and this, where the last update brought hardly anything back
_KEPT = 0.99  # of the tolerance: the certificate, recomputed, rounds otherwise, by 1e-15 against 1e-12
_CG_LIMIT = 1000  # in one settling; those of `verification.extremes` that end well take 108 at most
_CG_PATIENCE = 40  # CG steps without a tenth's progress before the residual counts as stagnant
_MIXED_SHARE = 0.1  # of the tolerance, for CG between mixed updates: what it leaves is noise to them
_UPDATES = 600  # of what is held, in one settling; there 59 at most

WindowInfluence = FFTInfluence | PeriodicInfluence


def influence(problem: Problem, window: Window, counter: Counter) -> WindowInfluence:
    """The operator of a problem's window, which is the whole grid where it repeats."""
    if problem.periodic:
        return PeriodicInfluence(problem.grid, problem.direction, counter=counter)
    return FFTInfluence(problem.grid, problem.direction, source=window, counter=counter)


class LevelSolver:
    """One grid level: CG on a window, with slopes, shear and tau's support brought up to date.

    ``strong`` says that what is held feeds back so strongly that updates are mixed from the first.
    """

    def __init__(
        self,
        problem: Problem,
        operator: WindowInfluence,
        precondition: Apply,
        pressure: Array,
        *,
        strong: bool = False,
    ) -> None:
        self.whole = problem
        self.counter = operator.counter
        self.cg_iterations = 0
        self.window = operator.source
        self.problem = problem.windowed(self.window)
        self.operator = operator
        self.flexibility = Flexibility(self.problem, operator)
        self.cg = ProjectedCG(self.flexibility.apply, precondition, pressure)
        self.held = Held(self.problem, self.flexibility, self.cg)
        self._nowhere = self.held.support
        self._withheld: Mask | None = None
        # of an element against its neighbours: `a` at a grid's highest frequency, as in `coarse_grids`
        self._stiffness = 0.5 / (problem.pair.normal_compliance * problem.grid.spacing)
        self.stuck = False
        self._updates = Updates(math.inf, lags=True, strong=strong)
        self._feedback = _REDUCTION

    def answer(self) -> Start:
        """What this grid has to say to a finer one."""
        displacement = self.full(self.cg.separation - self.problem.gap)
        if self.window != Window.full(self.whole.grid.M):
            outside = self.problem.pair.normal_compliance * self._onto_whole_grid().normal(
                self.full(self.cg.pressure)
            )
            outside[self.window.slices] = displacement[self.window.slices]
            displacement = outside
        return Start(self.full(self.cg.pressure), displacement, self.cg.approach, self.strong)

    def _onto_whole_grid(self) -> WholeGridInfluence:
        grid = self.whole.grid
        return WholeGridInfluence(
            grid,
            self.whole.direction,
            source=self.window,
            target=Window.full(grid.M),
            counter=self.counter,
        )

    def solve(self, tolerance: float) -> Outcome:
        """The settled state; tau's support follows the rule of `refimpl.model.friction`.

        Where one of tau's states meets the window's edge the next are not the rule's: it ends ``cramped``.
        """
        if self.problem.friction.tau == 0:
            self.settle(tolerance)
            return self._outcome(self._ended(), TauSupport((1, 1)), [])
        rule, in_cycles = followed(self, tolerance)
        lawful = not np.any(rule.withheld & self.contact)
        status = self._ended()
        if status is Status.CONVERGED and not lawful:
            status = Status.CYCLED
        return self._outcome(
            status if rule.settled or self.ran_off or self.stuck else Status.ITERATION_LIMIT, rule, in_cycles
        )

    @property
    def contact(self) -> Mask:
        """Where the present pressure is positive."""
        return self.cg.pressure > 0

    @property
    def ran_off(self) -> bool:
        """Whether slopes did, under pressures far beyond the moduli."""
        return self.held.ran_off

    @property
    def strong(self) -> bool:
        """Whether what is held feeds back so strongly that updates are mixed."""
        return self._updates.mixing is not None

    @property
    def cramped(self) -> bool:
        """Whether the contact of one of tau's states meets the window's edge, which is not the grid's."""
        return self.problem.friction.tau > 0 and self.window.on_edge(self.contact, self.whole.grid.M)

    def visited(self) -> Visited:
        """The present state's numbers."""
        return visit(self.problem, self.cg.pressure, self.held.traction, self.held.slopes)

    def settle(self, tolerance: float, support: Mask | None = None, withheld: Mask | None = None) -> bool:
        """CG and updates in turn until the residual meets the tolerance; tau on ``support`` or nowhere.

        Given what tau's rule has ``withheld``, it stops as soon as the next support is certain to be another.
        """
        self.held.support, self._withheld = self._nowhere if support is None else support, withheld
        self._tolerance, self._budget = _KEPT * tolerance, self.cg_iterations + _CG_LIMIT
        self.residual = self.held.update(self.cg_iterations)
        lags = self.held.lags
        self._updates, self.stuck = Updates(self.residual, lags=lags, strong=self.strong), False
        for _ in range(_UPDATES):
            # the residual is of what the pressure asked for before it met the load
            if lags and self.residual <= self._tolerance:
                self.residual = self.held.update(self.cg_iterations)
            if self.residual <= self._tolerance or self._leads_on():
                return self.residual <= self._tolerance
            if self.cg_iterations >= self._budget or self.ran_off or self._updates.given_up:
                break
            last = self.residual
            self.held.mix(self._updates.mixing)
            frozen = self._reduce(self._goal(tolerance))
            self.residual = self.held.update(self.cg_iterations) if lags else frozen
            brought_back = (self.residual - frozen) / last
            self._feedback = min(max(_LEAST_FEEDBACK, brought_back), _REDUCTION)
            self._updates.led_to(self.residual, brought_back)
        self.stuck = self.residual > self._tolerance
        return not self.stuck

    def _goal(self, tolerance: float) -> float:
        """How far CG is to bring the frozen problem's residual down before the next update."""
        if not self.strong:
            return max(self._feedback * self.residual, self._share * tolerance)
        return max(_REDUCTION * min(self.residual, max(self.cg.residuals())), _MIXED_SHARE * tolerance)

    def _reduce(self, goal: float) -> float:
        """CG steps until the frozen problem's residual, returned, meets the goal or no longer falls."""
        residual = best = max(self.cg.residuals())
        since = 0
        while residual > goal and since < _CG_PATIENCE and self.cg_iterations < self._budget:
            # a mixed state solves no frozen problem: its contact tells nothing
            if not self.strong and self._leads_on():
                break
            self.cg.iterate()
            self.cg_iterations += 1
            residual = max(self.cg.residuals())
            best, since = (residual, 0) if residual < 0.9 * best else (best, since + 1)
        return residual

    def _leads_on(self) -> bool:
        """Whether the contact, beyond doubt, leads tau's rule to another support than the present one.

        Where tau moves nothing the next state is the same one.
        """
        terms = self.problem.terms
        moved = terms.coupled or terms.oblique or terms.slope_correction
        if self._withheld is None or not moved:
            return False
        if not self.cg.beyond_doubt(self._stiffness):
            return False
        return not np.array_equal(self.cg.contact & ~self._withheld, self.held.support)

    @property
    def _share(self) -> float:
        """Of the tolerance, for the frozen problem: the rest is for what is held, or for rounding alone."""
        return 0.3 if self.held.lags else 0.9

    def _ended(self) -> Status:
        if self.residual <= self._tolerance:
            return Status.CONVERGED
        return Status.ITERATION_LIMIT if self.cg_iterations >= self._budget else Status.STAGNATED

    def _outcome(self, status: Status, rule: TauSupport, in_cycles: list[Visited]) -> Outcome:
        withheld = rule.withheld if in_cycles else np.zeros(self.window.shape, dtype=bool)
        return Outcome(
            pressure=self.full(self.cg.pressure),
            traction=self.full(self.held.traction),
            slopes=self.held.entered.spread(self.window, self.whole.grid.M),
            status=status,
            withheld=self.full(withheld),
            visited=tuple(in_cycles),
            iterations={f"CG at {self.whole.grid.M}": self.cg_iterations},
        )

    def full(self, values: NDArray[Any]) -> NDArray[Any]:
        """A window array on the whole grid."""
        return self.window.spread(values, self.whole.grid.M)
