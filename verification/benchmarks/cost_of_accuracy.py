"""Cost of an error in mu, A (both corrected) or p_max with friction and slopes, by class of scene.

``python -m verification.benchmarks.cost_of_accuracy --json FILE`` solves three realisations of each class,
``rough-friction tradeoff SCENE`` one scene. The error of a grid is that against a reference grid, whose own
error bar is added. A grid meets a demand where it and all finer ones do. The table has two such grids with
their seconds: that at which the error is met, which is known afterwards, and that at which the error bar
shows it, which is what ``accuracy=`` takes. Both are medians, given only where every realisation meets the
demand: one whose reference is itself uncertain by more meets it on no grid.
"""

from __future__ import annotations

import argparse
import itertools
import math
import statistics
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import refimpl as rf
from refimpl.solution.quantities import error_bound
from verification.benchmarks.problems import COPPER, FRICTION, SPHERE, STEEL
from verification.framework.case import jsonable
from verification.output.files import Progress
from verification.output.provenance import provenance
from verification.output.result_files import write_result
from verification.output.text_table import columns

GRIDS = (32, 48, 64, 96, 128, 192, 256, 384, 512, 768, 1024)
REFERENCE = 2048
DEMANDS = (0.1, 0.03, 0.01, 0.003)
QUANTITIES = ("friction_coefficient_corrected", "contact_area_corrected", "max_pressure")
SEEDS = (1, 2, 3)
SETTLED = (rf.Status.CONVERGED, rf.Status.CYCLED)
_SIDE, _LOAD, _PLANE_LOAD, _RMS = 1.61e-3, 70.0, 400.0, 0.5e-6  # m, N, N, m

_GAUSSIAN = partial(rf.GaussianRoughness, rms=_RMS)
_LAY = partial(_GAUSSIAN, correlation_length=(520e-6, 52e-6))  # m, along and across
_SELF_AFFINE = partial(
    rf.SelfAffineRoughness, hurst=0.8, rms=_RMS, roll_off=0.2e-3, long_cut=0.4e-3, short_cut=10e-6
)
LOWER: Mapping[str, Callable[..., rf.Surface]] = {
    "smooth ball": lambda seed: rf.Flat(),
    "ball on isotropic roughness": partial(_GAUSSIAN, correlation_length=104e-6),
    "ball, lay along sliding": partial(_LAY, lay=0.0),
    "ball, lay across sliding": partial(_LAY, lay=math.radians(90.0)),
    "ball, lay at 34 degrees": partial(_LAY, lay=math.radians(34.0)),
    "ball on self-affine roughness": _SELF_AFFINE,
    "periodic self-affine plane": _SELF_AFFINE,
}
"""Lower surface by class, a function of the ``seed``; sliding is along x."""


def class_scene(name: str, seed: int) -> rf.Scene:
    """Return a class's scene of a seed; seeds of the smooth ball widen it by thirds of an element."""
    periodic = "periodic" in name
    shift = (seed - 1) * _SIDE / GRIDS[0] / 3 if name == "smooth ball" else 0.0
    return rf.Scene(
        upper=rf.Body(STEEL, rf.Flat() if periodic else SPHERE),
        lower=rf.Body(COPPER, LOWER[name](seed=seed)),
        friction=FRICTION,
        load=_PLANE_LOAD if periodic else _LOAD,
        side=_SIDE + shift,
        periodic=periodic,
    )


def solve_grids(
    scene: rf.Scene, grids: Sequence[int] = GRIDS, reference: int = REFERENCE
) -> list[dict[str, Any]]:
    """Return a row a grid: work in transforms of 256 x 256, seconds, relative errors and error bars.

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


def costs(realisations: Sequence[Sequence[Mapping[str, Any]]], key: str = "errors") -> list[dict[str, Any]]:
    """Return the median cost of every demand of "errors" or "bars"; none where one realisation fails it."""
    rows = []
    for quantity, demand in itertools.product(realisations[0][0][key], DEMANDS):
        offers = [coarsest(grids, quantity, demand, key) for grids in realisations]
        row: dict[str, Any] = {"quantity": quantity, "error": demand}
        for cost in ("M", "transforms of 256", "seconds"):
            values = [offer[cost] for offer in offers if offer is not None]
            row[cost] = statistics.median(values) if len(values) == len(offers) else None
        rows.append(row)
    return rows


def table(classes: Sequence[Mapping[str, Any]]) -> str:
    """Return the printed table: elements per side and seconds by class, number and demand."""
    found = ["error met (known afterwards)", "error bar shows it (solve --accuracy)"]
    lines = [["scene", "number", "demand", *found]]
    for one in classes:
        for met, shown in zip(one["prices"], one["shown"], strict=True):
            lines.append([one["class"], met["quantity"], f"{met['error']:.1%}", _cell(met), _cell(shown)])
    return columns(lines, indent="")


def _cell(row: Mapping[str, Any]) -> str:
    return "finer" if row["M"] is None else f"{row['M']:.0f} ({row['seconds']:.2g} s)"


def main(arguments: Sequence[str] | None = None) -> None:
    """Solve all classes, write the document and print its table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", type=Path, required=True)
    options = parser.parse_args(arguments)
    progress = Progress(len(LOWER) * len(SEEDS))
    classes: list[dict[str, Any]] = []
    for name in LOWER:
        realisations = []
        for seed in SEEDS:
            realisations.append(solve_grids(class_scene(name, seed)))
            progress.tick(f"{name}, {seed}")
        prices, shown = costs(realisations), costs(realisations, "bars")
        classes.append({"class": name, "ladders": realisations, "prices": prices, "shown": shown})
    progress.close()
    write_result(jsonable({"provenance": provenance(), "classes": classes}), options.json)
    print(table(classes))


if __name__ == "__main__":
    main()
