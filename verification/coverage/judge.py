"""`accuracy=` replayed on stored grids: did the bar hold the error, how long was it, and what did it cost?"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from refimpl.accuracy.refinement import FIRST_GRIDS, longer_side, refine_until, relative_bound
from refimpl.model.friction import is_frictionless
from verification.coverage.scenes import random_scene
from verification.coverage.store import NUMBERS, Rung

EDGE_SIZE, EDGE_SIZE_BOUND = 0.79, 0.12
"""Of the edge in the reference: between what all grids of 200 training scenes gave by likelihood, 0.774, and
their mean from 512 to 1024, 0.80 +- 0.01 (measured by hand); and its scatter. A disc's is 0.75 (case
``accuracy/edge-size``)."""


@dataclass(frozen=True, kw_only=True)
class Held:
    """A bar, the true error, and what the reference of that may be wrong by, all in one unit."""

    bar: float
    error: float
    reference_bound: float

    @property
    def covered(self) -> bool:
        """True if the true error lies inside the bar."""
        return self.error <= self.bar

    @property
    def covered_at_worst(self) -> bool:
        """True if the bar covers a reference moved by its whole bound, in the unfavourable direction."""
        return self.error + self.reference_bound <= self.bar


@dataclass(frozen=True, kw_only=True)
class Verdict(Held):
    """One number of one scene at one accuracy; lengths are over the value.

    ``cheapest`` is the coarsest grid from which on every grid's error is
    within the accuracy, ``cost`` the transforms' ``n log n`` of all grids solved, each from the last one's
    answer, over that of the cheapest, solved afresh. (A third grid is counted as from the opening.)
    """

    seed: int
    kind: str
    number: str
    accuracy: float
    grids: tuple[int, ...]
    met: bool
    cheapest: int | None
    cost: float | None


def verdicts(ladders: Mapping[int, Sequence[Rung]], accuracy: float) -> list[Verdict]:
    """All numbers of all scenes whose ladder has a reference, which is its finest grid."""
    found = []
    for seed, rungs in ladders.items():
        kind = random_scene(seed).kind
        found += [_judged(rungs, kind, number, accuracy) for number in _numbers(seed)]
    return found


def _numbers(seed: int) -> tuple[str, ...]:
    """The numbers to judge: all, but for friction where there is none."""
    return NUMBERS[1:] if is_frictionless(random_scene(seed).scene.friction) else NUMBERS


def _judged(rungs: Sequence[Rung], kind: str, number: str, accuracy: float) -> Verdict:
    """A grid is asked for only if the reference is at least twice as fine."""
    reference, bound = reference_of(rungs, number)
    usable = {rung.M: rung for rung in rungs if 2 * rung.M <= rungs[-1].M}
    ladder = [M for M in usable if M not in FIRST_GRIDS]
    refined = refine_until(lambda M: usable[M].result, accuracy, number, ladder)
    value = refined.results[-1].numbers[number]
    grids = tuple(map(longer_side, refined.results))
    met = not refined.refusal
    candidates = (FIRST_GRIDS[-1], *ladder)
    errors = {M: _relative_error(usable[M], number, reference) for M in candidates}
    cheapest = next((M for M in errors if all(errors[N] <= accuracy for N in errors if N >= M)), None)
    work = usable[grids[0]].point_logs + sum(usable[M].carried or usable[M].point_logs for M in grids[1:])
    return Verdict(
        seed=rungs[0].seed,
        kind=kind,
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


def reference_of(rungs: Sequence[Rung], number: str) -> tuple[float, float]:
    """The finest grid's number, without its edge's mean share, and a bound of what is left.

    What is smooth - the peak of the parabola through the highest elements, friction without tau's share - is
    bounded by its change from the grid before. The parabola is the estimator's, on elements of half the size
    at most; against Hertz it is judged by the case ``accuracy/hertz-summits``.
    """
    before, finest = (rung.result for rung in rungs[-2:])
    value = finest.numbers[number]
    if number == "max_pressure":
        return finest.peak.height, abs(finest.peak.height - before.peak.height)
    if number == "friction_coefficient":
        rest, rest_before = (
            r.numbers[number] - r.dmu_dA * r.numbers["contact_area"] for r in (finest, before)
        )
        edge = finest.dmu_dA * finest.edge
        return value - EDGE_SIZE * edge, EDGE_SIZE_BOUND * edge + abs(rest - rest_before)
    area = finest.numbers["contact_area"]
    return area - EDGE_SIZE * finest.edge, EDGE_SIZE_BOUND * finest.edge


def moved(rungs: Sequence[Rung]) -> float:
    """Largest change of the reference on one more grid, the ladder's last, over both stated bounds."""
    shares = []
    for number in _numbers(rungs[0].seed):
        (coarse, loose), (fine, tight) = reference_of(rungs[:-1], number), reference_of(rungs, number)
        scale = np.finfo(float).eps * abs(fine)
        shares.append(abs(fine - coarse) / max(loose + tight, scale))
    return max(shares)


def _relative_error(rung: Rung, number: str, reference: float) -> float:
    return abs(rung.result.numbers[number] / reference - 1)


def summary(found: Iterable[Verdict]) -> dict[str, float | int | None]:
    """Shares and medians of verdicts on one number at one accuracy."""
    found = list(found)
    if not found:
        return {"scenes": 0}
    costs = [verdict.cost for verdict in found if verdict.cost is not None]
    met = [verdict for verdict in found if verdict.met]
    return {
        "scenes": len(found),
        "met": len(met) / len(found),
        "covered": sum(verdict.covered for verdict in found) / len(found),
        "covered_at_worst": sum(verdict.covered_at_worst for verdict in found) / len(found),
        "covered_where_met": sum(verdict.covered for verdict in met) / len(met) if met else None,
        "median_bar_over_error": bounded(np.median([ratio_of(v.bar, v.error) for v in found])),
        "median_cost": float(np.median(costs)) if costs else None,
        "cost_at_most_2": sum(cost <= 2 for cost in costs) / len(costs) if costs else None,
        "median_bar": bounded(np.median([verdict.bar for verdict in found])),
        "median_reference_bound_over_bar": float(
            np.median([ratio_of(v.reference_bound, v.bar) for v in found])
        ),
    }


def bounded(median: np.floating[Any]) -> float | None:
    """None where half of the bars have no end."""
    return float(median) if np.isfinite(median) else None


def ratio_of(over: float, under: float) -> float:
    """Finite, for a median: errors below rounding count as rounding."""
    return over / max(under, np.finfo(float).eps)
