"""How a contestant is asked, and that nothing but a checked answer counts: every other end fails closed."""

from __future__ import annotations

import argparse
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from refimpl.errors import InputError
from verification.cli import main
from verification.cli.contestant import _source, add_options
from verification.contestants import command, isolated, own
from verification.contestants.asking import ask
from verification.contestants.check import Entrant, Fault
from verification.contestants.command import Command, read_answer, write_problem
from verification.contestants.isolated import Named
from verification.contestants.protocol import (
    Abilities,
    Answer,
    BadAnswer,
    ContactProblem,
    Coupling,
    Unsupported,
    abilities_of,
)
from verification.contestants.suite import run

Capture = pytest.CaptureFixture[str]
GAP = np.array([[0.0, 1e-7], [2e-7, 3e-7]])
PROBLEM = ContactProblem(GAP, 1e-6, 1e9, load=1e-4, coupling=Coupling(1e6, 0.1, 1e-11, 0.3))
FINE = np.ones((2, 2))


@pytest.mark.parametrize(
    ("field", "changed"),
    [
        ("gap", {"gap": np.zeros((2, 3))}),
        ("gap", {"gap": np.array([[0.0, np.nan], [0.0, 0.0]])}),
        ("gap", {"gap": GAP + 1e-9}),
        ("spacing", {"spacing": 0.0}),
        ("reduced_modulus", {"reduced_modulus": -1e9}),
        ("load", {"load": None}),
        ("load", {"approach": 1e-7}),
        ("load", {"load": 0.0}),
        ("approach", {"load": None, "approach": np.inf}),
        ("tolerance", {"tolerance": 1.0}),
    ],
)
def test_a_problem_is_checked(field: str, changed: dict[str, object]) -> None:
    given = {"gap": GAP, "spacing": 1e-6, "reduced_modulus": 1e9, "load": 1.0} | changed
    with pytest.raises(InputError) as refused:
        ContactProblem(**given)  # type: ignore[arg-type]  # what no type checker saw is the point
    assert refused.value.field == field


@pytest.mark.parametrize(
    "changed", [{"tau": -1.0}, {"beta": -0.1}, {"shear_compliance": np.nan}, {"sliding_direction": np.inf}]
)
def test_a_coupling_is_checked(changed: dict[str, float]) -> None:
    with pytest.raises(InputError, match=next(iter(changed))):
        Coupling(**({"tau": 0.0, "beta": 0.0, "shear_compliance": 0.0} | changed))


def test_an_approach_counts_from_the_mean_planes_only_where_it_is_periodic() -> None:
    for periodic, touch in ((False, 2e-7), (True, 3.5e-7)):
        problem = ContactProblem(GAP, 1e-6, 1e9, approach=2e-7, periodic=periodic)
        assert problem.approach_from_touch == pytest.approx(touch, rel=1e-14)
    assert PROBLEM.approach_from_touch is None


@pytest.mark.parametrize(
    ("answer", "said"),
    [
        (np.ones(4), "shape"),
        (np.ones((2, 3)), "shape"),
        (np.array([[1.0, np.nan], [1.0, 1.0]]), "1 pressures are not finite"),
        (np.array([[1.0, -np.inf], [1.0, 1.0]]), "finite"),
        (1j * FINE, "returned an array of complex128: .* array of real numbers"),
        (FINE > 0, "returned an array of bool"),
        (None, "returned None"),
        ([[1.0, 1.0], [1.0, 1.0]], "returned a list"),
        ((FINE, True), r"returned a tuple: .* Answer\(pressure, converged\)"),
        (Answer(FINE, False), "the solver says that it did not converge"),
        (Answer(FINE, np.False_), "the solver says that it did not converge"),
        (Answer(FINE, 1), "converged = 1: expected true or false"),
        (Answer(FINE, np.array([True])), "converged = array.*: expected true or false"),
        (Answer(FINE, "yes"), "converged = 'yes': expected true or false"),
        (Answer(None, True), "returned an array of object"),
        (Answer([[1.0], [1.0, 1.0]], True), "inhomogeneous"),
    ],
)
def test_what_is_no_answer_is_refused(answer: object, said: str) -> None:
    with pytest.raises((BadAnswer, ValueError), match=said):
        ask(lambda problem: answer, _still())  # type: ignore[arg-type,return-value]  # wrong on purpose


def _still() -> ContactProblem:
    return ContactProblem(GAP, 1e-6, 1e9, load=1e-4)


def test_an_array_and_an_answer_are_accepted() -> None:
    for answer in (FINE, FINE.astype(int), Answer([[1, 1], [1, 1]], True), Answer(FINE, np.True_)):
        np.testing.assert_array_equal(ask(lambda problem, a=answer: a, _still()), FINE)  # type: ignore[misc]


def test_a_contestant_cannot_change_the_problem_it_is_judged_by() -> None:
    def meddling(problem: ContactProblem) -> Answer:
        problem.gap[:] = 0.0
        return Answer(FINE, True)

    pressed = Entrant(meddling).press(GAP, 2e-6, load=1e-4)
    np.testing.assert_array_equal(pressed.problem.gap, GAP)


def test_abilities_decide_what_is_posed() -> None:
    assert Abilities.named("aperiodic, load") == Abilities(periodic=False, approach=False)
    assert Abilities().lacking(PROBLEM) == "coupling"
    assert Abilities(load=False).lacking(_still()) == "load"
    assert Abilities(largest=1).lacking(_still()) == "2 elements per side"
    with pytest.raises(Unsupported, match="coupling"):
        ask(lambda problem: FINE, PROBLEM)
    for wrong in ("aperiodic", "load", "load,periodic,magic", ""):
        with pytest.raises(InputError, match="abilities"):
            Abilities.named(wrong)
    for limits in ({"precision": 1e-5}, {"precision": 0.0}, {"largest": 0}, {"coupling": "no"}):
        with pytest.raises(InputError, match="abilities"):
            Abilities(**limits)  # type: ignore[arg-type]  # wrong on purpose
    boastful = type("Boastful", (), {"abilities": "all", "__call__": lambda self, problem: FINE})()
    with pytest.raises(InputError, match="abilities"):
        abilities_of(boastful)


def test_unsupported_is_unavailable_and_an_exception_is_an_error() -> None:
    def unwilling(problem: ContactProblem) -> Answer:
        raise Unsupported("only odd grids") if problem.M % 2 == 0 else RuntimeError("broke")

    (even,) = run(unwilling, ["contestant/one-element"])
    assert (even.status, even.note) == ("unavailable", "only odd grids")
    with pytest.raises(RuntimeError, match="broke"):
        ask(unwilling, ContactProblem(np.zeros((3, 3)), 1e-6, 1e9, load=1.0))


HEADER = {"M", "spacing", "reduced_modulus", "control", "value", "periodic", "tolerance", "friction", "tau"}
HEADER |= {"beta", "shear_compliance", "sliding_direction"}


def test_a_problem_is_written_to_the_last_digit(tmp_path: Path) -> None:
    write_problem(PROBLEM, tmp_path)
    header = json.loads((tmp_path / "problem.json").read_text())
    assert set(header) == HEADER
    assert all(key in str(command.__doc__) for key in HEADER)
    assert (header["M"], header["control"], header["value"], header["periodic"]) == (2, "load", 1e-4, 0)
    assert (header["friction"], header["tau"], header["sliding_direction"]) == (1, 1e6, 0.3)
    assert len((tmp_path / "problem.json").read_text().splitlines()) == len(HEADER) + 2  # one key a line
    np.testing.assert_array_equal(np.loadtxt(tmp_path / "gap.csv", delimiter=","), GAP)
    np.testing.assert_array_equal(np.load(tmp_path / "problem.npz")["gap"], GAP)
    write_problem(ContactProblem(GAP, 1e-6, 1e9, approach=-1e-8, periodic=True), tmp_path)
    header = json.loads((tmp_path / "problem.json").read_text())
    assert (header["control"], header["value"], header["periodic"]) == ("approach", -1e-8, 1)
    assert (header["friction"], header["tau"]) == (0, 0.0)


def test_an_answer_may_be_an_archive(tmp_path: Path) -> None:
    np.savez(tmp_path / "answer.npz", pressure=FINE)
    assert read_answer(tmp_path).converged is True
    (tmp_path / "answer.json").write_text('{"converged": false}')
    assert read_answer(tmp_path).converged is False
    np.savez(tmp_path / "answer.npz", forces=FINE)
    with pytest.raises(BadAnswer, match="KeyError"):
        read_answer(tmp_path)
    (tmp_path / "answer.npz").write_bytes(b"PK\x03\x04 cut short")
    with pytest.raises(BadAnswer, match="unreadable"):
        read_answer(tmp_path)


@pytest.mark.parametrize(
    ("script", "said"),
    [
        ("exit 3", "exit status 3: nothing said"),
        ("echo out of memory >&2; exit 1", "exit status 1: out of memory"),
        ("kill -SEGV $$", "exit status -11"),
        ("true", "neither pressure.csv nor answer.npz"),
        (": > $0/pressure.csv", "unreadable"),
        ("echo 1,2,3,4 > $0/pressure.csv", "shape"),
        ("printf '1,2\\n3\\n' > $0/pressure.csv", "unequal length"),
        ("sed s/0.5/nan/ $0/gap.csv > $0/pressure.csv", "not finite"),
        ("sed s/0.5/oops/ $0/gap.csv > $0/pressure.csv", "unreadable"),
        ("cp $0/gap.csv $0/pressure.csv; cp $0/problem.npz $0/answer.npz", "both"),
        (
            "cp $0/gap.csv $0/pressure.csv; echo '{\"converged\": false}' > $0/answer.json",
            "says that it did not converge",
        ),
        (
            "cp $0/gap.csv $0/pressure.csv; echo '{\"converged\": 1}' > $0/answer.json",
            "converged = 1: expected true or false",
        ),
        ("cp $0/gap.csv $0/pressure.csv; echo '{}' > $0/answer.json", "unreadable"),
        ("sleep 30 & sleep 30", "no answer within 0.2 s"),
    ],
)
def test_a_program_that_does_not_answer_is_an_error(script: str, said: str) -> None:
    (result,) = run(Command(("sh", "-c", script), Abilities(), timeout=0.2), ["contestant/one-element"])
    assert result.status == "error"
    assert said in result.note


def test_a_program_that_answers_wrongly_fails() -> None:
    wrong = Command(("sh", "-c", "cp $0/gap.csv $0/pressure.csv"), Abilities(), timeout=5.0)
    (result,) = run(wrong, ["contestant/one-element"])
    assert (result.status, result.note) == ("fail", "")


def test_the_command_line_states_units_and_where_an_answer_is_off(rival: Path, capfd: Capture) -> None:
    able = ["--able", "approach,aperiodic", "--only", "contestant/pins", "--only", "contestant/hertz-load"]
    assert main(["verify", "--solver", "rival_solver:twice", *able]) == 1
    printed = " ".join(capfd.readouterr().out.split())
    assert "1e+08 > 2 claims" in printed
    assert "1 > 0.001 relative" in printed
    assert "Found: carries 2 of the right load; farthest off is element [" in printed


def test_a_command_is_checked() -> None:
    (missing,) = run(Command(("./not-there",), Abilities(), 1.0), ["contestant/one-element"])
    assert (missing.status, "cannot run ./not-there" in missing.note) == ("error", True)
    for line, timeout, said in (
        ("", 1.0, "--exec = '': expected a command"),
        ("solve 'it", 1.0, '--exec = "solve \'it": expected a command (No closing quotation)'),
        *(("sh", wrong, f"--timeout = {wrong}: expected seconds") for wrong in (0.0, -1.0, np.inf)),
    ):
        with pytest.raises(InputError) as refused:
            Command.of(line, Abilities(), timeout)
        assert str(refused.value).startswith(said)
        assert str(refused.value).count("expected") == 1
    assert Command.of("sh 'a b' -q", Abilities(), 1.0).words == ("sh", "a b", "-q")


RIVAL = """
import os, time
from verification.contestants import own

def solve(problem):
    print("noise on standard output")
    if problem.periodic:
        os._exit(0)
    if problem.M == 24:
        time.sleep(60)
    return own.solve(problem)

def twice(problem):
    return 2 * own.solve(problem).pressure

number = 3
"""

ABLE = """
from verification.contestants import own
from verification.contestants.protocol import Abilities

def solve(problem):
    return own.solve(problem)

solve.abilities = Abilities(periodic=False, load=False, largest=12, precision=1e-7)
"""

IMPORTS = {
    "rival_unwritten": "def solve(problem:",
    "rival_raising": "raise RuntimeError('no licence\\nfound')",
    "rival_leaving": "import sys; sys.exit('bye')",
    "rival_dying": "import os; os._exit(7)",
}


@pytest.fixture
def rival(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A directory to run in, with a module of solvers that misbehave."""
    (tmp_path / "rival_solver.py").write_text(RIVAL)
    for name, source in IMPORTS.items():
        (tmp_path / f"{name}.py").write_text(source)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_a_solver_that_exits_or_hangs_is_an_error_and_the_rest_still_runs(
    rival: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(isolated, "GRACE", 4.0)
    cases = ["square-patch", "westergaard-load", "one-element"]
    source = Named("rival_solver:solve").contestant
    results = isolated.run(source, [f"contestant/{name}" for name in cases], timeout=0.05)
    found = {r.id.partition("/")[2]: (r.status, r.note) for r in results}
    assert found["one-element"][0] == "pass"
    assert found["square-patch"] == ("error", "no verdict within 4.3 s")
    assert found["westergaard-load"] == ("error", "the solver's process died (exit status 0)")


def test_the_command_line_runs_a_solver(rival: Path, capfd: Capture) -> None:
    able = ["--able", "load,approach,aperiodic", "--timeout", "86400", "--only", "contestant/one-element"]
    assert main(["verify", "--solver", "rival_solver:solve", *able, "--json", "-"]) == 0
    document = json.loads(capfd.readouterr().out)
    assert document["contestant"]["name"] == "rival_solver:solve"
    assert document["contestant"]["abilities"]["periodic"] is False
    assert document["contestant"]["not_applicable"] == {}
    assert [c["status"] for c in document["cases"]] == ["pass"]
    assert {"value", "tolerance_reason", "claim", "seconds"} <= set(document["cases"][0])


STATED = Abilities(periodic=False, load=False, largest=12, precision=1e-7)


@pytest.mark.parametrize(
    ("options", "expected"),
    [
        ([], STATED),
        (["--largest", "8"], replace(STATED, largest=8)),
        (["--precision", "1e-6"], replace(STATED, precision=1e-6)),
        (["--able", "aperiodic,load"], replace(STATED, load=True, approach=False)),
        (
            ["--able", "aperiodic,load", "--largest", "9"],
            replace(STATED, load=True, approach=False, largest=9),
        ),
    ],
)
def test_an_option_replaces_only_its_own_part_of_a_solvers_abilities(
    rival: Path, options: list[str], expected: Abilities
) -> None:
    (rival / "able_solver.py").write_text(ABLE)
    parser = argparse.ArgumentParser()
    add_options(parser)
    _, source, _ = _source(parser.parse_args(["--solver", "able_solver:solve", *options]))
    assert abilities_of(source()) == expected


def test_abilities_of_a_function_outlast_an_option(rival: Path, capfd: Capture) -> None:
    (rival / "able_solver.py").write_text(ABLE)
    only = ["--only", "contestant/one-element", "--only", "contestant/westergaard-load"]
    assert main(["verify", "--solver", "able_solver:solve", "--largest", "64", *only, "--json", "-"]) == 0
    document = json.loads(capfd.readouterr().out)
    assert document["contestant"]["not_applicable"] == {
        "contestant/westergaard-load": "the solver does not offer: periodic"
    }
    assert document["contestant"]["abilities"] == {"largest": 64}


def test_the_command_line_names_what_was_not_run(capfd: Capture) -> None:
    only = ["--only", "contestant/one-element", "--only", "contestant/westergaard-load"]
    status = main(["verify", "--exec", "false", "--able", "aperiodic,approach", *only])
    printed = capfd.readouterr().out
    assert status == 1
    assert "error" in printed
    assert "not offer: periodic: westergaard-load" in printed
    assert "0 pass, 0 fail, 1 error, 1 unavailable" in printed
    assert "exit status 1: nothing said" in printed
    assert (
        main(["verify", "--exec", "true", "--able", "periodic,load", "--only", "contestant/one-element"]) == 1
    )


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--solver", "no_such_module:solve"], "no_such_module"),
        (["--solver", "rival_solver"], "package.module:function"),
        (["--solver", "rival_solver:number"], "package.module:function"),
        (["--solver", "rival_solver:absent"], "absent"),
        (["--solver", "rival_unwritten:solve"], "'rival_unwritten:solve': expected package.module:function"),
        (["--solver", "rival_unwritten:solve"], "SyntaxError: '(' was never closed"),
        (["--solver", "rival_raising:solve"], "RuntimeError: no licence found"),
        (["--solver", "rival_leaving:solve"], "SystemExit: bye"),
        (["--solver", "rival_dying:solve"], "'rival_dying:solve': expected a solver whose import ends well"),
        (["--solver", "rival_dying:solve"], "its process died, exit status 7"),
        (["--solver", "rival_solver:solve", "--able", "magic"], "magic"),
        (["--solver", "rival_solver:solve", "--largest", "0"], "largest"),
        (["--solver", "rival_solver:solve", "--precision", "0.1"], "precision"),
        (["--solver", "rival_solver:solve", "--only", "hertz/*"], "no case of the suite matches"),
        (["--exec", "'"], "--exec"),
        (["--exec", ""], "--exec = '': expected a command\n"),
        (["--exec", "./missing --fast"], "--exec = './missing --fast': expected a command whose first word"),
        (["--exec", "no-such-program"], "'no-such-program': expected a command whose first word"),
        (["--exec", "./rival_solver.py"], "is a program that can be run"),
        (["--exec", "."], "is a program that can be run"),
        (["--exec", "true", "--timeout", "0"], "--timeout = 0.0: expected seconds for one problem, above 0"),
        (["--exec", "true", "--timeout", "-1"], ": --timeout = -1.0"),
        *(
            ([*solver, "--timeout", late], "at most 86400")
            for solver in (["--exec", "true"], ["--solver", "rival_solver:solve"])
            for late in ("inf", "nan", "1e9", "400000")
        ),
        (["--exec", "true", "--solver", "rival_solver:solve"], "not allowed with"),
        (["--able", "load"], "nothing without --solver or --exec"),
    ],
)
def test_bad_usage_is_refused_in_one_line(
    rival: Path, capfd: Capture, arguments: list[str], said: str
) -> None:
    try:
        status = main(["verify", *arguments])
    except SystemExit as usage:
        status = int(usage.code or 0)
    printed = capfd.readouterr()
    assert (status, printed.out, printed.err.count("\n")) == (2, "", 1), printed.err
    assert said in printed.err


def test_the_suite_and_the_self_test_can_be_listed(capfd: Capture) -> None:
    assert main(["verify", "--solver", "not.imported:here", "--list"]) == 0
    assert "contestant/trailing-shift" in capfd.readouterr().out
    assert main(["verify", "--self-test", "--list"]) == 0
    listed = capfd.readouterr().out.splitlines()
    assert len([line for line in listed if "contestants/catches-" in line]) == len(Fault)
    assert own.solve.version.startswith("refimpl ")
