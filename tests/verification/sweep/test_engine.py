"""Sweeps: each run is kept once, whatever is killed and however many workers; failed runs are tried again."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path
from typing import Any

import psutil
import pytest

from refimpl.errors import InputError
from tests.verification.cli.children import Ended, finished, one_line, running, started, until
from tests.verification.cli.commands import refused, shown
from tests.verification.sweep.own_cluster import cluster
from verification.framework.threads import THREADS, limited_to_one_thread
from verification.sweep import engine
from verification.sweep.export import to_csv
from verification.sweep.run import Run, execute
from verification.sweep.store import open_store
from verification.sweep.study import Study
from verification.sweep.study_file import read_study, study_from_dict

STUDY = """scene = "table1-rough"
realisations = 10
[vary]
grid = [12, 16]
lower_rms = [0.5e-6, 1.5e-6]
"""


def small(realisations: int = 2, grid: tuple[int, ...] = (12, 16)) -> Study:
    return study_from_dict(
        {"scene": "table1-rough", "realisations": realisations, "vary": {"grid": list(grid)}}
    )


def test_a_run_is_solved_once_and_a_larger_study_adds_to_the_store(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    store = tmp_path / "s.sqlite"
    first = engine.sweep(small(1), store, workers=0)
    assert (first.found, first.finished, first.failures) == (0, 2, {})
    assert engine.sweep(small(3), store, workers=0).found == 2
    monkeypatch.setattr(engine, "execute", None)
    again = engine.sweep(small(1), store, workers=0)  # the store holds six
    assert (len(again.rows), again.found, again.finished) == (2, 2, 0)
    assert to_csv(again.rows) == to_csv(first.rows)


def test_a_point_without_roughness_is_one_run_of_all_its_realisations(tmp_path: Path) -> None:
    axes = {"grid": [8], "upper_rms": [0.0], "lower_rms": [0.0, 1e-6], "correlation_length": [1e-4, 2e-4]}
    study = study_from_dict({"scene": "table1-rough", "realisations": 2, "vary": axes})
    done = engine.sweep(study, tmp_path / "s.sqlite", workers=0)
    assert (done.found, done.finished) == (0, 1 + 2 * 2)
    assert [row["lower_rms"] for row in done.rows] == [0.0, 1e-6, 1e-6, 1e-6, 1e-6]


def test_failed_runs_are_named_not_kept_and_tried_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    seen = list[engine.Progress]()

    def failing(inputs: Any) -> Any:
        if inputs["grid"] == 16:
            raise ArithmeticError("no solution")
        return execute(inputs)

    monkeypatch.setattr(engine, "execute", failing)
    done = engine.sweep(small(), tmp_path / "s.sqlite", workers=0, tick=seen.append)
    assert (done.found, done.finished, len(done.failures)) == (0, 2, 2)
    assert set(done.failures.values()) == {"ArithmeticError: no solution"}
    assert [row["grid"] for row in done.rows] == [12, 12]
    assert all(row["seconds"] > 0 for row in done.rows)
    assert [p.done + p.failed for p in seen] == [0, 1, 2, 3, 4]
    assert all(p.total == 4 for p in seen)
    assert (seen[-1].done, seen[-1].failed) == (2, 2)
    assert (seen[0].seconds_left, seen[-1].seconds_left) == (None, 0.0)
    assert all((p.seconds_left or 0.0) > 0.0 for p in seen[1:-1])
    monkeypatch.undo()
    mended = engine.sweep(small(), tmp_path / "s.sqlite", workers=0)
    assert (mended.found, mended.finished, mended.failures) == (2, 2, {})


@pytest.mark.parametrize("kept", [0, 1])
def test_a_refusal_leaves_the_store(tmp_path: Path, kept: int) -> None:
    path, study = tmp_path / "s.sqlite", small(1, (12,))

    def refused_after(runs: list[Run]) -> None:
        with open_store(path) as store:
            for run in runs:
                store.add(run, execute(run.inputs))
            raise InputError("anything", 1, "something else")

    with pytest.raises(InputError, match="anything"):
        refused_after(list(study.runs())[:kept])
    assert sorted(file.name for file in tmp_path.iterdir()) == ["s.sqlite"]
    assert engine.sweep(study, path, workers=0).found == kept
    with pytest.raises(InputError, match="anything"):
        refused_after([])
    assert engine.sweep(study, path, workers=0).found == 1


# --- kills ---


def test_the_killed_command_leaves_no_workers_and_resumes(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(STUDY)
    killed = started(["sweep", "study.toml", "--store", "s.sqlite"], tmp_path)
    until(60, "three runs are kept", lambda: finished(tmp_path / "s.sqlite") >= 3)
    workers = [child.pid for child in psutil.Process(killed.pid).children()]
    killed.send_signal(signal.SIGKILL)
    killed.communicate()
    assert len(workers) >= 2
    until(60, "the workers ended", lambda: not any(map(running, workers)))
    kept = finished(tmp_path / "s.sqlite")
    assert 3 <= kept < 40
    study = read_study(tmp_path / "study.toml")
    again = engine.sweep(study, tmp_path / "s.sqlite", workers=0)
    assert again.found == kept
    undisturbed = engine.sweep(study, tmp_path / "other.sqlite", workers=0)
    assert numbers(to_csv(again.rows)) == numbers(to_csv(undisturbed.rows))


def numbers(table: str) -> list[str]:
    """Lines of a CSV without its last column, the seconds: all else is the same however often it is run."""
    return [line.rpartition(",")[0] for line in table.splitlines()]


def killed(_: object) -> None:
    """In a worker: what the system does to it when memory runs out."""
    os.kill(os.getpid(), signal.SIGKILL)


def test_a_dead_worker_stops_the_sweep(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(engine, "execute", killed)
    with pytest.raises(engine.WorkersLost):
        engine.sweep(small(1), tmp_path / "d.sqlite", workers=1)


# --- clusters ---


def test_a_cluster_gives_the_same_bytes(tmp_path: Path) -> None:
    """Its worker was not limited to one thread: its BLAS has as many as there are cores."""
    (tmp_path / "study.toml").write_text(STUDY.replace("10", "1") + '[solve]\nmethod = "dense"\n')
    study = f"{tmp_path}/study.toml"
    with cluster(tmp_path, {"OMP_NUM_THREADS": "3"}, drop=THREADS) as (address, _):
        tail = f"--store {tmp_path}/c.sqlite --csv {tmp_path}/c.csv"
        assert "finished now        4" in shown(f"sweep {study} --scheduler {address} {tail}")
    here = engine.sweep(read_study(study), tmp_path / "h.sqlite", workers=0)
    assert numbers((tmp_path / "c.csv").read_text()) == numbers(to_csv(here.rows))


@pytest.mark.parametrize("address", ["tcp://127.0.0.1:9", "nonsense://x"])
def test_a_scheduler_that_is_not_there(address: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(engine, "CONNECT_SECONDS", 0.5)
    (tmp_path / "study.toml").write_text(STUDY)
    refused(f"sweep {tmp_path}/study.toml --scheduler {address} --store {tmp_path}/s.sqlite", "--scheduler")
    assert [path.name for path in tmp_path.iterdir()] == ["study.toml"]


@pytest.mark.nightly
def test_a_lost_scheduler_is_one_line_and_the_sweep_goes_on_later(tmp_path: Path) -> None:
    """Of 400 runs two are finished when it is killed."""
    (tmp_path / "study.toml").write_text('scene = "table1-rough"\nrealisations = 400\n[vary]\ngrid = [12]\n')
    with cluster(tmp_path, {"OMP_NUM_THREADS": "1"}, drop=THREADS) as (address, scheduler):
        tail = ["sweep", "study.toml", "--store", "s.sqlite", "--scheduler", address]
        child = started(tail, tmp_path)
        until(60, "two runs are kept", lambda: finished(tmp_path / "s.sqlite") >= 2)
        scheduler.kill()
        _, err = child.communicate(timeout=120)
    one_line(Ended(child.returncode, err), "the scheduler")
    kept = finished(tmp_path / "s.sqlite")
    assert 2 <= kept < 400
    again = engine.sweep(small(kept, (12,)), tmp_path / "s.sqlite", workers=0)
    assert (again.found, len(again.rows)) == (kept, kept)


LIMITED = """
import numpy, scipy.linalg, threadpoolctl, refimpl
from refimpl.operators.threads import allowed_threads
from verification.framework.threads import limited_to_one_thread
before = max(pool["num_threads"] for pool in threadpoolctl.threadpool_info())
with limited_to_one_thread():
    print(before, allowed_threads(), {pool["num_threads"] for pool in threadpoolctl.threadpool_info()})
"""


def test_threads_are_limited_after_the_import() -> None:
    many = {k: v for k, v in os.environ.items() if k not in THREADS} | {"OPENBLAS_NUM_THREADS": "2"}
    done = subprocess.run([sys.executable, "-c", LIMITED], capture_output=True, text=True, env=many)
    assert done.stdout == "2 1 {1}\n", done.stderr


def test_a_library_that_takes_no_limit_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    deaf = [{"internal_api": "deafblas", "num_threads": 4}]
    monkeypatch.setattr("verification.framework.threads.threadpool_info", lambda: deaf)
    with pytest.raises(RuntimeError, match="deafblas"), limited_to_one_thread():
        pass
