"""The work that solves take."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass


@dataclass(frozen=True)
class Cost:
    """Work done: seconds, operator applications by kind, their ``n log2 n`` sum, iterations by loop."""

    seconds: float
    applications: Mapping[str, int]
    point_logs: float
    iterations: Mapping[str, int]


def total_cost(costs: Iterable[Cost]) -> Cost:
    """Return the cost of several solves together."""
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
