"""However a run of somebody's solver ends, nothing that it started goes on, and no file is left."""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Callable
from pathlib import Path

import psutil
import pytest

from tests.verification.cli.children import forked, started
from verification.solver_suite.process import Ended, unwinding

SLEEPER = "sh -c 'echo $$ > pid; exec sleep 600' "
SOLVER = """
import os, time
from pathlib import Path

def solve(problem):
    Path("pid.new").write_text(str(os.getpid()))
    os.rename("pid.new", "pid")
    time.sleep(600)
"""


def running(pid: int) -> bool:
    """Whether a process is there and no zombie, which only its parent could bury."""
    return psutil.pid_exists(pid) and psutil.Process(pid).status() != psutil.STATUS_ZOMBIE


def until(seconds: float, what: str, holds: Callable[[], object]) -> None:
    deadline = time.monotonic() + seconds
    while not holds():
        assert time.monotonic() < deadline, what
        time.sleep(0.05)


@pytest.mark.parametrize(
    ("solver", "how"),
    [
        (["--exec", SLEEPER], signal.SIGINT),
        (["--exec", SLEEPER], signal.SIGTERM),
        (["--exec", SLEEPER], signal.SIGKILL),
        (["--solver", "sleeper:solve"], signal.SIGHUP),
    ],
)
def test_a_run_that_is_ended_takes_the_solver_with_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, solver: list[str], how: signal.Signals
) -> None:
    (tmp_path / "tmp").mkdir()
    (tmp_path / "sleeper.py").write_text(SOLVER)
    monkeypatch.setenv("TMPDIR", str(tmp_path / "tmp"))
    child = started(["verify", *solver, "--only", "contestant/one-element"], tmp_path)
    until(60, "the solver started", lambda: (tmp_path / "pid").exists() and (tmp_path / "pid").read_text())
    pid = int((tmp_path / "pid").read_text())
    try:
        child.send_signal(how)
        assert child.wait(timeout=10) == (130 if how is signal.SIGINT else -how)
        until(5, "the solver ended", lambda: not running(pid))
        until(5, "no directory is left", lambda: not list((tmp_path / "tmp").iterdir()))
        _, err = child.communicate(timeout=10)  # whoever is left holds the pipes too
        assert err == ""
    finally:
        if running(pid):
            os.kill(pid, signal.SIGKILL)
        child.kill()
        child.communicate()


def test_a_signal_unwinds_once_and_is_then_as_before() -> None:
    cleaned = []

    def tidying() -> None:
        try:
            os.kill(os.getpid(), signal.SIGTERM)
        finally:
            os.kill(os.getpid(), signal.SIGHUP)  # while it is tidied up
            cleaned.append(True)

    def act() -> int:
        with pytest.raises(Ended, match="15"), unwinding(signal.SIGTERM, signal.SIGHUP):
            tidying()
        if cleaned:
            os.kill(os.getpid(), signal.SIGTERM)
        return 0

    assert forked(act).status == -signal.SIGTERM


def test_an_ignored_signal_stays_so_and_a_fork_gets_it_as_ever() -> None:
    def act() -> int:
        signal.signal(signal.SIGHUP, signal.SIG_IGN)  # as under nohup
        with unwinding(signal.SIGTERM, signal.SIGHUP):
            os.kill(os.getpid(), signal.SIGHUP)
            child = os.fork()
            if child == 0:
                os.kill(os.getpid(), signal.SIGTERM)
                os._exit(3)
        return abs(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))

    assert forked(act).status == signal.SIGTERM
