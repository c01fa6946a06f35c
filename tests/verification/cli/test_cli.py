"""The command line as a whole: help, exit statuses, verification and report, texts for terminals."""

from __future__ import annotations

import argparse
import json
import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

import refimpl
from refimpl.planning.plan import METHODS
from refimpl.solution.quantities import TARGETS
from reports.generator import render
from tests.documents import ROOT
from tests.reports import sample
from tests.verification.cli.commands import Stream, answer, run, shown
from verification.cli import main, parser, solve, verify
from verification.cli.output import judgement
from verification.framework import registry, runner
from verification.framework.case import Case, Measured, Metric, Status, Tier
from verification.output.files import StatusLine
from verification.output.text_table import WIDTH, columns

QUICK = "kernels/love-at-centre"


def commands() -> list[list[str]]:
    """Every (sub)command that the parser knows."""

    def below(node: argparse.ArgumentParser, path: list[str]) -> list[list[str]]:
        found = [path]
        for action in node._actions:
            if isinstance(action, argparse._SubParsersAction):
                for name, child in action.choices.items():
                    found += below(child, [*path, name])
        return found

    return below(parser(), [])


COMMANDS = commands()
GROUPS = [command[:-1] for command in COMMANDS if command]


@pytest.mark.parametrize("command", COMMANDS, ids=" ".join)
def test_help_has_examples_that_parse_and_fits_100_columns(
    command: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "100")
    text = shown(f"{' '.join(command)} --help")
    assert "usage: rough-friction" in text
    assert max(map(len, text.splitlines())) <= 100
    assert ("--json FILE" in text) is (command not in GROUPS)  # of every command that computes
    examples = re.findall(r"^  rough-friction (.*)$", text.replace("\\\n", ""), flags=re.M)
    for example in examples:
        assert callable(parser().parse_args(shlex.split(example)).run), example
    assert any(shlex.split(example)[: len(command)] == command for example in examples)


def test_help_does_not_wait_for_numpy_and_repeats_its_names() -> None:
    check = "import sys; import verification.cli as c; c.parser(); sys.exit('numpy' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", check], check=False).returncode == 0
    assert set(solve.METHODS) == set(METHODS)
    assert set(solve.ACCURATE) == set(TARGETS)
    assert f"Shipped scenes: {', '.join(refimpl.shipped_scenes())}." in solve.EPILOG
    stated = "exit status: 0 CONVERGED, or CYCLED: converged, with an alternating contact edge"
    assert stated in solve.EPILOG


def test_cases_that_examples_name_are_there() -> None:
    """In the help of `verify`, and in the commands of committed results."""
    said = [verify.EPILOG, (ROOT / "reports" / "results" / "README.md").read_text(encoding="utf-8")]
    examples = re.findall(r"rough-friction (verify [^`\n]*--only[^`\n]*)", "\n".join(said))
    assert len(examples) >= 10
    for example in examples:
        asked = parser().parse_args(shlex.split(example))
        assert registry.select(registry.load(), Tier(asked.tier), asked.only), example


def test_verify_writes_what_the_report_reads(folder: Path) -> None:
    printed = shown(f"verify --only {QUICK} --jobs 1 --json results.json")
    assert f"pass  {QUICK}" in printed
    assert "1 pass, 0 fail, 0 error, 0 unavailable" in printed
    Path("committed").mkdir()  # the README's own command draws those
    made = answer("report --results results.json --committed committed --output report")
    assert made["counts"] == {"pass": 1, "fail": 0, "error": 0, "unavailable": 0}
    assert QUICK in Path(made["report"]).read_text(encoding="utf-8")
    assert [p.name for p in Path("report").iterdir()] == ["report.html"]


def test_verify_shows_every_status_and_reasons_of_what_was_not_judged(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A tolerance set from the result is recorded, as in the report; a run with a failure has status 1."""
    made = [
        Case(f"a/{k}", "t", "c", "s", Metric.EQUAL, 0.0, reason, lambda: Measured(1.0, 1.0))
        for k, reason in enumerate(("exact", "recorded: 1.0", *3 * ["exact"]))
    ]
    failed, broken, missing = made[2:]
    results = (
        *(case.run() for case in made[:2]),
        failed.result(Status.FAIL, "why a/2", 0.0),
        broken.result(Status.ERROR, "why a/3", 0.0),
        missing.result(Status.UNAVAILABLE, "why a/4", 0.0),
    )
    monkeypatch.setattr(runner, "run", lambda *_, **__: runner.Run(Tier.QUICK, (), results, 0.0))
    printed = shown(f"verify --only {QUICK}", 1)
    for k, status in enumerate(("pass", "recorded", "fail", "error", "unavailable")):
        assert re.search(rf"^{status} +a/{k}", printed, flags=re.M)
        assert (f"why a/{k}" in printed) is (k > 2)
    assert "1 pass, 1 recorded, 1 fail, 1 error, 1 unavailable" in printed


def test_list_runs_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delattr(runner, "run")
    assert [c["id"] for c in answer("verify --list --tier full")] == [c.id for c in registry.load()]


@pytest.mark.parametrize("number", ["-1e-6", "-.5E-06"])
def test_a_negative_number_is_a_value(number: str) -> None:
    found = answer(f"solve rough-planes --grid 8 --approach {number}")["approach"]
    assert found == pytest.approx(float(number), rel=1e-12)


def test_a_list_that_starts_with_a_minus_sign_is_a_value() -> None:
    wave = "--slope-deg 0.5 --wavelength 50 --position 0.25 --nu 0.3"
    assert answer(f"appendix-a strip {wave} --offsets -3,3")["offsets"] == [-3.0, 3.0]


def test_tables_keep_within_their_width() -> None:
    rows = [["case", "a reason that goes on " * 9], ["other", "short"]]
    lines = columns(rows).splitlines()
    assert max(map(len, lines)) <= WIDTH
    assert " ".join(columns(rows).split()) == " ".join(" ".join(row) for row in rows).replace("  ", " ")
    assert [line.startswith(" " * 9) for line in lines] == [False, *[True] * (len(lines) - 2), False]
    assert columns([]) == ""


@pytest.mark.parametrize("terminal", [True, False])
def test_a_status_line_is_for_terminals(terminal: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stderr", Stream(terminal))
    line = StatusLine()
    for text in ("one " * 100, "too soon"):
        line.show(text)
    line.close()
    line.show("two")
    line.close()
    blank = f"\r{'':<78}\r"
    written = f"\r{('one ' * 100)[:78]}{blank}\r{'two':<78}{blank}"
    assert sys.stderr.getvalue() == (written if terminal else "")


@pytest.mark.parametrize(
    ("metric", "value", "text"),
    [
        (Metric.AT_MOST, 0.25, "0.25 <= 0.5"),
        (Metric.AT_MOST, 0.75, "0.75 > 0.5"),
        (Metric.AT_LEAST, 0.75, "0.75 >= 0.5"),
        (Metric.AT_LEAST, 0.25, "0.25 < 0.5"),
    ],
)
def test_the_sign_between_error_and_tolerance_is_that_of_the_verdict(
    metric: Metric, value: float, text: str
) -> None:
    case = Case("a/b", "t", "c", "s", metric, 0.5, "r", lambda: Measured(value))
    assert judgement(case.run()) == text


def raising(error: BaseException) -> object:
    def act(*_: object, **__: object) -> None:
        raise error

    return act


@pytest.mark.parametrize(
    ("error", "status", "says"),
    [
        (KeyboardInterrupt(), 130, ""),
        (ArithmeticError("no approach balances the load"), 1, "no approach balances the load"),
        (OSError(28, "No space left on device"), 1, "No space left"),
    ],
)
def test_expected_failures_are_at_most_one_line(
    error: BaseException, status: int, says: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(refimpl, "solve", raising(error))
    done = run("solve hertz --grid 8")
    assert (done.status, done.out, done.err.count("\n")) == (status, "", bool(says))
    assert says in done.err


def test_a_bug_keeps_its_traceback(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(refimpl, "solve", raising(ZeroDivisionError("a bug")))
    with pytest.raises(ZeroDivisionError, match="a bug"):
        main(["solve", "hertz", "--grid", "8"])


HOSTILE = (
    "<script>alert(1)</script>",
    '"><img src=x onerror=alert(1)>',
    "' onmouseover='alert(1)",
    "{{ 7 * 7 }}{% raw %}",
    "</title><svg onload=alert(1)>",
)


def test_texts_of_a_result_file_are_shown_in_the_report_and_not_run() -> None:
    names = ("title", "claim", "source", "note", "unit", "tolerance_reason")
    cases = [
        sample.case(f"a/{k}", **dict.fromkeys(names, text), data={text: 1.0, "m": {text: text}})
        for k, text in enumerate(HOSTILE)
    ]
    document = sample.results(*cases)
    document["provenance"] |= {"command": HOSTILE[0], "commit": HOSTILE[1]}
    page = render(json.loads(json.dumps(document)))
    for dangerous in ("<script>alert", "<img src=x", "<svg onload", "onmouseover='alert"):
        assert dangerous not in page
    assert "{{ 7 * 7 }}" in page
    assert "default-src 'none'" in page
