"""Cost of an error in mu, A (both corrected) or p_max of one scene: ``rough-friction tradeoff SCENE``.

The error of a grid is that against a reference grid, whose own error bar is added. A grid meets a demand
where it and all finer ones do. The table has two such grids with their seconds: that at which the error is
met, which is known afterwards, and that at which the error bar shows it, which is what ``accuracy=`` takes.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from typing import Any

import refimpl as rf
from refimpl.solution.quantities import error_bound
from verification.output.text_table import columns

DEMANDS = (0.1, 0.03, 0.01, 0.003)
QUANTITIES = ("friction_coefficient_corrected", "contact_area_corrected", "max_pressure")
SETTLED = (rf.Status.CONVERGED, rf.Status.CYCLED)


def solve_grids(scene: rf.Scene, grids: Sequence[int], reference: int) -> list[dict[str, Any]]:
    """Return a row for each grid: work in transforms of 256 x 256 elements, seconds, relative errors and
    error bars.

    Both are of the numbers that are not zero, and infinite where the grid's state is not settled. Raises
    ArithmeticError where the reference is not.
    """
    exact = rf.solve(scene, grid=reference)
    if exact.status not in SETTLED:
        raise ArithmeticError(f"the reference on {reference} elements a side ends in '{exact.status.value}'")
    rows = []
    for M in grids:
        solution = rf.solve(scene, grid=M)
        work = solution.cost.point_logs / (256**2 * math.log2(256**2))
        row = {"M": M, "transforms of 256": work, "seconds": solution.cost.seconds}
        rows.append({**row, **_judged(solution, exact)})
    return rows


def _judged(solution: rf.Solution, exact: rf.Solution) -> dict[str, dict[str, float]]:
    found: dict[str, dict[str, float]] = {"errors": {}, "bars": {}}
    for name in QUANTITIES:
        number, known = getattr(solution, name), abs(getattr(exact, name))
        if not known:
            continue
        error = abs(number - getattr(exact, name)) + error_bound(exact, name)
        for key, length in (("errors", error), ("bars", error_bound(solution, name))):
            found[key][name] = length / known if solution.status in SETTLED else math.inf
    return found


def coarsest(
    rows: Sequence[Mapping[str, Any]], quantity: str, demand: float, key: str = "errors"
) -> Mapping[str, Any] | None:
    """Return the row of the coarsest grid that meets a demand together with all finer ones.

    >>> rows = [{"M": M, "errors": {"mu": e}} for M, e in ((32, 0.01), (64, 0.05), (128, 0.02))]
    >>> coarsest(rows, "mu", 0.03)["M"], coarsest(rows, "mu", 0.01)
    (128, None)
    """
    met = list(itertools.takewhile(lambda row: row[key][quantity] <= demand, reversed(rows)))
    return met[-1] if met else None


def costs(rows: Sequence[Mapping[str, Any]], key: str = "errors") -> list[dict[str, Any]]:
    """Return the cost of every demand on "errors", or on "bars"; none where no grid meets it."""
    found = []
    for quantity, demand in itertools.product(rows[0][key], DEMANDS):
        offer = coarsest(rows, quantity, demand, key) or {}
        cost = {name: offer.get(name) for name in ("M", "transforms of 256", "seconds")}
        found.append({"quantity": quantity, "error": demand, **cost})
    return found


def table(known: Sequence[Mapping[str, Any]], shown: Sequence[Mapping[str, Any]]) -> str:
    """Return the printed table: elements per side and seconds by number and demand."""
    lines = [
        ["number", "demand", "error met (known afterwards)", "error bar shows it (solve --accuracy)"],
        *(
            [met["quantity"], f"{met['error']:.1%}", _cell(met), _cell(bar)]
            for met, bar in zip(known, shown, strict=True)
        ),
    ]
    return columns(lines, indent="")


def _cell(row: Mapping[str, Any]) -> str:
    return "finer" if row["M"] is None else f"{row['M']:.0f} ({row['seconds']:.2g} s)"
