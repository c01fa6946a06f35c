"""Cost of an error in mu, A or p_max with friction and slopes, by class of scene.

``python -m verification.benchmarks.cost_of_accuracy --json FILE`` solves three realisations of each class,
``rough-friction tradeoff SCENE`` one scene. The error of a grid is that against a reference grid; a grid
meets a demand where it and all finer ones do. The table has that grid, its seconds and its work.
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
from verification.benchmarks.problems import COPPER, FRICTION, SPHERE, STEEL
from verification.framework.case import jsonable
from verification.output.files import Progress
from verification.output.provenance import provenance
from verification.output.result_files import write_result
from verification.output.text_table import columns

GRIDS = (32, 48, 64, 96, 128, 192, 256, 384, 512, 768, 1024)
REFERENCE = 2048
DEMANDS = (0.1, 0.03, 0.01, 0.003)
QUANTITIES = ("friction_coefficient", "contact_area", "max_pressure")
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
    """Return a row for each grid: work in transforms of 256 x 256 elements, seconds, relative errors.

    Errors are of the numbers that are not zero, and infinite where the grid's state is not settled. Raises
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
        rows.append({**row, "errors": _errors(solution, exact)})
    return rows


def _errors(solution: rf.Solution, exact: rf.Solution) -> dict[str, float]:
    settled = solution.status in SETTLED
    numbers = {name: (getattr(solution, name), getattr(exact, name)) for name in QUANTITIES}
    return {name: abs(a / b - 1) if settled else math.inf for name, (a, b) in numbers.items() if b}


def coarsest(rows: Sequence[Mapping[str, Any]], quantity: str, demand: float) -> Mapping[str, Any] | None:
    """Return the row of the coarsest grid that meets a demand together with all finer ones.

    >>> rows = [{"M": M, "errors": {"mu": e}} for M, e in ((32, 0.01), (64, 0.05), (128, 0.02))]
    >>> coarsest(rows, "mu", 0.03)["M"], coarsest(rows, "mu", 0.01)
    (128, None)
    """
    met = list(itertools.takewhile(lambda row: row["errors"][quantity] <= demand, reversed(rows)))
    return met[-1] if met else None


def costs(realisations: Sequence[Sequence[Mapping[str, Any]]]) -> list[dict[str, Any]]:
    """Return the median cost of every demand over realisations; none where one of them meets it nowhere."""
    rows = []
    for quantity, demand in itertools.product(realisations[0][0]["errors"], DEMANDS):
        offers = [coarsest(grids, quantity, demand) for grids in realisations]
        row: dict[str, Any] = {"quantity": quantity, "error": demand}
        for key in ("M", "transforms of 256", "seconds"):
            values = [offer[key] for offer in offers if offer is not None]
            row[key] = statistics.median(values) if len(values) == len(offers) else None
        rows.append(row)
    return rows


def table(classes: Sequence[Mapping[str, Any]]) -> str:
    """Return the printed table: elements a side and seconds by class, number and demand."""
    lines = [["scene", "number", *(f"{demand:.1%}" for demand in DEMANDS)]]
    for one in classes:
        for quantity, offers in itertools.groupby(one["prices"], lambda row: row["quantity"]):
            lines.append([one["class"], quantity, *map(_cell, offers)])
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
        classes.append({"class": name, "ladders": realisations, "prices": costs(realisations)})
    progress.close()
    write_result(jsonable({"provenance": provenance(), "classes": classes}), options.json)
    print(table(classes))


if __name__ == "__main__":
    main()
