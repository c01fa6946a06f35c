"""A report on somebody else's solver names it, counts its cases apart, and tells how to run them again."""

from __future__ import annotations

import re
import shlex
from typing import Any

import pytest

from reports.evidence import gathered, groups, rerun
from reports.generator import render
from reports.results import ResultFileError, check
from tests.reports.sample import case, results
from tests.reports.test_generator import summary_of
from verification.cli import parser

COMMAND = "rough-friction verify --exec './mine --fast' --able load --only 'solver/*' --json out.json"


def theirs(*cases: dict[str, Any], command: str = COMMAND) -> dict[str, Any]:
    made = results(
        *cases,
        tier="full",
        solver={"name": "./mine --fast", "abilities": None, "not_applicable": {}},
    )
    made["provenance"]["command"] = command
    return made


RUN = theirs(
    case("solver/pins"),
    case("solver/hertz", "fail", value=1.2),
    case("solver/shear", "unavailable", note="the solver does not offer: coupling"),
)
OURS = {"quick": results(case("hertz/a"), case("hertz/b", tier="full"), case("hertz/c", "fail", value=1.3))}


def test_title_and_summary_name_the_solver() -> None:
    html = render(RUN, OURS)
    assert "<title>Report on ./mine --fast</title>" in html
    heading = re.search(r"<h1>.*?</h1>", html)
    assert heading
    assert "./mine --fast" in heading[0]
    assert "./mine --fast" in summary_of(html).text
    own = render(OURS["quick"], {})
    assert "<title>Verification and replication report" in own
    assert "solver under test" not in own


def test_its_cases_are_counted_apart_from_the_projects_own() -> None:
    mine, ours = groups(gathered(RUN, OURS))
    assert mine.counts == {"pass": 1, "fail": 1, "error": 0, "unavailable": 1}
    assert ours.counts == {"pass": 2, "fail": 1, "error": 0, "unavailable": 0}
    assert summary_of(render(RUN, OURS)).links == [
        "#case-solver.hertz",
        "#case-solver.shear",
        "#case-hertz.c",
    ]
    assert re.findall(r"<b>(\d)</b> pass", render(RUN)) == ["1"]


@pytest.mark.parametrize(
    "command",
    [
        COMMAND,
        "rough-friction verify --only=solver/a --solver a:b --js=x.json --timeout 5 --largest=32",
    ],
)
def test_the_command_is_parsed_to_the_same_solver(command: str) -> None:
    words = shlex.split(rerun(command, "solver/pins"))
    assert words[0] == "rough-friction"
    before, after = (parser().parse_args(w[1:]) for w in (shlex.split(command.replace("x.json", "-")), words))
    for name in ("solver", "exec", "able", "largest", "precision", "timeout"):
        assert getattr(after, name) == getattr(before, name)
    assert after.only == ["solver/pins"]
    assert after.json is None


def test_a_committed_run_of_another_solver_is_no_evidence_of_ours() -> None:
    found = gathered(OURS["quick"], {"theirs": RUN})
    assert [c["id"] for c in found.cases] == ["hertz/a", "hertz/b", "hertz/c"]
    assert "theirs" not in found.studies


@pytest.mark.parametrize("alien", [None, {}])
def test_a_solver_without_a_name_is_refused(alien: object) -> None:
    with pytest.raises(ResultFileError, match="solver"):
        check(results(case("a/1"), solver=alien))
