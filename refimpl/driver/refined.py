"""A scene on finer and finer grids, until an error bar is as short as requested."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache

from refimpl.accuracy.grid_features import GridFeatures
from refimpl.accuracy.refinement import (
    AIM,
    FIRST_GRIDS,
    GRID_SIZES,
    DataShares,
    Refinement,
    Unfinished,
    longer_side,
    predicted_size,
    reason_unreachable,
    refine_until,
    relative_bound,
    unfalling,
)
from refimpl.driver.limits import Allowance
from refimpl.driver.on_grid import Progress, initial_guess, solve_on_grid
from refimpl.driver.options import Options
from refimpl.grid import Grid
from refimpl.model.state import Status
from refimpl.planning.plan import Plan
from refimpl.scene.discretise import Discretiser
from refimpl.solution.domain_error import data_error, finest_by_data
from refimpl.solution.evidence import Cost, Evidence, total_cost
from refimpl.solution.model_warning import Notice
from refimpl.solution.solution import Solution, assemble

_CONVERGED = (Status.CONVERGED, Status.CYCLED)


def refined(options: Options, plan: Plan, discretiser: Discretiser, progress: Progress | None) -> Solution:
    """Return the finest grid's solution of a refinement, with the bars and the cost of all grids.

    Where limits end it, the status is `ACCURACY_NOT_REACHED`, with a warning of the accuracy reached.
    """
    quantity = options.target_quantity
    assert options.accuracy is not None
    grids = _Refinement(options, plan, discretiser, progress)
    try:
        ended = grids.until(grids.features_at)
    except KeyboardInterrupt as interrupt:
        if grids.last is not None:
            line = Notice("interrupted: the finest grid that was finished")
            interrupt.args = (assemble(grids.last, shortfall=line, cost=total_cost(grids.costs)),)
        raise
    solved, cost = grids.last, total_cost(grids.costs)
    assert solved is not None  # the first grids were solved
    if not ended.results[-1].touching:
        return assemble(solved, cost=cost)
    shortfall = None
    if ended.refusal:
        bound = relative_bound(ended.results, quantity)
        reached = f"known to {bound:.2g}, not" if math.isfinite(bound) else "not bounded, let alone"
        shortfall = Notice(f"{quantity} is {reached} to {options.accuracy:.2g}: {ended.refusal}")
    return assemble(solved, grids=ended.results, shortfall=shortfall, cost=cost)


@dataclass(frozen=True)
class Forecast:
    """Last grid that an accuracy is expected to take, seconds and memory (bytes) of that one.

    ``solved`` are the grids that the forecast itself took; ``refusal`` says why no grid is expected to do, or
    is empty.
    """

    grid: Grid
    seconds: float
    memory: float
    solved: tuple[Grid, ...]
    refusal: str


def forecast(options: Options, plan: Plan, discretiser: Discretiser) -> Forecast:
    """Refine as an accuracy would, up to half the elements per side of the last grid; forecast that grid."""
    scene, quantity, accuracy = options.scene, options.target_quantity, options.accuracy
    assert accuracy is not None
    grids = _Refinement(options, plan, discretiser, None)
    solved: list[GridFeatures] = []

    def far_from_the_end(M: int) -> GridFeatures:
        if len(solved) >= len(FIRST_GRIDS) and grids.expected_end(solved)[0] < 2 * M:
            raise Unfinished("")
        solved.append(grids.features_at(M))
        return solved[-1]

    ended = grids.until(far_from_the_end)
    size, refusal = longer_side(ended.results[-1]), ended.refusal
    short = relative_bound(ended.results, quantity) <= accuracy if ended.results[-1].touching else True
    if not short and not refusal:
        size, refusal = grids.expected_end(ended.results)
    expected = grids.plan.on(scene.refined(size))
    seconds = grids.allowance.expected_seconds(expected.grid)
    return Forecast(expected.grid, seconds, expected.memory, tuple(r.grid for r in ended.results), refusal)


class _Refinement:
    """Solves of one scene on finer and finer grids; terms that turn out to matter are restored for good."""

    def __init__(
        self, options: Options, plan: Plan, discretiser: Discretiser, progress: Progress | None
    ) -> None:
        self.scene, self.plan = options.scene, plan
        self._accuracy, self._quantity = options.accuracy or 0.0, options.target_quantity
        self.costs: list[Cost] = []
        self.last: Evidence | None = None
        self._discretiser, self._progress = discretiser, progress
        self._tolerance, self.allowance = options.residual_tolerance, Allowance(options.limits)
        self.data = DataShares(
            cache(lambda M: data_error(self.scene, self.scene.refined(M))), finest_by_data(self.scene)
        )

    def until(self, features_at: Callable[[int], GridFeatures]) -> Refinement:
        return refine_until(
            features_at,
            self._accuracy,
            self._quantity,
            slenderness=self.scene.slenderness,
            data=self.data,
            restored=self.restored,
        )

    def expected_end(self, results: Sequence[GridFeatures]) -> tuple[int, str]:
        """Return the longer side of the last grid, by the bars so far, and why the accuracy may fail."""
        size, value = longer_side(results[-1]), abs(results[-1].numbers[self._quantity])
        stuck = unfalling(results, self._quantity, self.data)
        refusal = reason_unreachable(stuck, value, self._accuracy) if value else ""
        aim = AIM * sum(stuck.values()) / value if refusal else self._accuracy
        finer = [M * self.scene.slenderness for M in GRID_SIZES if size < M * self.scene.slenderness]
        enough = predicted_size(results, aim, self._quantity, finer, self.data)
        size = enough or max(finer, default=size)
        return size, refusal or ("" if enough else f"{size} elements a side do not suffice")

    def features_at(self, M: int) -> GridFeatures:
        """Solve on a grid, no coarser than the last; raise `Unfinished` where only coarser ones converge."""
        start = self.last if self.last is not None and self.last.status in _CONVERGED else None
        guess = None
        if start is not None:
            state = start.state
            guess = initial_guess(
                start.problem, state.pressure, state.clearance, state.approach - start.problem.datum
            )
        plan = self.plan.on(self.scene.refined(M))
        self.allowance.check(plan.grid, plan.memory)
        if self._progress is not None and self.last is not None:
            expected = self.allowance.expected_seconds(plan.grid)
            self._progress(f"{plan.grid} elements next: about {expected:.2g} s, {plan.memory / 1e9:.2g} GB")
        solved = solve_on_grid(plan, self._discretiser, self._tolerance, self._progress, guess)
        self.costs.append(solved.cost)
        self.allowance.record(plan.grid, solved.cost.seconds)
        opened = len(self.costs) > len(FIRST_GRIDS)
        if opened and start is not None and solved.status not in _CONVERGED:
            raise Unfinished(f"{plan.grid} elements: {solved.status.value}")
        self.plan = solved.plan  # with what was restored
        self.last = solved
        return solved.features

    def restored(self) -> GridFeatures | None:
        """Return the last grid's features with all neglected terms, solved again; None where none is left."""
        neglected = self.plan.neglected
        if not neglected or self.last is None:
            return None
        for name in neglected:
            self.plan = self.plan.restore(self.last.problem, name)
        return self.features_at(longer_side(self.last.features))
