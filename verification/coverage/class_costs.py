"""Cost of an accuracy by class of scene: ``python -m verification.coverage.class_costs --json FILE``.

A number is requested by ``accuracy=``, and the transforms' ``n log n`` of all grids solved are compared with
those of the cheapest grid that would have done, which is known only afterwards: the coarsest one from which
on the error is within the accuracy, against 512 elements along the longer side. Beside it stands what the
grids that open a refinement forecast, and the work of the last grid: for the corrected mu and the summed one.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Final

import numpy as np

import refimpl as rf
from refimpl.accuracy.refinement import GRID_SIZES
from refimpl.driver.options import Options
from refimpl.driver.refined import forecast
from refimpl.scene.discretise import Discretiser
from verification.coverage.class_scenes import (
    CLASSES,
    MEASURED,
    Kind,
    each,
    options,
    read_heights,
    scene,
    windows_of,
)
from verification.coverage.classes import reference
from verification.framework.case import jsonable
from verification.output.files import write_result
from verification.output.provenance import provenance
from verification.output.text_table import columns

CORRECTED: Final = "friction_coefficient_corrected"
SUMMED: Final = "friction_coefficient"
ASKED: dict[str, float] = {CORRECTED: 0.01, SUMMED: 0.01, "contact_area_corrected": 0.05}
REFERENCE = 512  # along the longer side
SIZES = [M for M in GRID_SIZES if M < REFERENCE]


def costs(one: rf.Scene, *, most: int = REFERENCE) -> list[dict[str, Any]]:
    """Return, for each number requested, the cost over that of the cheapest grid, and the forecast's grid.

    The cost is None where the accuracy was not reached, or no grid below the reference would have done.
    """
    finest = rf.solve(one, grid=REFERENCE)
    single = {M: rf.solve(one, grid=M) for M in SIZES}
    rows: list[dict[str, Any]] = []
    for name, accuracy in ASKED.items():
        exact, _ = reference(finest.details.features, name)
        fit = {M: abs(float(getattr(s, name)) - exact) <= accuracy * abs(exact) for M, s in single.items()}
        cheapest = next((M for M in SIZES if all(fit[N] for N in SIZES if N >= M)), None)
        asked, discretiser = Options(scene=one, accuracy=accuracy, quantity=name), Discretiser(one, None)
        expected = forecast(asked, asked.plan(discretiser), discretiser)
        refined = rf.solve(one, accuracy=accuracy, quantity=name, max_grid=most)
        met = refined.status is not rf.Status.ACCURACY_NOT_REACHED and refined.converged
        row: dict[str, Any] = {"number": name, "cheapest": cheapest, "met": met}
        row["last"] = last = max(refined.details.problem.grid.shape)
        row["work"] = rf.solve(one, grid=last).cost.point_logs if met else None
        row["cost"] = refined.cost.point_logs / single[cheapest].cost.point_logs if met and cheapest else None
        row["forecast"] = None if expected.refusal else max(expected.grid.shape)
        rows.append(row)
    return rows


def summary(rows: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """Return medians of cost, last grid's work and forecast over it, and shares: met, cost at most 2.

    An accuracy that is not met takes infinite work.
    """
    paid = [row["cost"] for row in rows if row["cost"] is not None]
    ratios = [row["forecast"] / row["last"] for row in rows if row["met"] and row["forecast"]]
    work = float(np.median([row["work"] or math.inf for row in rows]))
    return {
        "scenes": len(rows),
        "met": sum(row["met"] for row in rows) / len(rows),
        "compared": len(paid),
        "median_cost": float(np.median(paid)) if paid else None,
        "cost_at_most_2": sum(cost <= 2 for cost in paid) / len(paid) if paid else None,
        "median_work": work if math.isfinite(work) else None,
        "median_forecast_over_last": float(np.median(ratios)) if ratios else None,
        "forecast_within_2": sum(0.5 <= ratio <= 2 for ratio in ratios) / len(ratios) if ratios else None,
    }


def work_ratios(table: Iterable[Mapping[str, Any]]) -> dict[str, float]:
    """Return the work for the corrected mu over that for the summed one, by class that reaches both."""
    work = {(row["class"], row["number"]): row["median_work"] for row in table}
    return {
        kind: found / work[kind, SUMMED]
        for (kind, number), found in work.items()
        if number == CORRECTED and found and work[kind, SUMMED]
    }


def main(arguments: Sequence[str] | None = None) -> None:
    """Solve the scenes of all classes, write the document and print its table."""
    chosen = options("class_costs", __doc__, scenes=20).parse_args(arguments)
    classes: dict[str, Kind] = dict(CLASSES)
    if chosen.map is not None:
        classes |= {MEASURED: windows_of(read_heights(chosen.map))}
    rows = [
        {"class": kind, "seed": seed, **row}
        for kind, seed in each(classes, chosen.first, chosen.scenes)
        for row in costs(scene(kind, seed, classes))
    ]
    table = [
        {"class": kind, "number": name}
        | summary([row for row in rows if (row["class"], row["number"]) == (kind, name)])
        for name in ASKED
        for kind in classes
    ]
    document = {"first": chosen.first, "asked": ASKED, "table": table, "rows": rows}
    write_result(jsonable({"provenance": provenance(), **document}), chosen.json)
    print(columns(lines(table), indent=""))
    found = work_ratios(table)
    print(f"work for the corrected mu over the summed: {np.median(list(found.values())):.2f}, median of")
    print(", ".join(f"{kind} {ratio:.2f}" for kind, ratio in found.items()))


def lines(table: Sequence[Mapping[str, Any]]) -> list[list[str]]:
    """Return the lines of the printed table."""
    head = [name.replace("_", " ") for name in table[0]]
    return [head, *([_shown(value) for value in row.values()] for row in table)]


def _shown(value: Any) -> str:
    if value is None:
        return ""
    return f"{value:.2f}" if isinstance(value, float) else str(value)


if __name__ == "__main__":
    main()
