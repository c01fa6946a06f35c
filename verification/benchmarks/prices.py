"""Cost of an error in mu, A or p_max with friction and slopes, by class of scene.

``python -m verification.benchmarks.prices --json FILE`` solves three realisations of each class. The error
of a grid is that against a reference of 2048 elements a side; a grid meets a demand where it and all finer
ones do. The table has that grid, its seconds and its work.
"""

from __future__ import annotations

import argparse
import math
import statistics
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import refimpl as rf
from verification.benchmarks.problems import COPPER, FRICTION, SPHERE, STEEL
from verification.cli.output import columns
from verification.framework.case import jsonable
from verification.framework.files import Progress, write_result
from verification.framework.provenance import provenance
from verification.tradeoff.prices import relative

GRIDS = (32, 48, 64, 96, 128, 192, 256, 384, 512, 768, 1024)
REFERENCE = 2048
DEMANDS = (0.1, 0.03, 0.01, 0.003)
QUANTITIES = ("friction_coefficient", "contact_area", "max_pressure")
SEEDS = (1, 2, 3)
_SIDE, _LOAD, _PLANE_LOAD, _RMS = 1.61e-3, 70.0, 400.0, 0.5e-6  # m, N, N, m


def _lay(angle: float) -> Callable[[int], rf.Surface]:
    return lambda seed: rf.GaussianRoughness(
        rms=_RMS, correlation_length=(520e-6, 52e-6), seed=seed, lay=math.radians(angle)
    )


def _self_affine(seed: int) -> rf.Surface:
    return rf.SelfAffineRoughness(
        hurst=0.8, rms=_RMS, roll_off=0.2e-3, long_cut=0.4e-3, short_cut=10e-6, seed=seed
    )


LOWER: Mapping[str, Callable[[int], rf.Surface]] = {
    "smooth ball": lambda seed: rf.Flat(),
    "ball on isotropic roughness": lambda seed: rf.GaussianRoughness(
        rms=_RMS, correlation_length=104e-6, seed=seed
    ),
    "ball, lay along sliding": _lay(0.0),
    "ball, lay across sliding": _lay(90.0),
    "ball, lay at 34 degrees": _lay(34.0),
    "ball on self-affine roughness": _self_affine,
    "periodic self-affine plane": _self_affine,
}
"""Lower surface by class and seed; sliding is along x."""


def scene(name: str, seed: int) -> rf.Scene:
    """Return a class's scene of a seed; seeds of the smooth ball widen it by thirds of an element."""
    periodic = "periodic" in name
    shift = (seed - 1) * _SIDE / GRIDS[0] / 3 if name == "smooth ball" else 0.0
    return rf.Scene(
        upper=rf.Body(STEEL, rf.Flat() if periodic else SPHERE),
        lower=rf.Body(COPPER, LOWER[name](seed)),
        friction=FRICTION,
        load=_PLANE_LOAD if periodic else _LOAD,
        side=_SIDE + shift,
        periodic=periodic,
    )


def ladder(of: rf.Scene) -> list[dict[str, Any]]:
    """Return the rows of all grids: work in transforms of 256 x 256 elements, seconds, relative errors."""
    solved = {M: rf.solve(of, grid=M) for M in (*GRIDS, REFERENCE)}
    numbers = {M: {name: float(getattr(s, name)) for name in QUANTITIES} for M, s in solved.items()}
    unit = 256**2 * math.log2(256**2)
    return [
        {
            "M": M,
            "transforms of 256": solved[M].cost.point_logs / unit,
            "seconds": solved[M].cost.seconds,
            "errors": relative(numbers[M], numbers[REFERENCE]),
        }
        for M in GRIDS
    ]


def price(rows: Sequence[Mapping[str, Any]], quantity: str, demand: float) -> Mapping[str, Any] | None:
    """Return the row of the coarsest grid that meets a demand together with all finer ones.

    >>> rows = [{"M": M, "errors": {"mu": e}} for M, e in ((32, 0.01), (64, 0.05), (128, 0.02))]
    >>> price(rows, "mu", 0.03)["M"], price(rows, "mu", 0.01)
    (128, None)
    """
    found = None
    for row in reversed(rows):
        if row["errors"][quantity] > demand:
            break
        found = row
    return found


def priced(ladders: Sequence[Sequence[Mapping[str, Any]]]) -> list[dict[str, Any]]:
    """Return the median cost of every demand over realisations; none where one of them meets it nowhere."""
    rows = []
    for quantity in QUANTITIES:
        for demand in DEMANDS:
            offers = [price(rows, quantity, demand) for rows in ladders]
            met = [offer for offer in offers if offer is not None]
            row: dict[str, Any] = {"quantity": quantity, "error": demand}
            for key in ("M", "transforms of 256", "seconds"):
                values = [offer[key] for offer in met]
                row[key] = statistics.median(values) if len(values) == len(offers) else None
            rows.append(row)
    return rows


def main(arguments: Sequence[str] | None = None) -> None:
    """Solve all classes, write the document and print its prices."""
    parser = argparse.ArgumentParser(prog="python -m verification.benchmarks.prices", description=__doc__)
    parser.add_argument("--json", type=Path, required=True)
    options = parser.parse_args(arguments)
    progress = Progress(len(LOWER) * len(SEEDS))
    classes: list[dict[str, Any]] = []
    for name in LOWER:
        ladders = []
        for seed in SEEDS:
            ladders.append(ladder(scene(name, seed)))
            progress.tick(f"{name}, {seed}")
        classes.append({"class": name, "ladders": ladders, "prices": priced(ladders)})
    progress.close()
    write_result(jsonable({"provenance": provenance(), "classes": classes}), options.json)
    print(columns(table(classes), indent=""))


def table(classes: Sequence[Mapping[str, Any]]) -> list[list[str]]:
    """Return the lines of the printed table: elements a side by demand, with seconds."""
    lines = [["class", "number", *(f"{demand:.1%}" for demand in DEMANDS)]]
    for one in classes:
        for quantity in QUANTITIES:
            offers = [row for row in one["prices"] if row["quantity"] == quantity]
            lines.append([one["class"], quantity, *map(_offer, offers)])
    return lines


def _offer(row: Mapping[str, Any]) -> str:
    return "finer" if row["M"] is None else f"{row['M']:.0f} ({row['seconds']:.2g} s)"


if __name__ == "__main__":
    main()
