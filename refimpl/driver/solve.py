"""From a scene to a solution: plan, discretise, solve, certify, error bars, record."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from refimpl.accuracy.grid_features import GridFeatures
from refimpl.accuracy.refinement import Quantity, refine_until, relative_bound, uncertainty
from refimpl.driver.limits import Allowance, Limits
from refimpl.driver.options import Options
from refimpl.errors import InputError
from refimpl.grid import Array, Grid, Window
from refimpl.model.certificate import State, certify
from refimpl.model.problem import Problem
from refimpl.model.state import SolverResult, Status
from refimpl.operators.fft import Counter
from refimpl.operators.influence import whole_grid_influence
from refimpl.planning.plan import Method, Plan
from refimpl.planning.term_effects import effects_in
from refimpl.planning.terms import RequestedTerms
from refimpl.scene.discretise import Discretiser
from refimpl.scene.scene import Scene
from refimpl.solution.cost import Cost, total_cost
from refimpl.solution.limits import Notice
from refimpl.solution.plausibility import implausible
from refimpl.solution.solution import Solution, assemble
from refimpl.solution.solved import Solved
from refimpl.solvers.dense import solve_dense
from refimpl.solvers.paper import solve_paper
from refimpl.solvers.production.coarse_grids import InitialGuess
from refimpl.solvers.production.nested_solver import solve_fft

Progress = Callable[[str], None]


def solve(
    scene: Scene,
    grid: int | tuple[int, int] | None = None,
    *,
    method: Method = "fft",
    accuracy: float | None = None,
    quantity: Quantity | None = None,
    approach: float | None = None,
    oblique: bool | None = None,
    slope_correction: bool = False,
    coupled: bool | None = None,
    tilted: bool | None = None,
    plastic: bool | None = None,
    tolerance: float | None = None,
    start: Solution | None = None,
    max_grid: int | None = None,
    max_seconds: float | None = None,
    max_memory: float | None = None,
    progress: Progress | None = None,
) -> Solution:
    """Solve a scene on a grid of elements, or to a relative ``accuracy``; exactly one of them.

    Parameters
    ----------
    grid : elements along the longer side, the other number chosen for elements nearest to square; or both,
        ``(Mx, My)``
    method : "fft" the production solver, "dense" the plain reference for small grids, "paper" the
        paper's own scheme
    accuracy : refine until the error bar of ``quantity`` is this share of its value, on grids of one element
        ratio
    quantity : "friction_coefficient" (the default with friction), "contact_area" (without),
        "contact_area_corrected" or "max_pressure"
    approach : prescribe the approach (m) instead of the scene's load
    oblique : False neglects every slope term: the classical small-slope theory that other codes solve; None
        lets the scene decide
    slope_correction : exact facet tractions in Eq. (7): `refimpl.model.forces`
    coupled, tilted : request or exclude what shear does to the gap, and to the slopes of the common surface;
        None lets the scene decide
    max_grid, max_seconds, max_memory : with ``accuracy``: the largest number of elements along a side,
        seconds in all, bytes of a grid; beyond them the status is `ACCURACY_NOT_REACHED`, with
        the finest grid within them. An interrupt (KeyboardInterrupt) has the last finished grid's solution as
        its argument
    plastic : True ends pressures at the hardness of the softer body, False never does; None takes the
        scene's own choice, and without one the cap enters where pressures reach a given hardness
    tolerance : what every residual of the certificate must meet for status `CONVERGED`; by default
        1e-8 (with ``accuracy``, a share of it), and for "paper" its own load tolerance of 1e-4
        (its pressure tolerance is a tenth of it)
    start : a certified solution on a grid of the same lengths that is not finer, for "fft" to start from:
        nested grids no finer are skipped, and the solution is the same. Best this scene's own on a coarser
        grid; after another load the nested grids are faster
    progress : called with a line of text at every step of the work

    Raises `InputError` for input that is out of range, before anything large is allocated; and, by "dense"
    alone, `ArithmeticError` where a problem on its way has no solution: if shear on slopes bears more than
    the load, for example, no approach balances it. Other methods end with a status then.
    """
    if progress is not None and not callable(progress):
        raise InputError("progress", progress, "a function of one line of text")
    options = Options(
        scene=scene,
        grid=grid,
        method=method,
        accuracy=accuracy,
        quantity=quantity,
        approach=approach,
        requested=RequestedTerms(coupled, oblique, tilted, slope_correction, plastic),
        tolerance=tolerance,
        start=start,
        limits=Limits(max_grid, max_seconds, max_memory),
    )
    discretiser = Discretiser(scene, options.approach)
    plan = options.plan(discretiser)
    if options.accuracy is not None:
        return _refined(options, plan, discretiser, progress)
    guess = None if start is None else _guess(start.problem, start.pressure, start.clearance, start.approach)
    solved = _solve_on_grid(plan, discretiser, options.residual_tolerance, progress, guess)
    notes = _notes(scene, solved, discretiser.notes)
    return assemble(scene, solved, uncertainty([solved.features]), notes)


class _Refinement:
    """Solves of one scene on finer and finer grids; terms that turn out to matter are restored for good."""

    def __init__(
        self,
        scene: Scene,
        plan: Plan,
        discretiser: Discretiser,
        options: Options,
        progress: Progress | None,
    ) -> None:
        self.scene, self.plan = scene, plan
        self.costs: list[Cost] = []
        self.last: Solved | None = None
        self._discretiser, self._progress = discretiser, progress
        self._tolerance, self._allowance = options.residual_tolerance, Allowance(options.limits)

    def features_at(self, M: int) -> GridFeatures:
        """Solve on a grid, no coarser than the last; again if neglected terms exceed their budget."""
        start = self.last if self.last is not None and self.last.status in _CONVERGED else None
        guess = None
        if start is not None:
            state = start.state
            guess = _guess(
                start.problem, state.pressure, state.clearance, state.approach - start.problem.datum
            )
        plan = self.plan.on(self.scene.refined(M))
        self._allowance.check(plan.grid, plan.memory)
        if self._progress is not None and self.last is not None:
            expected = self._allowance.expected_seconds(plan.grid)
            self._progress(f"{plan.grid} elements next: about {expected:.2g} s, {plan.memory / 1e9:.2g} GB")
        solved = _solve_on_grid(plan, self._discretiser, self._tolerance, self._progress, guess)
        self.plan = solved.plan  # with the cap, if it was restored
        self.costs.append(solved.cost)
        self.last = solved
        self._allowance.record(plan.grid, solved.cost.seconds)
        effects = effects_in(
            plan.neglected, solved.problem, solved.state.pressure, plan.contact, plan.decided_on
        )
        sizes = {name: effect.larger for name, effect in effects.items()}
        if sum(sizes.values()) > self.plan.budget:
            largest = max(sizes, key=lambda name: sizes[name])
            self.plan = self.plan.restore(solved.problem, largest)
            return self.features_at(M)
        return solved.features

    def solved(self) -> Solved:
        """Return what was solved last."""
        assert self.last is not None
        return self.last


def _interrupted(scene: Scene, grids: _Refinement, discretiser: Discretiser) -> Solution:
    """The last finished grid's solution of a refinement that was interrupted."""
    solved = grids.solved()
    line = Notice("interrupted: the finest grid that was finished")
    notes = _notes(scene, solved, discretiser.notes)
    bars = uncertainty([solved.features])
    return assemble(scene, solved, bars, notes, shortfall=line, cost=total_cost(grids.costs))


_CONVERGED = (Status.CONVERGED, Status.CYCLED)


def _refined(options: Options, plan: Plan, discretiser: Discretiser, progress: Progress | None) -> Solution:
    """The finest grid's solution of a refinement, with the uncertainty from all grids and the summed cost.

    When finer grids do not fit into memory, or exceed the largest size, the finest solved is returned as
    `ACCURACY_NOT_REACHED` with a warning that states the accuracy reached.
    """
    scene, quantity = options.scene, options.target_quantity
    assert options.accuracy is not None
    grids = _Refinement(scene, plan, discretiser, options, progress)
    try:
        ended = refine_until(grids.features_at, options.accuracy, quantity, slenderness=scene.slenderness)
    except KeyboardInterrupt as interrupt:
        if grids.last is not None:
            interrupt.args = (_interrupted(scene, grids, discretiser),)
        raise
    solved, cost = grids.solved(), total_cost(grids.costs)
    notes = _notes(scene, solved, discretiser.notes)
    if not ended.results[-1].touching:
        return assemble(scene, solved, uncertainty([ended.results[-1]]), notes, cost=cost)
    shortfall = None
    if ended.refusal:
        bound = relative_bound(ended.results, quantity)
        reached = f"known to {bound:.2g}, not" if math.isfinite(bound) else "not bounded, let alone"
        shortfall = Notice(f"{quantity} is {reached} to {options.accuracy:.2g}: {ended.refusal}")
    return assemble(scene, solved, uncertainty(ended.results), notes, shortfall=shortfall, cost=cost)


class _ReportingCounter(Counter):
    """A counter that reports the progress on one grid."""

    def __init__(self, grid: Grid, report: Progress) -> None:
        super().__init__()
        self._grid, self._report = grid, report

    def add(self, what: str, points: int) -> None:
        """Count an application, and report the number so far."""
        super().add(what, points)
        self._report(f"{self._grid} elements, {sum(self.tally.values())} transforms")


def _solve_on_grid(
    plan: Plan,
    discretiser: Discretiser,
    tolerance: float,
    progress: Progress | None,
    guess: InitialGuess | None,
) -> Solved:
    """Discretise, solve and certify on one grid."""
    started = time.perf_counter()
    counter = Counter() if progress is None else _ReportingCounter(plan.grid, progress)
    problem = discretiser.problem(plan.grid, plan.switches)
    result, state = _solve_problem(problem, plan.method, tolerance, counter, guess)
    cost = Cost(time.perf_counter() - started, counter.tally, counter.point_logs, result.iterations)
    solved = Solved(problem, plan, result, state, tolerance, cost, discretiser.scene)
    hardness = problem.pair.softer_hardness or math.inf
    if plan.requested.plastic is not None or plan.includes("plastic") or state.max_pressure <= hardness:
        return solved
    capped = _solve_on_grid(plan.restore(problem, "plastic"), discretiser, tolerance, progress, guess)
    return replace(capped, cost=total_cost([cost, capped.cost]))


def _solve_problem(
    problem: Problem, method: Method, tolerance: float, counter: Counter, guess: InitialGuess | None
) -> tuple[SolverResult, State]:
    if problem.approach is not None and problem.approach <= 0:
        return _without_contact(problem)
    if method == "dense":
        return solve_dense(problem)
    if method == "paper":
        result, state, _ = solve_paper(problem, tolerance, counter)
        return result, state
    return solve_fft(problem, tolerance, counter, guess)


def _without_contact(problem: Problem) -> tuple[SolverResult, State]:
    """The state of surfaces that do not touch at the approach: nothing is loaded."""
    zero = np.zeros(problem.gap.shape)
    slopes = problem.slopes(zero, zero)
    operator = whole_grid_influence(problem.grid, problem.direction, Window(0, 1, 0, 1))
    result = SolverResult(zero, zero, slopes, Status.NO_CONTACT, zero > 0)
    return result, certify(problem, operator, zero, zero, slopes)


def _guess(problem: Problem, pressure: Array, clearance: Array, approach: float) -> InitialGuess:
    """The initial guess for a grid that is not coarser, from a state and its reported approach (m)."""
    return InitialGuess(pressure, clearance + (approach + problem.datum) - problem.gap, None)


def _notes(scene: Scene, solved: Solved, lines: Sequence[str]) -> tuple[Notice, ...]:
    """Notes of implausible inputs and of surfaces; unresolved roughness has a named warning of its own."""
    grid, parts = solved.problem.grid, (*scene.lower.surface.parts, *scene.upper.surface.parts)
    lines = (*implausible(scene, solved.plan), *lines)
    rough = (part for part in parts if part.detail(max(grid.spacings)) is not None)
    named = {line for part in rough for line in part.cautions(grid)}
    return tuple(Notice(line) for line in lines if line not in named)
