"""Solved ladders of grids, one JSON line per scene and grid, so that a killed study goes on where it was."""

from __future__ import annotations

import json
import time
from collections.abc import Iterable, Iterator
from dataclasses import asdict, dataclass
from pathlib import Path

import refimpl as rf
from refimpl.grid_result import GridResult
from verification.coverage.scenes import random_scene
from verification.files import Progress

TOLERANCE = 1e-6
"""Certificate of every solve: what ``accuracy=0.001`` deserves, and tighter than 0.01 does."""


@dataclass(frozen=True)
class Rung:
    """One scene on one grid: its numbers, its status, its worst residual and what it cost."""

    seed: int
    result: GridResult
    status: str
    worst: float
    point_logs: float
    seconds: float


def climb(path: Path, seeds: Iterable[int], grids: Iterable[int]) -> None:
    """Solve what the store has not yet; each finished solve is appended at once."""
    seeds, grids = list(seeds), list(grids)
    known = {(rung.seed, rung.result.M) for rung in rungs(path)}
    todo = [(seed, M) for seed in seeds for M in grids if (seed, M) not in known]
    progress = Progress(len(todo))
    cut = path.exists() and not path.read_bytes().endswith(b"\n")
    with path.open("a", encoding="utf-8") as lines:
        if cut:  # by a kill: what follows must not join it
            lines.write("\n")
        for seed, M in todo:
            lines.write(json.dumps(asdict(_solved(seed, M)), allow_nan=False) + "\n")
            lines.flush()
            progress.tick(f"scene {seed} on {M} x {M}")
    progress.close()


def rungs(path: Path) -> Iterator[Rung]:
    """Everything in the store; a last line cut short by a kill is left out, and solved again."""
    if not path.exists():
        return
    for line in path.read_text(encoding="utf-8").splitlines():
        try:
            record = json.loads(line)
        except json.JSONDecodeError:
            continue
        yield Rung(**{**record, "result": GridResult(**record["result"])})


def ladders(path: Path) -> dict[int, list[Rung]]:
    """The store's scenes by seed, coarse to fine."""
    found: dict[int, list[Rung]] = {}
    for rung in rungs(path):
        found.setdefault(rung.seed, []).append(rung)
    return {seed: sorted(found[seed], key=lambda rung: rung.result.M) for seed in sorted(found)}


def _solved(seed: int, M: int) -> Rung:
    started = time.process_time()
    solution = rf.solve(random_scene(seed).scene, M, tolerance=TOLERANCE)
    return Rung(
        seed=seed,
        result=GridResult.of(solution),
        status=solution.status.value,
        worst=solution.certificate.worst,
        point_logs=solution.cost.point_logs,
        seconds=time.process_time() - started,
    )
