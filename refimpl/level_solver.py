"""One grid of the production solver: projected CG on the contact's window, with the rest lagged.

CG inverts ``a f``, and weak coupling with it (`refimpl.flexibility`). The rest of the shear displacement,
slopes, the load's weights and tau's support are held while CG reduces the residual as far as they let it,
and are then brought up to date; their own feedback is weak, so few updates suffice.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from refimpl.contact.projected_cg import Apply, ProjectedCG
from refimpl.flexibility import Flexibility
from refimpl.friction import Mask, TauSupport, local_friction
from refimpl.grid import Array, inner
from refimpl.nesting import Start
from refimpl.operators.fft import Counter, FFTInfluence, WholeGridInfluence
from refimpl.operators.periodic import PeriodicInfluence
from refimpl.operators.window import Window
from refimpl.outcome import Outcome, Status, Visited
from refimpl.problem import Problem, visit
from refimpl.slopes import Slopes
from refimpl.tau_path import followed

_REDUCTION = 0.1  # of the residual is as much as CG leaves between updates of what is held
_LEAST_FEEDBACK = 1e-3  # and this, where the last update brought hardly anything back
_KEPT = 0.99  # of the tolerance: the certificate, recomputed, rounds otherwise, by 1e-15 against 1e-12
_CG_LIMIT = 1000
_CG_PATIENCE = 40  # CG steps without a tenth's progress before the residual counts as stagnant
_STALLED = 5  # updates in a row that do not halve the best residual: they do not contract
_UPDATES = 600  # of what is held, in one settling: 36 sigma^2 reach 1e-8, and sigma above 4 is given up
_STEEPEST = 1e-6  # cosine of slopes that have run off, under pressures far beyond the moduli
_LEAST_RELAXATION = 1 / 16  # below this, updates that do not contract are given up


WindowInfluence = FFTInfluence | PeriodicInfluence


def influence(problem: Problem, window: Window, counter: Counter) -> WindowInfluence:
    """The operator of a problem's window, which is the whole grid where it repeats."""
    if problem.periodic:
        return PeriodicInfluence(problem.grid, problem.direction, counter=counter)
    return FFTInfluence(problem.grid, problem.direction, source=window, counter=counter)


class LevelSolver:
    """One grid level: CG on a window, with slopes, shear and tau's support brought up to date."""

    def __init__(
        self,
        problem: Problem,
        operator: WindowInfluence,
        precondition: Apply,
        pressure: Array,
    ) -> None:
        self.whole = problem
        self.counter = operator.counter
        self.cg_iterations = 0
        self.window = operator.source
        self.problem = problem.windowed(self.window)
        self.operator = operator
        self.flexibility = Flexibility(self.problem, operator)
        self.cg = ProjectedCG(self.flexibility.apply, precondition, pressure)
        self.slopes = self._entered = Slopes.flat(self.window.shape)
        self._nowhere: Mask = np.zeros(self.window.shape, dtype=bool)
        self.support = self._nowhere
        self._held: tuple[Array, Array] | None = None
        self._withheld: Mask | None = None
        # of an element against its neighbours: `a` at a grid's highest frequency, as in `refimpl.nesting`
        self._stiffness = 0.5 / (problem.pair.normal_compliance * problem.grid.spacing)
        self.ran_off = False
        self._feedback = _REDUCTION
        # The lagged beta c f is skew with spectral radius sigma against a f, so the best relaxation is
        # 1 / (1 + sigma^2) and contracts by sigma / sqrt(1 + sigma^2) for every beta.
        sigma = 0.0 if self.flexibility.coupled else self.flexibility.sigma
        self._relaxation = self._best_relaxation = 1 / (1 + sigma**2)
        self._patience = _STALLED + math.ceil(2 * math.log(2) / math.log1p(1 / max(sigma, 0.1) ** 2))

    def answer(self) -> Start:
        """What this grid has to say to a finer one."""
        displacement = self.full(self.cg.separation - self.problem.gap)
        if self.window != Window.full(self.whole.grid.M):
            outside = self.problem.pair.normal_compliance * self._onto_whole_grid().normal(
                self.full(self.cg.pressure)
            )
            outside[self.window.slices] = displacement[self.window.slices]
            displacement = outside
        return Start(self.full(self.cg.pressure), displacement, self.cg.approach)

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
        """The settled state; tau's support follows the rule of `refimpl.friction`.

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
            status if rule.settled or self.ran_off else Status.ITERATION_LIMIT, rule, in_cycles
        )

    @property
    def contact(self) -> Mask:
        """Where the present pressure is positive."""
        return self.cg.pressure > 0

    @property
    def cramped(self) -> bool:
        """Whether the contact of one of tau's states meets the window's edge, which is not the grid's."""
        return self.problem.friction.tau > 0 and self.window.on_edge(self.contact, self.whole.grid.M)

    def visited(self) -> Visited:
        """The present state's numbers."""
        return visit(self.problem, self.cg.pressure, self._pulled(), self.slopes)

    def settle(self, tolerance: float, support: Mask | None = None, withheld: Mask | None = None) -> bool:
        """CG and updates in turn until the residual meets the tolerance; tau on ``support`` or nowhere.

        With what tau's rule has ``withheld``, only until it is beyond doubt that its next support is another.
        """
        self.support, self._withheld = self._nowhere if support is None else support, withheld
        self._tolerance, self._budget = _KEPT * tolerance, self.cg_iterations + _CG_LIMIT
        self._relaxation = self._best_relaxation  # anew for each of tau's supports
        self.residual = best = self._update()
        stalled = 0
        for _ in range(_UPDATES):
            if self.residual <= self._tolerance or self.cg_iterations >= self._budget or self.ran_off:
                break
            if self._leads_on():
                break
            last = self.residual
            frozen = self._reduce(max(self._feedback * last, self._share * tolerance))
            self.residual = self._update() if self._lags else frozen
            self._feedback = min(max(_LEAST_FEEDBACK, (self.residual - frozen) / last), _REDUCTION)
            if self.residual < 0.5 * best:
                best, stalled = self.residual, 0
            else:
                stalled += 1
            if stalled >= self._patience:
                if not self._lags or self._relaxation < _LEAST_RELAXATION:
                    break
                self._relaxation, stalled = 0.5 * self._relaxation, 0
        return self.residual <= self._tolerance

    def _reduce(self, goal: float) -> float:
        """CG steps until the frozen problem's residual, returned, meets the goal or no longer falls."""
        residual = best = max(self.cg.residuals())
        since = 0
        while residual > goal and since < _CG_PATIENCE and self.cg_iterations < self._budget:
            if self._leads_on():
                break
            self.cg.iterate()
            self.cg_iterations += 1
            residual = max(self.cg.residuals())
            best, since = (residual, 0) if residual < 0.9 * best else (best, since + 1)
        return residual

    def _leads_on(self) -> bool:
        """Whether the contact, beyond doubt, leads tau's rule to another support than the present one.

        Relaxed updates hold a part of the misfit back, so that nothing is beyond doubt; and where tau moves
        nothing the next state is the same one.
        """
        terms = self.problem.terms
        moved = terms.coupled or terms.oblique or terms.slope_correction
        if self._withheld is None or self._relaxation < 1 or not moved:
            return False
        if not self.cg.beyond_doubt(self._stiffness):
            return False
        return not np.array_equal(self.cg.contact & ~self._withheld, self.support)

    @property
    def _share(self) -> float:
        """Of the tolerance, for the frozen problem: the rest is for what is held, or for rounding alone."""
        return 0.3 if self._lags else 0.9

    @property
    def _lags(self) -> bool:
        """Whether anything that CG holds depends on the pressure."""
        terms, sheared = self.problem.terms, self.problem.friction.beta > 0 and not self.flexibility.coupled
        return terms.oblique or terms.slope_correction or (terms.coupled and sheared)

    def _update(self) -> float:
        """Bring slopes, shear and load weights up to date; the residual of the whole problem."""
        problem, pressure = self.problem, self.cg.pressure
        shear, slopes = self.flexibility.displaced(
            pressure, self.cg_iterations, self.support, self.slopes, self.cg.normal_displacement
        )
        self._entered, change = slopes, 0.0
        if problem.terms.slope_correction:  # the displacements are those of facets at the last slopes
            self._entered, change = self.slopes, slopes.distance(self.slopes, pressure > 0)
        self.ran_off = not slopes.obliqueness.min() > _STEEPEST
        if not self.ran_off:
            self.slopes = slopes
        target, balance = self._target(self.slopes.obliqueness)
        K = self.slopes.obliqueness
        self._hold(shear, K, target)
        residual = math.inf if self.ran_off else max(*self.cg.residuals(), balance, change)
        if self._held is not None and self._relaxation < 1 and residual > self._tolerance:
            shear = self._held[0] + self._relaxation * (shear - self._held[0])
            if problem.terms.oblique:
                K = self._held[1] + self._relaxation * (K - self._held[1])
            self._hold(shear, K, self._target(K)[0])
        self._held = shear, K
        return residual

    def _pulled(self) -> Array:
        """The traction of the present pressure, with tau on its support."""
        return local_friction(self.problem.friction, self.cg.pressure, self.support)

    def _hold(self, shear: Array, K: Array, target: float | None) -> None:
        self.cg.freeze(K * self.problem.gap + shear, K, target=target, approach=self.problem.approach)

    def _target(self, K: Array) -> tuple[float | None, float]:
        """What ``sum K f`` must be for N = P, with the rest of Eq. (2) as it is now; and |N - P| / P."""
        problem, pressure = self.problem, self.cg.pressure
        if problem.load is None:
            return None, 0.0
        weights, offset = problem.load_weights(self.slopes, self.support)
        dA = problem.grid.element_area
        found = inner(weights, pressure)
        target = (problem.load + offset) / dA + inner(K, pressure) - found
        balance = abs(found * dA - offset - problem.load) / problem.load
        # shear on slopes that alone exceeds the load leaves no balance: keep some contact and fail by it
        return max(target, 1e-3 * problem.load / dA), balance

    def _ended(self) -> Status:
        if self.residual <= self._tolerance:
            return Status.CONVERGED
        return Status.ITERATION_LIMIT if self.cg_iterations >= self._budget else Status.STAGNATED

    def _outcome(self, status: Status, rule: TauSupport, in_cycles: list[Visited]) -> Outcome:
        withheld = rule.withheld if in_cycles else np.zeros(self.window.shape, dtype=bool)
        return Outcome(
            pressure=self.full(self.cg.pressure),
            traction=self.full(self._pulled()),
            slopes=self._entered.spread(self.window, self.whole.grid.M),
            status=status,
            withheld=self.full(withheld),
            visited=tuple(in_cycles),
            iterations={f"CG at {self.whole.grid.M}": self.cg_iterations},
        )

    def full(self, values: NDArray[Any]) -> NDArray[Any]:
        """A window array on the whole grid."""
        return self.window.spread(values, self.whole.grid.M)
