"""Costs from runs: errors against the reference, Pareto front, cost-accuracy table, growth with size."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from verification.tradeoff.measure import Run

DEMANDS = (0.1, 0.03, 0.01, 0.003, 0.001)
SETTLED = ("converged", "cycled")
_GROWING = 1.0  # exponent with the elements per side; below it seconds are those of calls, not of elements


def relative(numbers: Mapping[str, float], reference: Mapping[str, float]) -> dict[str, float]:
    """Relative errors by quantity of ``reference``, which holds none that is zero.

    >>> relative({"contact_area": 3.0, "friction_coefficient": 0.0}, {"contact_area": 4.0})
    {'contact_area': 0.25}
    """
    return {name: abs(numbers[name] / number - 1) for name, number in reference.items()}


def front(runs: Sequence[Run], reference: Mapping[str, float], quantity: str) -> list[Run]:
    """The runs that no other beats in both time and error, cheapest first; only settled ones compete."""
    best, kept = math.inf, []
    for run in sorted((r for r in runs if r.status in SETTLED), key=lambda r: r.seconds):
        error = relative(run.numbers, reference)[quantity]
        if error < best:
            best = error
            kept.append(run)
    return kept


def price_list(
    runs: Sequence[Run], reference: Mapping[str, float], doubt: Mapping[str, float]
) -> list[dict[str, Any]]:
    """The cheapest way to every demanded error of the reference's quantities, None where no way got there.

    A way counts only if all finer grids of the same way meet the demand too: an error that is small by chance
    is no price. Demands below twice the reference's own ``doubt`` (relative, by quantity) have no answer.
    """
    rows = []
    for quantity in reference:
        for demand in DEMANDS:
            cheapest = None
            if demand >= 2 * doubt[quantity]:
                able = [r for r in runs if _reliably(r, runs, reference, quantity, demand)]
                cheapest = min(able, key=lambda r: r.seconds, default=None)
            rows.append({"quantity": quantity, "error": demand, **_offer(cheapest)})
    return rows


def growth(runs: Sequence[Run]) -> list[dict[str, Any]]:
    """Exponents p of time and memory ~ M^p by way, fitted over its grids, where there are three or more."""
    rows = []
    for way in dict.fromkeys(run.setting.way for run in runs):
        series = [run for run in runs if run.setting.way == way]
        if len(series) >= 3:
            M = np.log([run.setting.M for run in series])
            rows.append(
                {
                    "way": way,
                    "time": float(np.polyfit(M, np.log([run.seconds for run in series]), 1)[0]),
                    "memory": float(np.polyfit(M, np.log([run.peak_bytes for run in series]), 1)[0]),
                    "grids": [run.setting.M for run in series],
                }
            )
    return rows


def affordable(runs: Sequence[Run], way: str, seconds: float) -> int | None:
    """The largest grid on which a way takes no more than the given time, by its fitted growth.

    None for fewer than three grids, or where their time is overhead that hardly grows.
    """
    series = [run for run in runs if run.setting.way == way]
    if len(series) < 3:
        return None
    slope, offset = np.polyfit(
        np.log([run.setting.M for run in series]), np.log([run.seconds for run in series]), 1
    )
    return round(math.exp((math.log(seconds) - offset) / slope)) if slope >= _GROWING else None


def _reliably(
    run: Run, runs: Sequence[Run], reference: Mapping[str, float], quantity: str, demand: float
) -> bool:
    finer = [r for r in runs if r.setting.way == run.setting.way and r.setting.M >= run.setting.M]
    return all(r.status in SETTLED and relative(r.numbers, reference)[quantity] <= demand for r in finer)


def _offer(run: Run | None) -> dict[str, Any]:
    if run is None:
        return {"way": None, "M": None, "seconds": None, "convolutions": None}
    return {
        "way": run.setting.way,
        "M": run.setting.M,
        "seconds": run.seconds,
        "convolutions": run.convolutions,
    }
