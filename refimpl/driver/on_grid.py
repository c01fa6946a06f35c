"""One grid of a scene: discretised, solved and certified."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from refimpl.driver.reference import solve_reference
from refimpl.grid import Array, Grid, Window
from refimpl.model.certificate import State, certify
from refimpl.model.problem import Problem
from refimpl.model.state import Status
from refimpl.operators.fft import Counter
from refimpl.operators.influence import whole_grid_influence
from refimpl.planning.plan import Method, Plan
from refimpl.planning.term_effects import effects_in
from refimpl.scene.discretise import Discretiser
from refimpl.solution.evidence import Cost, Evidence, total_cost
from refimpl.solvers.paper import solve_paper
from refimpl.solvers.production.coarse_grids import InitialGuess
from refimpl.solvers.production.nested_solver import solve_fft
from refimpl.solvers.production.plastic import at_hardness

Progress = Callable[[str], None]


def solve_on_grid(
    plan: Plan,
    discretiser: Discretiser,
    tolerance: float,
    progress: Progress | None,
    guess: InitialGuess | None,
) -> Evidence:
    """Discretise, solve and certify on one grid; again with a neglected term that turns out to matter."""
    started = time.perf_counter()
    counter = Counter() if progress is None else _ReportingCounter(plan.grid, progress)
    problem = discretiser.problem(plan.grid, plan.switches)
    state = _solve_problem(problem, plan.method, tolerance, counter, guess)
    cost = Cost(time.perf_counter() - started, counter.tally, counter.point_logs, state.iterations)
    solved = Evidence(discretiser.scene, problem, plan, state, tolerance, cost)
    missing = _missing(solved)
    if missing is None:
        return solved
    again = solve_on_grid(plan.restore(problem, missing), discretiser, tolerance, progress, guess)
    return replace(again, cost=total_cost([cost, again.cost]))


def _missing(solved: Evidence) -> str | None:
    """Name the cap that pressures reach, or the largest effect of neglected terms that exceed the budget."""
    plan, problem, state = solved.plan, solved.problem, solved.state
    hardness = problem.pair.softer_hardness or math.inf
    if plan.requested.plastic is None and not plan.includes("plastic") and state.max_pressure > hardness:
        return "plastic"
    if state.status not in (Status.CONVERGED, Status.CYCLED):
        return None
    found = effects_in(
        plan.neglected, problem, state.pressure, state.clearance, plan.contact, plan.decided_on
    )
    sizes = {name: effect.larger for name, effect in found.items()}
    return max(sizes, key=lambda name: sizes[name]) if sum(sizes.values()) > plan.budget else None


def _solve_problem(
    problem: Problem, method: Method, tolerance: float, counter: Counter, guess: InitialGuess | None
) -> State:
    if problem.approach is not None and problem.approach <= 0:
        return _without_contact(problem)
    if method == "dense":
        return solve_reference(problem)
    if method == "paper":
        return solve_paper(problem, tolerance, counter)[0]
    state = solve_fft(problem, tolerance, counter, guess)
    if state.status in (Status.CONVERGED, Status.CYCLED):
        return state
    full = at_hardness(problem, counter)
    return state if full is None else replace(full, iterations=state.iterations)


def _without_contact(problem: Problem) -> State:
    zero = np.zeros(problem.gap.shape)
    slopes = problem.slopes(zero, zero)
    operator = whole_grid_influence(problem.grid, problem.direction, Window(0, 1, 0, 1))
    return certify(problem, operator, zero, zero, slopes, status=Status.NO_CONTACT)


class _ReportingCounter(Counter):
    """A counter that reports the progress on one grid."""

    def __init__(self, grid: Grid, report: Progress) -> None:
        super().__init__()
        self._grid, self._report = grid, report

    def add(self, what: str, points: int) -> None:
        super().add(what, points)
        self._report(f"{self._grid} elements, {sum(self.tally.values())} transforms")


def initial_guess(problem: Problem, pressure: Array, clearance: Array, approach: float) -> InitialGuess:
    """Return the initial guess for a grid that is not coarser, from a state and its reported approach (m)."""
    return InitialGuess(pressure, clearance + (approach + problem.datum) - problem.gap, None)
