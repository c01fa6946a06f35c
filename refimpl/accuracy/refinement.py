"""Grids refined until the error bar of a chosen number is as short as asked for.

Two coarse grids open; the bar they give (`refimpl.accuracy.discretisation_error`) also foretells the bar of
finer grids, so that the next one is, as a rule, the last. All grids but the last together then cost a share
of it only.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal

from refimpl.accuracy.discretisation_error import discretisation, estimates
from refimpl.accuracy.grid_features import GridResult
from refimpl.accuracy.iteration_error import Uncertainty, merged
from refimpl.errors import InputError, require_number
from refimpl.model.state import Status
from refimpl.solution.remark import Remark
from refimpl.solution.solution import Cost, Solution

Quantity = Literal["friction_coefficient", "contact_area", "contact_area_corrected", "max_pressure"]
QUANTITIES: tuple[Quantity, ...] = (
    "friction_coefficient",
    "contact_area",
    "contact_area_corrected",
    "max_pressure",
)

OPENING = (32, 64)
LADDER = (*(quarter * 2**k for k in range(4, 10) for quarter in (5, 6, 7, 8)), 4096)
_FARTHEST = 8  # times finer than the last grid: what two coarse grids foretell beyond is worth little
_BLIND = 2  # the same where the bar is longer than the number, and foretells nothing
_MARGIN = 0.95  # share of the accuracy that a foretold bar may take
_ITERATION_SHARE = 1e-3  # share of the accuracy that unfinished iterations may take


def check_accuracy(accuracy: float) -> None:
    """Raise `InputError` unless the accuracy is relative."""
    require_number("accuracy", accuracy, "a relative accuracy between 0 and 1", above=0, below=1)


def check_quantity(quantity: str) -> None:
    """Raise `InputError` unless the quantity is one that an accuracy applies to."""
    if quantity not in QUANTITIES:
        raise InputError("quantity", quantity, f"one of {', '.join(QUANTITIES)}")


def deserved_tolerance(accuracy: float) -> float:
    """Certificate tolerance that an accuracy deserves: a small share of it, and no tighter than 1e-8.

    >>> deserved_tolerance(0.01)
    1e-05
    """
    return min(1e-5, max(1e-8, _ITERATION_SHARE * accuracy))


@dataclass(frozen=True)
class Climb:
    """The grids solved, coarse to fine; ``refusal`` says why a finer one was not to be had, if so."""

    results: tuple[GridResult, ...]
    refusal: str


def climb(
    result_at: Callable[[int], GridResult], accuracy: float, quantity: str, ladder: Iterable[int] = LADDER
) -> Climb:
    """Solve grid after grid until the bar of ``quantity`` is within ``accuracy`` times its value.

    A grid that ``result_at`` refuses by `InputError` (memory) is replaced by the next coarser one of
    the ladder, as long as that is finer than the last. What tau's support leaves open need not get less on
    finer grids: where it has not, and is more than the accuracy asked for, the climb ends.
    """
    results = [result_at(M) for M in OPENING]
    remaining, refusal = list(ladder), ""
    while results[-1].touching and relative_bar(results, quantity) > accuracy:
        if ambiguous(results, accuracy, quantity):
            return Climb(
                tuple(results), "tau's support leaves more than that open, and no less on finer grids"
            )
        remaining = [M for M in remaining if M > results[-1].M]
        if not remaining:
            return Climb(tuple(results), refusal or f"at most {results[-1].M} elements a side are tried")
        M = next_grid(results, accuracy, quantity, remaining)
        try:
            results.append(result_at(M))
        except InputError as refused:
            remaining, refusal = [grid for grid in remaining if grid < M], str(refused)
    return Climb(tuple(results), "")


def next_grid(results: Sequence[GridResult], accuracy: float, quantity: str, ladder: Sequence[int]) -> int:
    """The coarsest grid of the ladder whose bar is foretold to do, within reach of the last grid."""
    fine = results[-1]
    found = fine.numbers[quantity]
    estimate = estimates(results)[quantity]
    farthest = fine.M * (_FARTHEST if estimate.spread < abs(found) else _BLIND)
    reach = [grid for grid in ladder if grid <= farthest] or ladder[:1]
    own, order = _own(fine, quantity), _order(results, quantity)
    for M in reach:
        finer = fine.M / M
        bar = estimate.foretold(found, finer) + own * finer**order
        if bar <= _MARGIN * accuracy * abs(found):
            return M
    return reach[-1]


def _own(result: GridResult, quantity: str) -> float:
    """What a grid's own solution leaves open of a number."""
    return sum(result.parts.get(quantity, {}).values())


def _order(results: Sequence[GridResult], quantity: str) -> float:
    """The order at which that falls: as to the last grid climbed to, from none to the first."""
    coarse, fine = (_own(result, quantity) for result in results[-2:])
    if len(results) == len(OPENING) or not min(coarse, fine) > 0:
        return 1.0
    return min(max(math.log(coarse / fine) / math.log(results[-1].M / results[-2].M), 0.0), 1.0)


def ambiguous(results: Sequence[GridResult], accuracy: float, quantity: str) -> bool:
    """Whether tau's support leaves more than that open on a grid climbed to, and no less than before."""
    if len(results) == len(OPENING):
        return False
    coarse, fine = (result.parts.get(quantity, {}).get("tau support", 0.0) for result in results[-2:])
    return fine >= coarse and fine > accuracy * abs(results[-1].numbers[quantity])


def relative_bar(results: Sequence[GridResult], quantity: str) -> float:
    """The sum of the finest grid's parts over its value; infinite for a zero that is not exact."""
    value, bar = abs(results[-1].numbers[quantity]), sum(uncertainty(results)[quantity].values())
    if bar == 0:
        return 0.0
    return bar / value if value > 0 else float("inf")


def uncertainty(results: Sequence[GridResult]) -> Uncertainty:
    """All parts of the finest grid's numbers."""
    return merged(results[-1].parts, discretisation(results))


def refine(solve_at: Callable[[int], Solution], accuracy: float, quantity: Quantity) -> Solution:
    """The finest grid's solution of a climb, with its uncertainty and the summed cost.

    When finer grids do not fit into memory or exceed the ladder, the finest solved is returned as
    `ITERATION_LIMIT` with a warning that states the accuracy reached.
    """
    solved: list[Solution] = []

    def result_at(M: int) -> GridResult:
        solved.append(solve_at(M))
        return GridResult.of(solved[-1])

    climbed = climb(result_at, accuracy, quantity)
    fine = replace(solved[-1], cost=total_cost(solution.cost for solution in solved))
    if not climbed.results[-1].touching:
        return fine
    fine = replace(fine, uncertainty=uncertainty(climbed.results))
    if not climbed.refusal:
        return fine
    bar = relative_bar(climbed.results, quantity)
    known = f"known to {bar:.2g}, not" if math.isfinite(bar) else "not bounded, let alone"
    reached = Remark(f"{quantity} is {known} to {accuracy:.2g}: {climbed.refusal}")
    return replace(fine, status=Status.ITERATION_LIMIT, warnings=(*fine.warnings, reached))


def total_cost(costs: Iterable[Cost]) -> Cost:
    """What several solves cost together."""
    total = Cost(0.0, {}, 0.0, {})
    for cost in costs:
        total = Cost(
            seconds=total.seconds + cost.seconds,
            applications=_added(total.applications, cost.applications),
            point_logs=total.point_logs + cost.point_logs,
            iterations=_added(total.iterations, cost.iterations),
        )
    return total


def _added(first: Mapping[str, int], second: Mapping[str, int]) -> dict[str, int]:
    return {key: first.get(key, 0) + second.get(key, 0) for key in {**first, **second}}
