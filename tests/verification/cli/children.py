"""Child processes that limits, signals and shortages are tried on, and a small study."""

from __future__ import annotations

import gc
import os
import sqlite3
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from contextlib import closing, suppress
from multiprocessing import resource_tracker
from pathlib import Path
from typing import NamedTuple

import psutil
import pytest

from verification.sweep.study import Study
from verification.sweep.study_file import study_from_dict

LONG = ["solve", "table1-rough", "--grid", "1024", "--tolerance", "1e-12"]


class Ended(NamedTuple):
    """How a child ended: exit status (negative: the signal), and what it printed on stderr."""

    status: int
    err: str


def forked(act: Callable[[], int], *, before: Callable[[], object] = lambda: None) -> Ended:
    """Run in a forked child, so that limits and signals touch nobody else and nothing is imported anew.

    An interrupt that comes while garbage is collected is raised in the first callback of the collector, and
    lost there. Hypothesis has one; a child has none. The tracker of semaphores is this process's: one of the
    child's own reports the semaphores of killed workers on the child's standard error, at random.
    """
    if not hasattr(os, "fork"):
        pytest.skip("limits and signals of POSIX")
    resource_tracker.ensure_running()
    with tempfile.TemporaryFile() as err:
        child = os.fork()
        if child == 0:
            gc.callbacks.clear()
            os.dup2(err.fileno(), 2)
            os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
            sys.stderr, sys.stdout = os.fdopen(2, "w", closefd=False), os.fdopen(1, "w", closefd=False)
            before()
            try:
                status = act()
            except SystemExit as usage:
                status = int(usage.code or 0)
            finally:
                sys.stderr.flush()
            os._exit(status)
        _, waited = os.waitpid(child, 0)
        err.seek(0)
        return Ended(os.waitstatus_to_exitcode(waited), err.read().decode())


def started(arguments: list[str], folder: Path) -> subprocess.Popen[str]:
    """The command line, run in a folder.

    A shell's background job ignores interrupts, and what nohup runs hang-ups; this does not.
    """
    code = "import signal; signal.signal(signal.SIGINT, signal.default_int_handler); "
    code += "signal.signal(signal.SIGHUP, signal.SIG_DFL); "
    code += "print('ready', flush=True); from verification.cli import main; raise SystemExit(main())"
    environment = os.environ | {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    child = subprocess.Popen(
        [sys.executable, "-c", code, *arguments],
        cwd=folder, env=environment, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
    )  # fmt: skip
    assert child.stdout is not None
    assert child.stdout.readline() == "ready\n"
    return child


def running(pid: int) -> bool:
    """Whether a process runs: one that ended stays as a zombie until its parent has read its status."""
    return psutil.pid_exists(pid) and psutil.Process(pid).status() != psutil.STATUS_ZOMBIE


def until(seconds: float, what: str, holds: Callable[[], object]) -> None:
    deadline = time.monotonic() + seconds
    while not holds():
        assert time.monotonic() < deadline, what
        time.sleep(0.05)


def one_line(ended: Ended, says: str, status: int = 1) -> None:
    """The fault is told in one clear line, without a traceback."""
    assert ended.status == status, ended.err
    assert ended.err.count("\n") == 1, ended.err
    assert ended.err.startswith("rough-friction")
    assert says in ended.err


def small(realisations: int = 40) -> Study:
    return study_from_dict({"scene": "table1-rough", "realisations": realisations, "vary": {"grid": [12]}})


def finished(store: Path) -> int:
    if not store.exists():
        return 0
    with closing(sqlite3.connect(store)) as connection, suppress(sqlite3.OperationalError):
        return int(connection.execute("select count(*) from runs").fetchone()[0])
    return 0
