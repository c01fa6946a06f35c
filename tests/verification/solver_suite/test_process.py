"""Processes of solvers: none can change its judge, and none goes on after its run."""

from __future__ import annotations

import json
import os
import signal
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import pytest

from tests.verification.cli.children import running
from verification.cli import main
from verification.framework.case import Result
from verification.solver_suite import identity, isolated
from verification.solver_suite.isolated import Named
from verification.solver_suite.protocol import ContactProblem

pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="signals and forks of POSIX")
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
'''
CASES = ["solver/one-element", "solver/pins"]
OTHER = "the solver's process sent something else than an answer"


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
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
    monkeypatch.setattr(isolated, "GRACE", 4.0)
    first, second = judged("hangs", timeout=0.5)
    assert (first.status, second.status) == ("error", "pass")
    assert first.note.startswith("no answer within 4.5 s")


PROBLEM = ContactProblem(np.zeros((2, 2)), spacing=1e-6, reduced_modulus=1e9, load=4e-6)


@pytest.fixture
def temporary(folder: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
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
