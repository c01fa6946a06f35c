"""Clusters that die: one line, status 1, and what was finished is kept; workers of any number of threads."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.verification.cli.children import Ended, one_line, rows, small
from tests.verification.sweep.own_cluster import Cluster, cluster
from verification.framework.threads import THREADS, limited_to_one_thread
from verification.sweep import engine
from verification.sweep.export import to_csv
from verification.sweep.study_file import study_from_dict

COMMAND = """import sys
from verification.cli import main
from verification.sweep import engine
engine.CONNECT_SECONDS, engine.PATIENCE_SECONDS = 5.0, 2.0
raise SystemExit(main())"""
LONG = 'scene = "table1-rough"\nrealisations = 400\n[vary]\ngrid = [16]\n'


def swept(tmp_path: Path, made: Cluster, act: Callable[[Cluster], object]) -> Ended:
    """The sweep on the cluster, with what is done to the latter when two runs are finished."""
    (tmp_path / "study.toml").write_text(LONG)
    tail = ["sweep", "study.toml", "--store", "s.sqlite", "--scheduler", made.address]
    child = subprocess.Popen(
        [sys.executable, "-c", COMMAND, *tail], cwd=tmp_path, text=True, stderr=subprocess.PIPE
    )
    deadline = time.monotonic() + 60
    while rows(tmp_path / "s.sqlite") < 2 and time.monotonic() < deadline:
        time.sleep(0.02)
    act(made)
    _, err = child.communicate(timeout=60)
    return Ended(child.returncode, err)


@pytest.mark.parametrize("victim", ["scheduler", "last worker"])
def test_a_lost_cluster_is_one_line_and_the_sweep_goes_on_later(victim: str, tmp_path: Path) -> None:
    def kill(made: Cluster) -> None:
        process = made.scheduler if victim == "scheduler" else made.workers[0]
        process.send_signal(signal.SIGKILL)

    with cluster(tmp_path, 1) as made:
        one_line(swept(tmp_path, made, kill), f"the {victim}")
    kept = rows(tmp_path / "s.sqlite")
    assert 2 <= kept < 400
    again = engine.sweep(small(kept), tmp_path / "s.sqlite", workers=0)
    assert len(again.rows) == kept


def test_workers_of_any_environment_give_the_same_bytes(tmp_path: Path) -> None:
    """A worker that nobody told to have one thread: its BLAS has as many as there are cores."""
    study = study_from_dict(
        {"scene": "table1-rough", "realisations": 3, "vary": {"grid": [24]}, "solve": {"method": "dense"}}
    )
    here = engine.sweep(study, tmp_path / "h.sqlite", workers=0)
    free = {"OMP_NUM_THREADS": "3"}
    with cluster(tmp_path, 1, free, drop=THREADS) as made:
        there = engine.sweep(study, tmp_path / "c.sqlite", scheduler=made.address)
    assert to_csv(there.rows) == to_csv(here.rows)
    assert not there.failures


LIMITED = """
import numpy, scipy.linalg, threadpoolctl, refimpl
from refimpl.operators.threads import allowed_threads
from verification.framework.threads import limited_to_one_thread
before = max(pool["num_threads"] for pool in threadpoolctl.threadpool_info())
with limited_to_one_thread():
    print(before, allowed_threads(), {pool["num_threads"] for pool in threadpoolctl.threadpool_info()})
"""


def test_threads_are_limited_after_the_import(tmp_path: Path) -> None:
    many = {k: v for k, v in os.environ.items() if k not in THREADS} | {"OPENBLAS_NUM_THREADS": "2"}
    done = subprocess.run([sys.executable, "-c", LIMITED], capture_output=True, text=True, env=many)
    assert done.stdout == "2 1 {1}\n", done.stderr


def test_a_library_that_takes_no_limit_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    deaf = [{"internal_api": "deafblas", "num_threads": 4}]
    monkeypatch.setattr("verification.framework.threads.threadpool_info", lambda: deaf)
    with pytest.raises(RuntimeError, match="deafblas"), limited_to_one_thread():
        pass
