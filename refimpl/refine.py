"""Grids refined until the error bar of a chosen number is as short as asked for."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Literal

from refimpl.errors import InputError, require_number
from refimpl.outcome import Status
from refimpl.solution import Cost, Solution
from refimpl.uncertainty import iteration_parts, merged, two_grids

Quantity = Literal["friction_coefficient", "contact_area", "max_pressure"]
QUANTITIES: tuple[Quantity, ...] = ("friction_coefficient", "contact_area", "max_pressure")

_COARSEST, _FINEST = 64, 4096
_ITERATION_SHARE = 1e-3  # share of the accuracy that unfinished iterations may take


def check_accuracy(accuracy: float, quantity: str) -> None:
    """Raise `InputError` unless the accuracy is relative and the quantity is one that it applies to."""
    require_number("accuracy", accuracy, "a relative accuracy between 0 and 1", above=0, below=1)
    if quantity not in QUANTITIES:
        raise InputError("quantity", quantity, f"one of {', '.join(QUANTITIES)}")


def deserved_tolerance(accuracy: float) -> float:
    """Certificate tolerance that an accuracy deserves: a small share of it, and no tighter than 1e-8.

    >>> deserved_tolerance(0.01)
    1e-05
    """
    return min(1e-5, max(1e-8, _ITERATION_SHARE * accuracy))


def refine(solve_at: Callable[[int], Solution], accuracy: float, quantity: Quantity) -> Solution:
    """Solve on doubled grids until the bar of ``quantity`` is within ``accuracy`` times its value.

    The solution is the finest grid's, with its uncertainty and the summed cost. When the next grid
    does not fit into memory or exceeds 4096, the best so far is returned as `ITERATION_LIMIT` with a
    warning that states the accuracy reached.
    """
    coarse = solve_at(_COARSEST)
    fine, M = _compared(coarse, solve_at(2 * _COARSEST)), 2 * _COARSEST
    while fine.status is not Status.NO_CONTACT and _bar(fine, quantity) > accuracy:
        M *= 2
        try:
            if M > _FINEST:
                raise InputError("grid", M, f"at most {_FINEST}")
            finer = solve_at(M)
        except InputError as refusal:
            reached = f"{quantity} is known to {_bar(fine, quantity):.2g}, not to {accuracy:.2g}: {refusal}"
            return replace(fine, status=Status.ITERATION_LIMIT, warnings=(*fine.warnings, reached))
        fine = _compared(fine, finer)
    return fine


def _compared(coarse: Solution, fine: Solution) -> Solution:
    """The fine solution with its error bar from both grids and the cost of both."""
    parts = merged(iteration_parts(fine), fine.uncertainty, two_grids(coarse, fine))
    cost = Cost(
        seconds=coarse.cost.seconds + fine.cost.seconds,
        applications=_added(coarse.cost.applications, fine.cost.applications),
        point_logs=coarse.cost.point_logs + fine.cost.point_logs,
        iterations=_added(coarse.cost.iterations, fine.cost.iterations),
    )
    return replace(fine, uncertainty=parts, cost=cost)


def _bar(solution: Solution, quantity: Quantity) -> float:
    """Relative error bar: the sum of the parts over the value; infinite for a value of zero."""
    value = abs(getattr(solution, quantity))
    return sum(solution.uncertainty[quantity].values()) / value if value > 0 else float("inf")


def _added(first: Mapping[str, int], second: Mapping[str, int]) -> dict[str, int]:
    return {key: first.get(key, 0) + second.get(key, 0) for key in {**first, **second}}
