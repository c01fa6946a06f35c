"""From a scene to a solution: plan, pose, solve, certify, report."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from refimpl.accuracy.grid_features import GridResult
from refimpl.accuracy.refinement import Quantity, refine, total_cost, uncertainty
from refimpl.driver.options import Request
from refimpl.errors import InputError
from refimpl.grid import Grid
from refimpl.grid.window import Window
from refimpl.model.certificate import State, certify
from refimpl.model.problem import Problem
from refimpl.model.state import Outcome, Status
from refimpl.operators.dense import DenseInfluence
from refimpl.operators.fft import Counter, WholeGridInfluence
from refimpl.planning.effects_after import effects_left_out
from refimpl.planning.plan import Method, Plan
from refimpl.scene.discretise import Posing
from refimpl.scene.scene import Scene
from refimpl.solution.gathered import gathered
from refimpl.solution.limits import cautions
from refimpl.solution.remark import Remark
from refimpl.solution.solution import Cost, Solution
from refimpl.solvers.dense import solve_dense
from refimpl.solvers.paper import solve_paper
from refimpl.solvers.production.coarse_grids import Start
from refimpl.solvers.production.nested_solver import solve_fft
from refimpl.surfaces import GaussianRoughness

Progress = Callable[[str], None]


def solve(
    scene: Scene,
    grid: int | None = None,
    *,
    method: Method = "fft",
    accuracy: float | None = None,
    quantity: Quantity | None = None,
    approach: float | None = None,
    oblique: bool | None = None,
    slope_correction: bool = False,
    coupled: bool | None = None,
    tilted: bool | None = None,
    tolerance: float | None = None,
    start: Solution | None = None,
    progress: Progress | None = None,
) -> Solution:
    """Solve a scene on ``grid x grid`` elements, or to a relative ``accuracy``; exactly one of them.

    Parameters
    ----------
    method : "fft" the production solver, "dense" the plain reference for small grids, "paper" the
        paper's own scheme
    accuracy : refine until the error bar of ``quantity`` is this share of its value
    quantity : "friction_coefficient" (the default with friction), "contact_area" (without),
        "contact_area_corrected" or "max_pressure"
    approach : prescribe the approach (m) instead of the scene's load
    oblique : False drops every slope term; None lets the scene decide
    slope_correction : exact facet tractions in Eq. (7): `refimpl.model.forces`
    coupled, tilted : force in or out what shear does to the gap, and to the slopes of the common surface;
        None lets the scene decide
    tolerance : what every residual of the certificate must meet for status `CONVERGED`; by default
        1e-8 (with ``accuracy``, what that deserves), and for "paper" its own load tolerance of 1e-4
        (its pressure tolerance is a tenth of it)
    start : a certified solution on a grid of the same side that is not finer, for "fft" to start from: nested
        grids no finer are passed over, and the answer is the same. Best this scene's own on a coarser grid;
        after another load the nested grids get there sooner
    progress : is called with a line of text at every step of the work

    Raises `InputError` for input that is out of range, before anything large is allocated; and, by "dense"
    alone, `ArithmeticError` where a problem that it meets on its way has no solution: shear on slopes bears
    more than the load, say, so that no approach balances it. Other methods end with a status then.
    """
    if progress is not None and not callable(progress):
        raise InputError("progress", progress, "a function of one line of text")
    request = Request(
        scene=scene,
        grid=grid,
        method=method,
        accuracy=accuracy,
        quantity=quantity,
        approach=approach,
        oblique=oblique,
        slope_correction=slope_correction,
        coupled=coupled,
        tilted=tilted,
        tolerance=tolerance,
        start=start,
    )
    posing = Posing(scene, request.approach)
    plan = request.plan(posing)
    if request.accuracy is not None:
        planned = _Planned(scene, plan, posing, request.residual, progress)
        return refine(planned.solve_at, request.accuracy, request.judged)
    solution = _solve_planned(scene, plan, posing, request.residual, progress, start)
    return replace(solution, uncertainty=uncertainty([GridResult.of(solution)]))


class _Planned:
    """A plan made once for all grids of a refinement; terms that turn out to matter are put back for good."""

    def __init__(
        self, scene: Scene, plan: Plan, posing: Posing, tolerance: float, progress: Progress | None
    ) -> None:
        self.scene, self.plan = scene, plan
        self.asked = posing, tolerance, progress
        self._last: Solution | None = None

    def solve_at(self, M: int) -> Solution:
        """The solution on a grid, no coarser than the last; again if terms left out exceed their budget."""
        solution = _solve_planned(self.scene, self.plan.on(self.scene, M), *self.asked, self._last)
        self._last = solution if solution.converged else None
        plan = self.plan
        changes = effects_left_out(
            plan.left_out, solution.problem, solution.pressure, plan.outlook, plan.decided_on
        )
        sizes = {name: effect.larger for name, effect in changes.items()}
        if sum(sizes.values()) <= self.plan.budget:
            return solution
        self.plan = self.plan.put_back(self.scene, max(sizes, key=lambda name: sizes[name]))
        again = self.solve_at(M)
        return replace(again, cost=total_cost((solution.cost, again.cost)))


class _Watched(Counter):
    """A counter that tells someone who waits how often operators were applied on this grid."""

    def __init__(self, M: int, tell: Progress) -> None:
        super().__init__()
        self._M, self._tell = M, tell

    def add(self, what: str, points: int) -> None:
        """Count, and tell."""
        super().add(what, points)
        self._tell(f"{self._M} x {self._M} elements, {sum(self.tally.values())} transforms")


def _solve_planned(
    scene: Scene,
    plan: Plan,
    posing: Posing,
    tolerance: float,
    progress: Progress | None,
    start: Solution | None,
) -> Solution:
    """Pose, solve, certify and gather on one grid."""
    started = time.perf_counter()
    counter = Counter() if progress is None else _Watched(plan.M, progress)
    problem = posing.take(Grid(scene.side, plan.M), plan.switches)
    outcome, state = _solve_posed(problem, plan, tolerance, counter, _answer(start))
    cost = Cost(time.perf_counter() - started, counter.tally, counter.point_logs, outcome.iterations)
    solution = gathered(problem, plan, outcome, state, tolerance, cost)
    del outcome, state  # the displacements are in the surfaces now
    remarks = _remarks(scene, problem.grid, posing.remarks)
    return replace(solution, warnings=remarks + cautions(solution, scene))


def _remarks(scene: Scene, grid: Grid, lines: Sequence[str]) -> tuple[Remark, ...]:
    """What surfaces had to remark; unresolved roughness is told by name (`refimpl.solution.limits`)."""
    parts = (*scene.lower.surface.parts, *scene.upper.surface.parts)
    told = {line for part in parts if isinstance(part, GaussianRoughness) for line in part.cautions(grid)}
    return tuple(Remark(line) for line in lines if line not in told)


def _solve_posed(
    problem: Problem, plan: Plan, tolerance: float, counter: Counter, start: Start | None
) -> tuple[Outcome, State]:
    if problem.approach is not None and problem.approach <= 0:
        return _apart(problem)
    if plan.method == "dense":
        operator = DenseInfluence(problem.grid, problem.direction, periodic=problem.periodic)
        return solve_dense(problem, operator)
    if plan.method == "paper":
        outcome, state, _ = solve_paper(problem, tolerance, counter)
        return outcome, state
    return solve_fft(problem, tolerance, counter, start)


def _answer(solution: Solution | None) -> Start | None:
    """What a solution has to say to a grid that is not coarser."""
    if solution is None:
        return None
    problem = solution.problem
    approach = solution.approach + (float(problem.gap.mean()) if problem.periodic else 0.0)
    return Start(solution.pressure, solution.clearance + approach - problem.gap, None)


def _apart(problem: Problem) -> tuple[Outcome, State]:
    """The state of surfaces that the approach leaves apart: nothing is loaded."""
    zero = np.zeros(problem.gap.shape)
    slopes = problem.slopes(zero, zero)
    unloaded = WholeGridInfluence(
        problem.grid, problem.direction, source=Window(0, 1, 0, 1), target=Window.full(problem.grid.M)
    )
    free = Outcome(zero, zero, slopes, Status.NO_CONTACT, zero > 0, ())
    return free, certify(problem, unloaded, zero, zero, slopes)
