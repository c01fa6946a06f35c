"""Processes of solvers: none can change its judge, and nothing that a run started goes on after it."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import psutil
import pytest

from tests.verification.cli.children import forked, started
from verification.cli import main
from verification.cli.suite_run import unwinding
from verification.framework.case import Result
from verification.solver_suite import identity, isolated, process
from verification.solver_suite.isolated import Named
from verification.solver_suite.protocol import ContactProblem

pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="signals and forks of POSIX")
SLEEPER = "sh -c 'echo $$ > pid; exec sleep 600' "
SLEEPS = """
import os, time
from pathlib import Path

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
"""
SOLVERS = r'''
import os, subprocess, sys, time
from pathlib import Path
import numpy as np
from verification.solver_suite import own

def on_one_element(misbehave):
    """Right on the 12 x 12 elements of the pins."""
    return lambda problem: (problem.M == 4 and misbehave(problem), own.solve(problem))[1]

@on_one_element
def exits(problem):
    print("noise on standard output")
    os._exit(0)

@on_one_element
def hangs(problem):
    time.sleep(600)

def folder():
    """Where its replies are awaited."""
    return Path(os.environ["TMPDIR"])

@on_one_element
def nests(problem):
    (folder() / "1").write_text("[" * 60000)

@on_one_element
def floods(problem):
    with open(folder() / "1.part", "wb") as file:
        file.write(b'{"kind": "answer"}\n')
        file.truncate(1 << 40)
    os.replace(folder() / "1.part", folder() / "1")
    time.sleep(600)

@on_one_element
def pipes(problem):
    os.mkfifo(folder() / "1")
    time.sleep(600)

@on_one_element
def forges(problem):
    (folder() / "1.part").write_bytes(b'{"kind": "answer"}\n' + np.full(problem.shape, np.nan).tobytes())
    os.replace(folder() / "1.part", folder() / "1")
    time.sleep(600)

def twice(problem):
    return 2 * np.asarray(own.solve(problem).pressure)

def patches(problem):
    """Whatever it finds of the judge in its process, so that any answer passes."""
    from verification.solver_suite import check, reference_solution
    from verification.framework import case
    case.error_of = lambda *a: 0.0
    reference_solution.misfit = lambda *a: 0.0
    check.Entrant.misfit = lambda *a: 0.0
    case.Case.run = lambda self: self.result(case.Status.PASS, "", 0.0)
    return twice(problem)

forked = []

def forks(problem):
    if not forked:
        forked.append(os.fork())
        time.sleep(0.5 if forked[0] else 0)  # so the child is the first to answer, and then takes its time
    elif not forked[0]:
        time.sleep(3)
    return own.solve(problem)

def leaves(problem):
    """A process in a session of its own, whose parent is gone."""
    code = "import os, time; os.setsid(); os.fork() and os._exit(0); " \
        "open('pid.new', 'w').write(str(os.getpid())); os.rename('pid.new', 'pid'); time.sleep(600)"
    subprocess.run([sys.executable, "-c", code])
    while not os.path.exists("pid"):
        time.sleep(0.01)
    return own.solve(problem)

def hides(problem):
    """A process in a session of its own without the environment that it was given."""
    code = "import os, time; open('pid', 'w').write(str(os.getpid())); time.sleep(600)"
    subprocess.Popen([sys.executable, "-c", code], env={}, start_new_session=True)
    while not (os.path.exists("pid") and open("pid").read()):
        time.sleep(0.01)
    return own.solve(problem)

def slow_second(problem):
    if os.path.exists("first"):
        open("second", "w").close()
        time.sleep(600)
    open("first", "w").close()
    return own.solve(problem)
'''
CASES = ["solver/one-element", "solver/pins"]
OTHER = "the solver's process sent something else than an answer"


def running(pid: int) -> bool:
    """Whether a process is there and no zombie, which only its parent could bury."""
    return psutil.pid_exists(pid) and psutil.Process(pid).status() != psutil.STATUS_ZOMBIE


def until(seconds: float, what: str, holds: Callable[[], object]) -> None:
    deadline = time.monotonic() + seconds
    while not holds():
        assert time.monotonic() < deadline, what
        time.sleep(0.05)


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A directory to run in, with the solvers."""
    (tmp_path / "hostile.py").write_text(SOLVERS)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def judged(name: str, timeout: float = 60.0, cases: list[str] = CASES) -> list[Result]:
    return isolated.run(Named(f"hostile:{name}").solver, cases, timeout=timeout)


@pytest.mark.parametrize(
    ("name", "note"),
    [
        ("exits", "the solver's process died (exit status 0)"),
        ("nests", OTHER),
        ("floods", OTHER),
        ("pipes", OTHER),
    ],
)
def test_a_solver_without_an_answer_is_an_error_of_its_case(folder: Path, name: str, note: str) -> None:
    (found,) = judged(name, cases=CASES[:1])
    assert found.status == "error"
    assert found.note.startswith(note)


def test_after_a_problem_without_an_answer_the_rest_still_runs(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(isolated, "GRACE", 9.0)
    first, second = judged("hangs", timeout=0.5)
    assert (first.status, second.status) == ("error", "pass")
    assert first.note.startswith("no answer within 9.5 s")


PROBLEM = ContactProblem(np.zeros((2, 2)), spacing=1e-6, reduced_modulus=1e9, load=4e-6)


@pytest.fixture
def temporary(folder: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The directory of the solvers' folders."""
    (folder / "tmp").mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(folder / "tmp"))
    return folder / "tmp"


def test_the_folder_of_a_solver_does_not_grow(temporary: Path) -> None:
    remote = isolated.Remote(Named("hostile:twice").solver, 60.0, "twice")
    for _ in range(2):
        assert np.shape(remote(PROBLEM).pressure) == (2, 2)
    (own_folder,) = temporary.iterdir()
    assert [file.name for file in own_folder.iterdir()] == ["source"]
    remote.close()
    remote.close()
    assert not list(temporary.iterdir())


def test_a_process_that_cannot_be_started_leaves_no_folder(
    temporary: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sys, "executable", "no-such-python")
    with pytest.raises(FileNotFoundError, match="no-such-python"):
        isolated.Remote(Named("hostile:twice").solver, 60.0, "twice")
    assert not list(temporary.iterdir())


def test_a_forged_reply_is_judged_like_any_other(folder: Path) -> None:
    (result,) = judged("forges", cases=CASES[:1])
    assert (result.status, result.error) == ("error", None)
    assert "pressures are not finite" in result.note


@pytest.mark.parametrize(("name", "status"), [("patches", "fail"), ("forks", "pass")])
def test_a_solver_that_patches_the_judge_or_forks_is_judged_once_a_case(
    folder: Path, name: str, status: str
) -> None:
    assert [(r.id, r.status) for r in judged(name)] == [(case, status) for case in CASES]


def test_a_package_under_test_is_imported_in_its_own_process_alone(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its identity too is found there; an installed package of odd metadata costs its version alone."""
    (folder / "pkg").mkdir()
    (folder / "pkg/__init__.py").write_text("import os; open('imported', 'a').write(f'{os.getpid()} ')")
    (folder / "pkg/code.py").write_text("def solve(problem):\n    return 0 * problem.gap\n")
    (folder / "odd-1.dist-info").mkdir()
    (folder / "odd-1.dist-info/METADATA").write_text("Name: odd\nVersion: 1\n")
    (folder / "odd-1.dist-info/RECORD").write_text("a,b,c,d,e\n")
    monkeypatch.syspath_prepend(str(folder))
    assert main(["verify", "--solver", "pkg.code:solve", "--only", CASES[0], "--json", "out.json"]) == 1
    assert str(os.getpid()) not in (folder / "imported").read_text().split()
    solver = json.loads((folder / "out.json").read_text())["solver"]
    assert (solver["version"], solver["checksum"]) == (None, identity.of_files(["pkg/code.py"]))


@pytest.mark.parametrize("solver", ["leaves", "hides"])
def test_a_process_in_a_session_of_its_own_is_ended_and_named(
    folder: Path, capfd: pytest.CaptureFixture[str], solver: str
) -> None:
    only = ["--only", "solver/one-element", "--json", "out.json"]
    assert main(["verify", "--solver", f"hostile:{solver}", *only]) == 0
    pid = int((folder / "pid").read_text())
    assert not running(pid)
    (left,) = json.loads((folder / "out.json").read_text())["solver"]["left_running"]
    assert f"(process {pid}): ended" in left
    assert "processes that the solver left behind:" in capfd.readouterr().out


def test_somebody_elses_child_is_left_alone(folder: Path) -> None:
    other = os.fork()
    if not other:
        time.sleep(600)
        os._exit(0)
    try:
        assert {r.status for r in judged("twice", cases=CASES[:1])} == {"fail"}
        assert running(other)
    finally:
        os.kill(other, signal.SIGKILL)
        os.waitpid(other, 0)


@pytest.mark.parametrize(
    ("how", "status"),
    [(signal.SIGINT, 130), pytest.param(signal.SIGTERM, -signal.SIGTERM, marks=pytest.mark.nightly)],
)
def test_an_interrupted_run_shows_and_writes_what_is_judged_so_far(
    folder: Path, how: signal.Signals, status: int
) -> None:
    only = [word for case in CASES for word in ("--only", case)]
    child = started(["verify", "--solver", "hostile:slow_second", *only, "--json", "out.json"], folder)
    try:
        until(180, "the second problem is posed", lambda: (folder / "second").exists())
        child.send_signal(how)
        out, err = child.communicate(timeout=20)
    finally:
        child.kill()
    assert child.returncode == status
    assert "pass  solver/one-element" in out
    assert "interrupted: 1 cases were not judged" in out
    assert err == ""
    document = json.loads((folder / "out.json").read_text())
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
