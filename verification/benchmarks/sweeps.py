"""Sweeps: seconds a run by number of workers, and what a neighbour's answer saves.

``python -m verification.benchmarks.sweeps --json FILE`` runs one study of loads and realisations in turns
with 1 and 2 workers, beside the same scenes solved one after another in this process. Then scenes are solved
from the answer of a neighbour on the same grid, and cold. Work is counted in transforms of the grid.
"""

from __future__ import annotations

import argparse
import math
import tempfile
import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from statistics import median
from typing import Any

import refimpl as rf
from refimpl.scene.scene_file import scene_from_dict, scene_to_dict
from verification.benchmarks.large import scene
from verification.benchmarks.problems import LOAD, SIDE
from verification.framework.case import jsonable
from verification.framework.files import Progress, write_result
from verification.framework.provenance import provenance
from verification.sweep.engine import sweep
from verification.sweep.study import Study

M = 256
LOADS = (10.0, 20.0, 40.0, 80.0)  # N
REALISATIONS, ROUNDS, WORKERS = 16, 3, (1, 2)
_ROUGH = "rough"


def study() -> Study:
    """Return the study: four loads on four realisations of a rough flat under a ball, with friction."""
    return Study(
        scene=scene_to_dict(scene(_ROUGH, "friction and slopes")),
        realisations=REALISATIONS,
        first_seed=1,
        normalise=None,
        vary={"grid": (M,), "load": LOADS},
        settings={},
    )


def swept(workers: int) -> dict[str, Any]:
    """Return the wall seconds a run of a sweep with a new store, its start included."""
    with tempfile.TemporaryDirectory() as folder:
        done = sweep(study(), Path(folder) / "runs.sqlite", workers=workers)
    runs = len(done.rows)
    return {
        "workers": workers,
        "runs": runs,
        "seconds a run": done.seconds / runs,
        "processor seconds of a solve": sum(done.solve_seconds) / runs,
    }


def one_after_another() -> dict[str, Any]:
    """Return the seconds a run of the same scenes in this process."""
    scenes = [run.inputs["scene"] for run in study().runs()]
    began = time.perf_counter()
    for one in scenes:
        rf.solve(scene_from_dict(one, Path()), grid=M)
    return {"workers": 0, "runs": len(scenes), "seconds a run": (time.perf_counter() - began) / len(scenes)}


NEIGHBOURS: dict[str, Callable[[rf.Scene], rf.Scene]] = {
    "load 10 % higher": lambda one: replace(one, load=1.1 * LOAD),
    "load 50 % higher": lambda one: replace(one, load=1.5 * LOAD),
    "tau 10 % higher": lambda one: replace(one, friction=replace(one.friction, tau=1.1 * one.friction.tau)),
    "slid by an element": lambda one: replace(one, sliding_offset=SIDE / M),
    "slid by eight elements": lambda one: replace(one, sliding_offset=8 * SIDE / M),
}


def neighbours(surface: str) -> list[dict[str, Any]]:
    """Return the work of solves from a neighbour's answer and of cold ones, and how far mu differs."""
    base = scene(surface, "friction and slopes")
    known = rf.solve(base, grid=M)
    rows = []
    for name, change in NEIGHBOURS.items():
        cold, warm = rf.solve(change(base), grid=M), rf.solve(change(base), grid=M, start=known)
        rows.append(
            {
                "surface": surface,
                "neighbour": name,
                "cold": _transforms(cold),
                "from the neighbour": _transforms(warm),
                "difference of mu": abs(warm.friction_coefficient / cold.friction_coefficient - 1),
            }
        )
    return rows


def _transforms(solution: rf.Solution) -> float:
    return solution.cost.point_logs / (M**2 * math.log2(M**2))


def main(arguments: Sequence[str] | None = None) -> None:
    """Measure and write the document."""
    parser = argparse.ArgumentParser(prog="python -m verification.benchmarks.sweeps", description=__doc__)
    parser.add_argument("--json", type=Path, required=True)
    options = parser.parse_args(arguments)
    progress = Progress(ROUNDS + 3)
    one_after_another()  # tables and plans of the first solve are nobody's seconds
    rounds: list[dict[str, Any]] = []
    for turn in range(ROUNDS):
        rounds += [one_after_another(), *(swept(workers) for workers in WORKERS)]
        progress.tick(f"round {turn + 1}")
    near = [row for surface in ("smooth", "rough", "self-affine") for row in neighbours(surface)]
    progress.close()
    found = {
        "provenance": provenance(),
        "grid": M,
        "rounds": rounds,
        "seconds a run": {
            str(workers): median(one["seconds a run"] for one in rounds if one["workers"] == workers)
            for workers in (0, *WORKERS)
        },
        "neighbours": near,
    }
    write_result(jsonable(found), options.json)
    for row in near:
        print({k: round(v, 3) if isinstance(v, float) and v > 1e-3 else v for k, v in row.items()})
    print(found["seconds a run"])


if __name__ == "__main__":
    main()
