"""``python -m verification.benchmarks``: measure in turns, append the runs to a record and print them."""

from __future__ import annotations

import argparse
import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from verification.benchmarks import rounds
from verification.benchmarks.codes import codes
from verification.benchmarks.problems import FLATS
from verification.benchmarks.summary import lines, ratios, row
from verification.framework.case import jsonable
from verification.output.files import Progress
from verification.output.provenance import provenance
from verification.output.result_files import read_result, write_result
from verification.output.text_table import columns

CLOCK = (
    "from heights to pressures, kernels and plans included; a solve at 64 x 64 comes first. "
    "Ours goes on to forces and error bars, but for the solver alone, which is timed as peers are"
)


def main(arguments: Sequence[str] | None = None) -> None:
    """Measure, append and print: on one thread last, whose seconds the report shows."""
    parser = argparse.ArgumentParser(prog="python -m verification.benchmarks", description=__doc__)
    installed = [code.name for code in codes().values() if code.version is not None]
    parser.add_argument("--grids", nargs="+", type=int, default=[128, 256, 512], help="elements per side")
    parser.add_argument("--codes", nargs="+", choices=installed, default=installed)
    parser.add_argument("--kinds", nargs="+", choices=list(FLATS), default=list(FLATS))
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--threads", type=int, nargs="*", default=[1], help="for every code alike")
    parser.add_argument("--limit", type=float, default=600.0, help="seconds for one solve")
    parser.add_argument("--json", type=Path, required=True, help="record to append the run to")
    options = parser.parse_args(arguments)
    for threads in sorted(options.threads, reverse=True):
        run = measured(options.grids, options.codes, options.kinds, options.rounds, threads, options.limit)
        append(run, options.json)
        print(columns(lines(run["rows"], run["ratios"]), indent=""))


def measured(
    grids: Sequence[int], names: Sequence[str], kinds: Sequence[str], count: int, threads: int, limit: float
) -> dict[str, Any]:
    """Measure one run: tolerances found for each code, then ``count`` rounds; ready for JSON."""
    before = os.getloadavg()
    rows: list[object] = []
    found: list[dict[str, object]] = []
    progress = Progress(len(grids) * len(kinds))
    for kind in kinds:
        last: dict[str, rounds.Turns] = {}
        for M in sorted(grids):
            turns = [rounds.tuned_turns(name, kind, M, last.get(name), threads, limit) for name in names]
            rounds.in_turns(turns, count, lambda one: one.solve(one.tolerance, threads, limit))
            last = {one.code: one for one in turns}
            rows += [row(one) for one in turns]
            found.append({"kind": kind, "M": M, **ratios(turns)})
            progress.tick(f"{kind}, {M} x {M}")
    progress.close()
    conditions = {
        "rounds": count,
        "threads": threads,
        "limit (s)": limit,
        "load average": {"before": before, "after": os.getloadavg()},
        "target": f"relative gap {rounds.TARGET:g}, recomputed from the returned pressures",
        "versions": {name: codes()[name].version for name in names},
        "clock": CLOCK,
    }
    return {"provenance": provenance(), "conditions": conditions, "rows": rows, "ratios": found}


def append(run: dict[str, object], file: Path) -> None:
    """Add a run at the end of the record; earlier ones stay as they are."""
    record = read_result(file) if file.is_file() else {"runs": []}
    record["runs"].append(jsonable(run))
    write_result(record, file)


if __name__ == "__main__":
    main()
