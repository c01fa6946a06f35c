"""Runs of a solver that are interrupted or killed: what is judged is kept, and no process goes on."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import psutil
import pytest

from tests.verification.cli.children import forked, running, started, until
from verification.cli.suite_run import unwinding
from verification.solver_suite import process

pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="signals and forks of POSIX")
SLEEPER = "sh -c 'echo $$ > pid; exec sleep 600' "
SLEEPS = """
import os, time
from pathlib import Path
from verification.solver_suite import own

def solve(problem):
    Path("pid.new").write_text(str(os.getpid()))
    os.rename("pid.new", "pid")
    os.environ.clear()
    time.sleep(600)

opened = []

def reopens(problem):  # a file in the place of every descriptor, from the first problem on
    if opened:
        solve(problem)
    os.closerange(3, 64)
    opened.extend(open(__file__) for _ in range(60))
    return 0 * problem.gap

def slow_second(problem):
    if os.path.exists("first"):
        open("second", "w").close()
        time.sleep(600)
    open("first", "w").close()
    return own.solve(problem)
"""


@pytest.mark.parametrize(
    ("how", "status"),
    [(signal.SIGINT, 130), pytest.param(signal.SIGTERM, -signal.SIGTERM, marks=pytest.mark.nightly)],
)
def test_an_interrupted_run_shows_and_writes_what_is_judged_so_far(
    tmp_path: Path, how: signal.Signals, status: int
) -> None:
    (tmp_path / "sleeper.py").write_text(SLEEPS)
    only = ["--only", "solver/one-element", "--only", "solver/pins"]
    child = started(["verify", "--solver", "sleeper:slow_second", *only, "--json", "out.json"], tmp_path)
    try:
        until(180, "the second problem is posed", lambda: (tmp_path / "second").exists())
        child.send_signal(how)
        out, err = child.communicate(timeout=20)
    finally:
        child.kill()
    assert child.returncode == status
    assert "pass  solver/one-element" in out
    assert "interrupted: 1 cases were not judged" in out
    assert err == ""
    document = json.loads((tmp_path / "out.json").read_text())
    assert document["interrupted"] is True
    assert [case["status"] for case in document["cases"]] == ["pass"]
    assert document["solver"]["not_judged"] == ["solver/pins"]


@pytest.mark.parametrize(
    ("solver", "how"),
    [
        pytest.param(["--exec", SLEEPER], signal.SIGTERM, marks=pytest.mark.nightly),
        (["--exec", SLEEPER], signal.SIGKILL),
        (["--solver", "sleeper:reopens", "--only", "solver/pins"], signal.SIGKILL),
        pytest.param(["--solver", "sleeper:solve"], signal.SIGHUP, marks=pytest.mark.nightly),
    ],
)
def test_a_run_that_is_ended_takes_the_solver_with_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, solver: list[str], how: signal.Signals
) -> None:
    (tmp_path / "tmp").mkdir()
    (tmp_path / "sleeper.py").write_text(SLEEPS)
    monkeypatch.setenv("TMPDIR", str(tmp_path / "tmp"))
    child = started(["verify", *solver, "--only", "solver/one-element"], tmp_path)
    until(180, "the solver started", lambda: (tmp_path / "pid").exists() and (tmp_path / "pid").read_text())
    pid = int((tmp_path / "pid").read_text())
    try:
        child.send_signal(how)
        assert child.wait(timeout=10) == (130 if how is signal.SIGINT else -how)
        until(10, "the solver ended", lambda: not running(pid))
        until(10, "no directory is left", lambda: not list((tmp_path / "tmp").iterdir()))
        _, err = child.communicate(timeout=10)  # whoever is left holds the pipes too
        assert err == ""
    finally:
        if running(pid):
            os.kill(pid, signal.SIGKILL)
        child.kill()
        child.communicate()


def test_an_ignored_signal_stays_so() -> None:
    def act() -> int:
        signal.signal(signal.SIGHUP, signal.SIG_IGN)  # as under nohup
        with unwinding(signal.SIGTERM, signal.SIGHUP):
            os.kill(os.getpid(), signal.SIGHUP)
        return 3

    assert forked(act).status == 3


def test_a_number_is_signalled_only_while_it_is_the_solvers(monkeypatch: pytest.MonkeyPatch) -> None:
    """Once it is reaped, the system may give its number to anybody."""
    signalled = list[bool]()
    monkeypatch.setattr(process, "kill_group", lambda pid: signalled.append(psutil.pid_exists(pid)))
    child = subprocess.Popen([sys.executable, "-c", ""], stdin=subprocess.PIPE, start_new_session=True)
    assert process.end_all(child, "nobody's mark") == []
    assert process.end_all(child, "nobody's mark") == []
    assert signalled == [True]
