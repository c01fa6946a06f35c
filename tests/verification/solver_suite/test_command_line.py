"""A solver under test on the command line: faulty solvers, options, what is printed and what is refused."""

from __future__ import annotations

import argparse
import json
import os
from dataclasses import replace
from pathlib import Path

import pytest

from verification.cli import main
from verification.cli.suite_report import likely_faults, unseen_faults
from verification.cli.suite_run import _source, add_options
from verification.framework.case import Status
from verification.solver_suite import own
from verification.solver_suite.check import Fault
from verification.solver_suite.faulty_solvers.table import FAULTY
from verification.solver_suite.protocol import Abilities, abilities_of
from verification.solver_suite.suite import suite

Capture = pytest.CaptureFixture[str]
RIVAL = """
from verification.solver_suite import own

def solve(problem):
    print("noise on standard output")
    return own.solve(problem)

def twice(problem):
    return 2 * own.solve(problem).pressure

number = 3
"""

ABLE = """
from verification.solver_suite import own
from verification.solver_suite.protocol import Abilities

def solve(problem):
    return own.solve(problem)

solve.abilities = Abilities(periodic=False, load=False, largest=12, precision=1e-7)
"""

IMPORTS = {
    "rival_unwritten": "def solve(problem:",
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


def test_the_command_line_states_units_and_where_an_answer_is_off(rival: Path, capfd: Capture) -> None:
    able = ["--able", "approach,aperiodic", "--only", "solver/pins", "--only", "solver/hertz-load"]
    assert main(["verify", "--solver", "rival_solver:twice", *able]) == 1
    printed = " ".join(capfd.readouterr().out.split())
    assert "1e+08 > 2 claims" in printed
    assert "1 > 0.001 relative" in printed
    assert "Found: 1e+08 > 2 claims; carries 2 of the right load; farthest off is element [" in printed
    assert "Found: 1 > 0.001 relative; 2.00" in printed
    assert "Meant to catch" not in printed
    assert "fail: 1 % modulus error (2 of 2), modulus with E instead of 2E (2 of 2), lost" in printed


def test_the_command_line_runs_a_solver(rival: Path, capfd: Capture) -> None:
    able = ["--able", "load,approach,aperiodic", "--timeout", "86400", "--only", "solver/one-element"]
    assert main(["verify", "--solver", "rival_solver:solve", *able, "--json", "-"]) == 0
    document = json.loads(capfd.readouterr().out)
    assert document["solver"]["name"] == "rival_solver:solve"
    assert document["solver"]["abilities"]["periodic"] is False
    assert document["solver"]["not_applicable"] == {}
    assert document["solver"]["unseen_faults"] is None  # some cases were chosen: so much was left out
    assert [c["status"] for c in document["cases"]] == ["pass"]
    assert {"value", "tolerance_reason", "claim", "seconds"} <= set(document["cases"][0])


STATED = Abilities(periodic=False, load=False, largest=12, precision=1e-7)


@pytest.mark.parametrize(
    ("options", "expected"),
    [
        ([], STATED),
        (["--precision", "1e-6"], replace(STATED, precision=1e-6)),
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


def test_the_command_line_names_what_was_not_run(capfd: Capture) -> None:
    only = ["--only", "solver/one-element", "--only", "solver/westergaard-load"]
    status = main(["verify", "--exec", "false", "--able", "aperiodic,approach", *only])
    printed = capfd.readouterr().out
    assert status == 1
    assert "error" in printed
    assert "not offer: periodic: westergaard-load" in printed
    assert "0 pass, 0 fail, 1 error, 1 unavailable" in printed
    assert "exit status 1: nothing said" in printed


def test_a_name_that_is_no_utf_8_can_be_written(tmp_path: Path, capfd: Capture) -> None:
    command, written = "false " + os.fsdecode(b"caf\xe9"), tmp_path / "mine.json"
    assert main(["verify", "--exec", command, "--only", "solver/pins", "--json", str(written)]) == 1
    assert json.loads(written.read_text())["solver"]["name"] == "false caf?"
    assert "false caf?: 0 pass" in capfd.readouterr().out


def test_the_whole_suite_names_the_faults_that_it_did_not_look_for(capfd: Capture, tmp_path: Path) -> None:
    own_name = "verification.solver_suite.own:solve"
    able = ["--able", "aperiodic,load", "--largest", "16"]
    assert main(["verify", "--solver", own_name, *able, "--json", str(tmp_path / "a.json")]) == 0
    unseen = json.loads((tmp_path / "a.json").read_text())["solver"]["unseen_faults"]
    assert {Fault.SIGN_OF_C, Fault.APPROACH_FORGOTTEN, Fault.PADDING_CAPPED} <= {*unseen}
    assert not {Fault.MODULUS_OFF, Fault.SPACING_KEPT, Fault.FAINT_PRESSURE} & {*unseen}
    printed = " ".join(capfd.readouterr().out.split())
    assert f"looked for by none of these cases: {unseen[0]}, " in printed
    assert f", {unseen[-1]} {own_name}: " in printed
    assert unseen_faults(check.case(own.solve).result(Status.PASS, "", 0.0) for check in suite()) == []


CASES = {check.id: check.case(own.solve) for check in suite()}


@pytest.mark.parametrize("fault", FAULTY, ids=str)
def test_a_fault_that_fails_where_it_is_named_is_listed_first(fault: Fault) -> None:
    """Or second, behind another one that the same cases name."""
    statuses = {check: Status.FAIL if fault in check.catches else Status.PASS for check in suite()}
    results = [CASES[check.id].result(status, "", 0.0) for check, status in statuses.items()]
    named = sum(status is Status.FAIL for status in statuses.values())
    assert f"{fault} ({named} of {named})" in likely_faults(results)[:2]
    assert likely_faults(result for result in results if result.status == "pass") == []


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--solver", "no_such_module:solve"], "no_such_module"),
        (["--solver", "rival_solver"], "package.module:function"),
        (["--solver", "rival_solver:number"], "package.module:function"),
        (["--solver", "rival_unwritten:solve"], "SyntaxError: '(' was never closed"),
        (["--solver", "rival_leaving:solve"], "SystemExit: bye"),
        (["--solver", "rival_dying:solve"], "the solver's process died (exit status 7)"),
        (["--solver", "rival_solver:solve", "--able", "magic"], "magic"),
        (["--solver", "rival_solver:solve", "--largest", "0"], "largest"),
        (["--solver", "rival_solver:solve", "--precision", "0.1"], "precision"),
        (["--solver", "rival_solver:solve", "--only", "hertz/*"], "no case of the suite matches"),
        (["--exec", "solve 'it"], '--exec = "solve \'it": expected a command (No closing quotation)'),
        (["--exec", "./missing --fast"], "--exec = './missing --fast': expected a command whose first word"),
        (["--exec", "./rival_solver.py"], "is a program that can be run"),
        (["--exec", "."], "is a program that can be run"),
        (["--exec", "true", "--timeout", "0"], "--timeout = 0.0: expected seconds for one problem, above 0"),
        (["--exec", "true", "--timeout", "nan"], "at most 86400"),
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
    assert "solver/trailing-shift" in capfd.readouterr().out
    assert main(["verify", "--self-test", "--list"]) == 0
    listed = capfd.readouterr().out.splitlines()
    assert len([line for line in listed if "solver_suite/catches-" in line]) == len(FAULTY)
    assert own.solve.version.startswith("refimpl ")


def test_thorough_adds_problems_of_other_seeds_after_the_suite(tmp_path: Path, capfd: Capture) -> None:
    words = ["verify", "--solver", "verification.solver_suite.own:solve"]
    words += ["--only", "solver/design-plain-2-0[12]", "--only", "solver/pins"]
    assert main([*words, "--thorough", "--json", str(tmp_path / "found.json")]) == 0
    found = json.loads((tmp_path / "found.json").read_text())
    assert [case["id"].partition("/")[2] for case in found["cases"]] == [
        "pins",
        "design-plain-2-01",
        "design-plain-2-02",
    ]
    assert found["thorough"] == 2
    assert main(words) == 2
    assert main([*words[:3], "--thorough", "--discretisation", "other"]) == 2
    assert "nothing beside --discretisation other" in capfd.readouterr().err
