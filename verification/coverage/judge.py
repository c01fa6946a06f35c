"""`accuracy=` replayed on stored grids: did the bar hold the error, how long was it, and what did it cost?"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from refimpl.accuracy.refinement import FIRST_GRIDS, longer_side, refine_until, relative_bound
from verification.coverage.scenes import random_scene
from verification.coverage.store import GridSolve, judged_numbers

EDGE_SIZE_BOUND = 0.12
"""Of the edge, that a reference without its mean excess is open by: three standard deviations."""


@dataclass(frozen=True, kw_only=True)
class Coverage:
    """Error bar and error of one number of one scene at one accuracy, and the bound of the error's reference.

    Lengths are over the value. ``cheapest`` is the coarsest grid from which on every grid's error is
    within the accuracy, ``cost`` the transforms' ``n log n`` of all grids solved, each from the last one's
    answer, over that of the cheapest, solved afresh. (A third grid is counted as from the opening.)
    """

    seed: int
    kind: str
    number: str
    accuracy: float
    grids: tuple[int, ...]
    met: bool
    bar: float
    error: float
    reference_bound: float
    cheapest: int | None
    cost: float | None

    @property
    def covered(self) -> bool:
        """True if the true error lies inside the bar."""
        return self.error <= self.bar

    @property
    def covered_at_worst(self) -> bool:
        """True if the bar covers a reference moved by its whole bound, in the unfavourable direction."""
        return self.error + self.reference_bound <= self.bar


def coverages(stored: Mapping[int, Sequence[GridSolve]], accuracy: float) -> list[Coverage]:
    """Return all numbers of all scenes; a scene's finest grid is its reference."""
    return [
        _replayed(solves, number, accuracy)
        for seed, solves in stored.items()
        for number in judged_numbers(random_scene(seed).scene.friction)
    ]


def _replayed(solves: Sequence[GridSolve], number: str, accuracy: float) -> Coverage:
    """Judge a grid only if the reference is at least twice as fine."""
    reference, bound = reference_of(solves, number)
    usable = {one.M: one for one in solves if 2 * one.M <= solves[-1].M}
    finer = [M for M in usable if M not in FIRST_GRIDS]
    refined = refine_until(lambda M: usable[M].result, accuracy, number, finer)
    value = refined.results[-1].numbers[number]
    grids = tuple(map(longer_side, refined.results))
    met = not refined.refusal
    errors = {M: abs(usable[M].result.numbers[number] / reference - 1) for M in (FIRST_GRIDS[-1], *finer)}
    cheapest = next((M for M in errors if all(errors[N] <= accuracy for N in errors if N >= M)), None)
    work = usable[grids[0]].point_logs + sum(usable[M].carried or usable[M].point_logs for M in grids[1:])
    return Coverage(
        seed=solves[0].seed,
        kind=random_scene(solves[0].seed).kind,
        number=number,
        accuracy=accuracy,
        grids=grids,
        met=met,
        bar=relative_bound(refined.results, number),
        error=abs(value - reference) / abs(value),
        reference_bound=bound / abs(value),
        cheapest=cheapest,
        cost=work / usable[cheapest].point_logs if met and cheapest is not None else None,
    )


def reference_of(solves: Sequence[GridSolve], number: str) -> tuple[float, float]:
    """Return the finest grid's number, without its edge's mean excess, and a bound of what is left.

    What is smooth - the peak of the parabola through the highest elements, friction without tau's share - is
    bounded by its change from the grid before. The parabola is the estimator's, on elements of half the size
    at most; against Hertz it is judged by the case ``accuracy/hertz-summits``.
    """
    before, finest = (one.result for one in solves[-2:])
    value = finest.numbers[number]
    if number == "max_pressure":
        return finest.peak.height, abs(finest.peak.height - before.peak.height)
    if number == "friction_coefficient":
        rest, rest_before = (
            r.numbers[number] - r.dmu_dA * r.numbers["contact_area"] for r in (finest, before)
        )
        bound = finest.dmu_dA * EDGE_SIZE_BOUND * finest.edge + abs(rest - rest_before)
        return value - finest.dmu_dA * finest.excess, bound
    area = finest.numbers["contact_area"]
    return area - finest.excess, EDGE_SIZE_BOUND * finest.edge
