"""Solved refinements, one JSON line per scene and grid, so that a killed study goes on where it was."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterable, Iterator
from dataclasses import asdict, dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import refimpl as rf
from refimpl.accuracy.grid_features import GridFeatures
from refimpl.accuracy.peak import Peak
from refimpl.accuracy.refinement import FIRST_GRIDS, longer_side
from refimpl.grid.straight_edges import StraightEdges
from refimpl.model.friction import FrictionLaw, is_frictionless
from verification.coverage.scenes import random_scene
from verification.output.files import Progress, appending

NUMBERS = ("friction_coefficient", "contact_area", "contact_area_corrected", "max_pressure")
FINEST = 512  # elements per side that may be requested; beyond are references
TOLERANCE = 1e-6
"""Certificate of every solve: as for ``accuracy=0.001``, tighter than for 0.01."""


@dataclass(frozen=True)
class GridSolve:
    """One scene on one grid: its numbers, its status, its worst residual and what it cost.

    ``carried`` is the cost where the grid starts from the opening's answer, as in a refinement sequence;
    ``apart`` how far its `NUMBERS` then lie from those found afresh, over their values.
    """

    seed: int
    result: GridFeatures
    status: str
    worst: float
    point_logs: float
    seconds: float
    carried: float | None = None
    apart: float | None = None

    @property
    def M(self) -> int:
        """Elements per side."""
        return longer_side(self.result)


Solve = Callable[[int, int], GridSolve]
"""Solve of a seed's scene on M x M elements."""


def refine(path: Path, seeds: Iterable[int], grids: Iterable[int], solve: Solve | None = None) -> None:
    """Solve what the store has not yet; each finished solve is appended at once."""
    solve = solve or _solved
    seeds, grids = list(seeds), list(grids)
    known = {(one.seed, one.M) for one in grid_solves(path)}
    todo = [(seed, M) for seed in seeds for M in grids if (seed, M) not in known]
    progress = Progress(len(todo))
    with appending(path) as lines:
        for seed, M in todo:
            lines.write(json.dumps(asdict(solve(seed, M)), allow_nan=False) + "\n")
            lines.flush()
            progress.tick(f"scene {seed} on {M} x {M}")
    progress.close()


def grid_solves(path: Path) -> Iterator[GridSolve]:
    """Yield everything in the store; a last line cut short by a kill is skipped, and solved again."""
    if not path.exists():
        return
    for line in path.read_text(encoding="utf-8").splitlines():
        try:
            record = json.loads(line)
        except json.JSONDecodeError:
            continue
        yield GridSolve(**{**record, "result": features_of(record["result"])})


def features_of(record: dict[str, Any]) -> GridFeatures:
    """Return the features that `dataclasses.asdict` made plain."""
    peaks = {name: Peak(**record[name]) for name in ("peak", "first_contact")}
    straight = {name: StraightEdges(**record[name]) for name in ("straight", "plastic_straight")}
    tuples = {name: tuple(record[name]) for name in ("faces", "highest_areas")}
    grid = record["grid"]
    restored = rf.Grid(tuple(grid["shape"]), tuple(grid["lengths"]), grid["periodic"])
    return GridFeatures(**{**record, **peaks, **straight, **tuples, "grid": restored})


def refinements(path: Path) -> dict[int, list[GridSolve]]:
    """Return the store's scenes by seed, coarse to fine."""
    found: dict[int, list[GridSolve]] = {}
    for one in grid_solves(path):
        found.setdefault(one.seed, []).append(one)
    return {seed: sorted(found[seed], key=lambda one: one.M) for seed in sorted(found)}


def _solved(seed: int, M: int) -> GridSolve:
    started = time.process_time()
    solution = rf.solve(random_scene(seed).scene, M, tolerance=TOLERANCE)
    seconds = time.process_time() - started
    begun = _begun(seed, M)
    return GridSolve(
        seed=seed,
        result=solution.details.features,
        status=solution.status.value,
        worst=solution.certificate.largest,
        point_logs=solution.cost.point_logs,
        seconds=seconds,
        carried=begun.cost.point_logs if begun else None,
        apart=_apart(begun, solution) if begun else None,
    )


def _begun(seed: int, M: int) -> rf.Solution | None:
    """Return the solution from the opening's answer, if a refinement asks for it and the opening has
    converged."""
    coarser = [grid for grid in FIRST_GRIDS if grid < M <= FINEST]
    start = _opened(seed, coarser[-1]) if coarser else None
    if start is None or not start.converged:
        return None
    return rf.solve(random_scene(seed).scene, M, tolerance=TOLERANCE, start=start)


@lru_cache(maxsize=len(FIRST_GRIDS))
def _opened(seed: int, M: int) -> rf.Solution:
    return _begun(seed, M) or rf.solve(random_scene(seed).scene, M, tolerance=TOLERANCE)


def _apart(one: rf.Solution, other: rf.Solution) -> float:
    """Return the largest relative difference of the numbers to be judged."""
    names = judged_numbers(one.details.friction)
    return max(abs(float(getattr(one, name)) / float(getattr(other, name)) - 1) for name in names)


def judged_numbers(friction: FrictionLaw) -> tuple[str, ...]:
    """Return the names of the numbers to judge: not mu without friction, where it is rounding."""
    return NUMBERS[1:] if is_frictionless(friction) else NUMBERS
