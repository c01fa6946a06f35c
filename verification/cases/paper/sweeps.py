"""Sweeps: killed twenty times, on any number of workers and on a cluster, one table comes out."""

from __future__ import annotations

import random
import sqlite3
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

from verification.cases import Measured, Unavailable, case
from verification.sweep.engine import sweep
from verification.sweep.export import to_csv
from verification.sweep.study import Study
from verification.sweep.study_file import study_from_dict

COMMAND = (sys.executable, "-c", "from verification.cli import main; raise SystemExit(main())")
STUDY = """scene = "table1-rough"
realisations = 150
[vary]
grid = [24, 32]
lower_rms = [0.5e-6, 1.5e-6]
"""
KILLS = 20
MOST = 25  # runs that a killed sweep may add; 20 times this is less than the study's 600
CLAIM = "A sweep's table depends on its study alone: not on kills, workers or the cluster"


def _small(realisations: int) -> Study:
    table = {"scene": "table1-rough", "realisations": realisations}
    return study_from_dict(table | {"vary": {"grid": [24, 32], "lower_rms": [0.5e-6, 1.5e-6]}})


def _table(study: Study, store: Path, **how: Any) -> str:
    """The exported CSV; raises RuntimeError for a run that failed."""
    done = sweep(study, store, **how)
    if done.failures:
        raise RuntimeError(f"{len(done.failures)} runs failed: {next(iter(done.failures.values()))}")
    return to_csv(done.rows)


def _untimed(table: str) -> str:
    """A CSV without the seconds of its runs, its last column: they are no result."""
    heads, *rows = (line.rpartition(",") for line in table.splitlines())
    if not heads[-1].startswith("seconds"):
        raise ValueError(f"the last column is {heads[-1]}, not the runs' seconds")
    return "\n".join(head for head, _, _ in [heads, *rows]) + "\n"


def finished(store: Path) -> int:
    """Return the number of finished runs of a store; 0 before it has its table."""
    if not store.exists():
        return 0
    connection = sqlite3.connect(store)
    try:
        return int(connection.execute("select count(*) from runs").fetchone()[0])
    except sqlite3.OperationalError:
        return 0
    finally:
        connection.close()


def _wait_for(store: Path, number: int, running: subprocess.Popen[bytes]) -> None:
    """Until so many runs are kept; raises RuntimeError if the sweep ends before that."""
    while finished(store) < number:
        if running.poll() is not None:
            raise RuntimeError("the sweep ended before it was killed")
        time.sleep(0.01)


@case("sweep/killed-twenty-times", metric="equal", tolerance=0.0, tier="full", claim=CLAIM)
def killed() -> Measured:
    """A sweep killed twenty times against the undisturbed one.

    Source: this project's own claim
    Tolerance: lines of the exported CSV that differ: a run depends on its inputs only
    """
    moments = random.Random(20010101)
    kept: list[int] = []
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        (folder / "study.toml").write_text(STUDY, encoding="utf-8")
        command = [*COMMAND, "sweep", "study.toml", "--store", "s.sqlite", "--csv", "s.csv"]
        for _ in range(KILLS):
            running = subprocess.Popen(
                command, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
            )
            _wait_for(folder / "s.sqlite", (kept or [0])[-1] + moments.randint(0, MOST), running)
            time.sleep(moments.uniform(0.0, 0.05))
            running.kill()
            running.wait()
            kept.append(finished(folder / "s.sqlite"))
        subprocess.run(command, cwd=folder, check=True, capture_output=True)
        ours = _untimed((folder / "s.csv").read_text(encoding="utf-8")).splitlines()
        whole = _untimed(_table(_small(150), folder / "whole.sqlite", workers=2)).splitlines()
    if kept != sorted(kept) or not 0 < kept[-1] < len(whole) - 1:
        raise ArithmeticError(f"finished runs were lost, or the kills hit nothing: {kept}")
    differing = sum(a != b for a, b in zip(ours, whole, strict=False)) + abs(len(ours) - len(whole))
    return Measured(differing, 0, unit="lines", data={"runs kept": kept})


@case("sweep/workers", metric="equal", tolerance=0.0, tier="full", claim=CLAIM)
def workers() -> Measured:
    """One, two and three workers, and none.

    Source: this project's own claim
    Tolerance: different tables among them, less one
    """
    with tempfile.TemporaryDirectory() as folder:
        tables = {_table(_small(10), Path(folder) / f"{n}.sqlite", workers=n) for n in (0, 1, 2, 3)}
    return Measured(len(tables) - 1, 0)


@case("sweep/cluster", metric="equal", tolerance=0.0, tier="full", claim=CLAIM)
def cluster() -> Measured:
    """A dask.distributed cluster of two workers.

    Source: this project's own claim
    Tolerance: lines of the exported CSV that differ
    """
    try:
        import distributed

        start: Any = distributed.LocalCluster  # untyped
    except ModuleNotFoundError as missing:
        raise Unavailable("dask.distributed is not installed") from missing
    study = _small(10)
    with (
        tempfile.TemporaryDirectory() as folder,
        start(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None) as local,
    ):
        address = local.scheduler_address
        there = _table(study, Path(folder) / "c.sqlite", scheduler=address).splitlines()
        here = _table(study, Path(folder) / "h.sqlite", workers=0).splitlines()
    differing = sum(a != b for a, b in zip(there, here, strict=True))
    return Measured(differing, 0, unit="lines")
