"""The work that solves take."""

from __future__ import annotations

from collections import Counter
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
    every, applications, iterations = list(costs), Counter[str](), Counter[str]()
    for cost in every:
        applications.update(cost.applications)
        iterations.update(cost.iterations)
    seconds, point_logs = sum(cost.seconds for cost in every), sum(cost.point_logs for cost in every)
    return Cost(seconds, dict(applications), point_logs, dict(iterations))
