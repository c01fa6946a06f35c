"""One run of the benchmark: who takes part on which grid, what was measured, and under which conditions."""

from __future__ import annotations

import math
import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from reports.result_files import read_result
from verification.benchmarks.codes import OWN, codes
from verification.benchmarks.rounds import (
    CERTIFIED,
    LOOSE,
    TARGET,
    Failed,
    Found,
    Turns,
    in_turns,
    solved,
    tuned,
)
from verification.benchmarks.summary import ratios, row
from verification.framework.case import jsonable
from verification.framework.files import Progress, write_result
from verification.framework.provenance import provenance

_GROWTH = 8.0  # seconds from one grid to the twice finer one: four times the elements, and more iterations


def measured(
    grids: Sequence[int], names: Sequence[str], kinds: Sequence[str], rounds: int, threads: int, limit: float
) -> dict[str, Any]:
    """One run: tolerances found for each code, then rounds; ready for JSON."""
    before = os.getloadavg()
    rows: list[object] = []
    found: list[dict[str, object]] = []
    progress = Progress(len(grids) * len(kinds))
    for kind in kinds:
        last: dict[str, Turns] = {}
        for M in sorted(grids):
            turns = [_tuned(name, kind, M, last.get(name), threads, limit) for name in names]
            in_turns(
                turns,
                rounds,
                lambda one: solved(one.code, one.kind, one.M, one.tolerance, threads, limit),
            )
            last = {one.code: one for one in turns}
            rows += [row(one) for one in turns]
            found.append({"kind": kind, "M": M, **ratios(turns)})
            progress.tick(f"{kind}, {M} x {M}")
    progress.close()
    conditions = {
        "rounds": rounds,
        "threads": threads,
        "limit (s)": limit,
        "load average": {"before": before, "after": os.getloadavg()},
        "target": f"relative gap {TARGET:g}, recomputed from the returned pressures",
        "versions": {name: codes()[name].version for name in names},
        "clock": "from heights to pressures, kernels and plans included; a solve at 64 x 64 comes first. "
        "Ours goes on to forces and error bars, but for the solver alone, which is timed as peers are",
    }
    return {"provenance": provenance(), "conditions": conditions, "rows": rows, "ratios": found}


def _tuned(name: str, kind: str, M: int, last: Turns | None, threads: int, limit: float) -> Turns:
    """The code with a tolerance of its own that meets the target; or why it takes no part on this grid."""
    ours = name.startswith(OWN)
    start = CERTIFIED if ours else (last.tolerance if last else LOOSE)
    turns = Turns(name, kind, M, start)
    if last is not None:
        if last.failure:
            turns.failure = f"not run after {last.M} x {last.M}: {last.failure}"
            return turns
        expected = _GROWTH ** math.log2(M / last.M) * min(found["seconds"] for found in last.rounds)
        if expected > limit:
            turns.failure = f"not run: {expected:.0f} s expected"
            return turns

    def solve(tolerance: float) -> Found:
        return solved(name, kind, M, tolerance, threads, limit)

    try:
        turns.tolerance, _ = tuned(solve, start, loosen=not ours)
    except Failed as failure:
        turns.failure = str(failure)
    return turns


def append(run: dict[str, object], file: Path) -> None:
    """Add a run at the end of the record; earlier ones stay as they are."""
    record = read_result(file) if file.is_file() else {"runs": []}
    record["runs"].append(jsonable(run))
    write_result(record, file)
