"""The command line as a person or a program meets it: exit statuses, one-line refusals, JSON, whole files."""

from __future__ import annotations

import argparse
import json
import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

from tests.documents import ROOT
from tests.reports import sample
from verification.cli import main, parser, verify
from verification.cli.options import numbers
from verification.cli.output import WIDTH, StatusLine, columns
from verification.framework import registry, runner
from verification.framework.case import Case, Measured, Metric, Status, Tier

QUICK = "kernels/love-at-centre"
FEM = ["appendix-a", "fem", "--slope-deg=6.5", "--wavelength=100", "--position=0.25", "--offsets=-3,3"]
WEDGE = ["appendix-a", "wedge", "--r=1", "--theta-deg=0"]
ELEMENT = ["appendix-a", "element", "--slope-deg=9", "--nu=0.3"]

Capture = pytest.CaptureFixture[str]


def refused(capsys: Capture, *arguments: str) -> str:
    """Run a command that must be refused: status 2, one line on stderr, nothing on stdout."""
    try:
        status = main(arguments)
    except SystemExit as usage:
        status = int(usage.code or 0)
    printed = capsys.readouterr()
    assert status == 2
    assert printed.out == ""
    assert printed.err.count("\n") == 1
    assert "Traceback" not in printed.err
    return printed.err


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


@pytest.mark.parametrize("command", commands(), ids=" ".join)
def test_every_command_has_help(command: list[str], capsys: Capture) -> None:
    with pytest.raises(SystemExit) as done:
        main([*command, "--help"])
    assert done.value.code == 0
    assert "usage: rough-friction" in capsys.readouterr().out


@pytest.mark.parametrize("command", commands(), ids=" ".join)
def test_every_help_has_examples_that_parse_and_fits_100_columns(
    command: list[str], monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    monkeypatch.setenv("COLUMNS", "100")
    with pytest.raises(SystemExit):
        main([*command, "--help"])
    shown = capsys.readouterr().out
    assert max(map(len, shown.splitlines())) <= 100
    examples = re.findall(r"^  rough-friction (.*)$", shown.replace("\\\n", ""), flags=re.M)
    assert examples
    for example in examples:
        assert callable(parser().parse_args(shlex.split(example)).run), example
    assert any(shlex.split(example)[: len(command)] == command for example in examples)


def test_cases_that_examples_name_are_there() -> None:
    """In the help of `verify`, and in the commands of committed results."""
    said = [verify.EPILOG, (ROOT / "reports" / "results" / "README.md").read_text(encoding="utf-8")]
    examples = re.findall(r"rough-friction (verify [^`\n]*--only[^`\n]*)", "\n".join(said))
    assert len(examples) >= 10
    for example in examples:
        asked = parser().parse_args(shlex.split(example))
        assert registry.select(registry.load(), Tier(asked.tier), asked.only), example


def test_every_command_that_computes_takes_json(capsys: Capture) -> None:
    groups = {tuple(c[:-1]) for c in commands() if c}
    for command in commands():
        if tuple(command) not in groups:
            with pytest.raises(SystemExit):
                main([*command, "--help"])
            assert "--json FILE" in capsys.readouterr().out, command


def test_help_does_not_wait_for_numpy() -> None:
    check = "import sys; import verification.cli as c; c.parser(); sys.exit('numpy' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", check], check=False).returncode == 0


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ([], "required"),
        (["nonsense"], "nonsense"),
        (["verify", "--tier", "nightly"], "nightly"),
        (["verify", "--only", "none/*"], "none/*"),
        (["verify", "--jobs", "0"], "--jobs = 0"),
        (["verify", "--json", "/no/such/folder/results.json"], "/no/such/folder"),
        (["verify", "--json", "."], "directory"),
        (["verify", "--json", ""], "--json: expected a file's name, or '-' for standard output"),
        (["sweep", "table3", "--store", ""], "--store: expected a file's name"),
        (["report", "--results", "no-such-file.json"], "no-such-file.json"),
        (["report", "--results", "."], "--results"),
        (["appendix-a"], "required"),
        ([*WEDGE, "--gamma-deg", "10", "--r", "x"], "'x'"),
        (
            [*WEDGE, "--gamma-deg", "95"],
            "--gamma-deg = 95.0: expected a slope angle of 0 to below 90 degrees",
        ),
        ([*WEDGE, "--gamma-deg", "nan"], "'nan'"),
        (
            [*WEDGE, "--gamma-deg", "45", "--r", "1e308", "--half-width", "1e-300"],
            "--r = 1e+308: expected positive distances of 1e-300 to 1e+300 half-widths",
        ),
        ([*WEDGE, "--gamma-deg", "89.999999"], "--gamma-deg = 89.999999: expected a smaller slope angle"),
        (
            [*WEDGE, "--gamma-deg", "10", "--theta-deg", "10,85"],
            "--theta-deg = 85.0: expected angles within the faces at +-80 degrees",
        ),
        ([*WEDGE, "--gamma-deg", "10", "--r", "1,-1"], "--r = -1.0"),
        ([*WEDGE, "--gamma-deg", "10", "--half-width", "0"], "--half-width = 0.0"),
        ([*FEM, "--nu", "0.6"], "--nu = 0.6"),
        (
            [*FEM, "--nu", "0.3", "--slope-deg", "50"],
            "--slope-deg = 50.0: expected a maximum slope of 0 to 45 deg",
        ),
        ([*FEM, "--nu", "0.3", "--offsets", "0,1e5"], "--offsets = [0.0, 100000.0]"),
        (["appendix-a", "strip", *FEM[2:], "--nu", "0.3", "--slope-deg", "95"], "--slope-deg = 95.0"),
        (["appendix-a", "strip", *FEM[2:], "--nu", "0.3", "--offsets", "nan"], "--offsets: 'nan'"),
        (["appendix-a", "map", "--slopes-deg", "6,50"], "--slopes-deg = 50.0: expected 0.1 to 45 degrees"),
        (["appendix-a", "map", "--slopes-deg", "0"], "--slopes-deg"),
        (["appendix-a", "map", "--wavelengths", "1,10"], "--wavelengths"),
        (["appendix-a", "map", "--positions", "nan"], "--positions"),
        (["appendix-a", "map", "--slopes-deg", "2.5,2.5"], "--slopes-deg = (2.5, 2.5)"),
        (["appendix-a", "map", "--positions", "0.5,0"], "--positions"),
        (["appendix-a", "map", "--jobs", "0"], "--jobs"),
        (["appendix-a", "map", "--wavelengths", "5,10001"], "4 to 10000 half-widths"),
        (["appendix-a", "map", "--positions", "0,0.51"], "0 to 0.5 wavelengths"),
        ([*WEDGE, "--gamma-deg", "90"], "0 to below 90 degrees"),
        ([*ELEMENT, "--upper-nu=0.3"], "--upper-E = None: expected both"),
        ([*ELEMENT, "--upper-nu=0.3", "--upper-E=0"], "--upper-E = 0.0"),
        (["appendix-a", "surface", "hertz", "--pixel-size", "1e-6"], "--pixel-size = 1e-06"),
        (["identify", "hertz", "a.csv", "--loads", "5;8"], "'5;8' is no list of numbers"),
        (["tradeoff", "hertz", "--grids", "3,8"], "fewer than 4 elements"),
        (["verify", "--export", "/dev/null/d", "--list"], "no other action"),
    ],
)
def test_bad_input_is_refused_in_one_line(arguments: list[str], says: str, capsys: Capture) -> None:
    assert says in refused(capsys, *arguments)


def test_verify_writes_what_the_report_reads(tmp_path: Path, capsys: Capture) -> None:
    results, folder = tmp_path / "results.json", tmp_path / "report"
    assert main(["verify", "--only", QUICK, "--jobs", "1", "--json", str(results)]) == 0
    printed = capsys.readouterr()
    assert f"pass  {QUICK}" in printed.out
    assert "1 pass, 0 fail, 0 error, 0 unavailable" in printed.out
    assert printed.err == ""
    (none := tmp_path / "committed").mkdir()  # the README's own command draws those
    shown = ["--committed", str(none), "--output", str(folder), "--json", "-"]
    assert main(["report", "--results", str(results), *shown]) == 0
    made = json.loads(capsys.readouterr().out)
    assert made["counts"] == {"pass": 1, "fail": 0, "error": 0, "unavailable": 0}
    assert QUICK in Path(made["report"]).read_text(encoding="utf-8")
    assert [p.name for p in folder.iterdir()] == ["report.html"]


@pytest.mark.parametrize("status", [Status.FAIL, Status.ERROR, Status.UNAVAILABLE])
def test_verify_without_a_pass_has_status_1(
    status: Status, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    case = Case("a/b", "t", "c", "s", Metric.EQUAL, 0.0, "exact", lambda: Measured(1.0, 1.0))
    done = runner.Run(Tier.QUICK, (), (case.result(status, "the reason", 0.0),), 0.0)
    monkeypatch.setattr(runner, "run", lambda *_, **__: done)
    assert main(["verify", "--only", QUICK]) == 1
    printed = capsys.readouterr().out
    assert f"{status.value}" in printed
    assert ("the reason" in printed) is (status is not Status.FAIL)


def test_list_runs_nothing(monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    monkeypatch.delattr(runner, "run")
    assert main(["verify", "--list", "--tier", "full", "--json", "-"]) == 0
    listed = json.loads(capsys.readouterr().out)
    assert [c["id"] for c in listed] == [c.id for c in registry.load()]


@pytest.mark.parametrize(
    "text", ["{", '{"format": "another"}', "[]", "\x00", '{"seconds": ' + "1" * 5000 + "}"]
)
def test_report_refuses_what_is_not_a_result_file(text: str, tmp_path: Path, capsys: Capture) -> None:
    path = tmp_path / "results.json"
    path.write_text(text)
    assert "--results" in refused(capsys, "report", "--results", str(path), "--output", str(tmp_path / "r"))
    assert not (tmp_path / "r").exists()


def test_a_report_replaces_none_of_its_files(
    tmp_path: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    results = tmp_path / "results.json"
    results.write_text(json.dumps(sample.results(sample.case("a/1"))))
    before, output = results.read_text(), tmp_path / "report"
    command = ["report", "--results", str(results), "--output", str(output), "--json"]
    assert "--json" in refused(capsys, *command, str(results))
    output.write_text("a file")
    with monkeypatch.context() as drawing:  # it takes a minute, and is not begun
        drawing.setattr("reports.generator.render", lambda *_: pytest.fail("drawn"))
        for folder in (output, output / "below"):
            named = ["report", "--results", str(results), "--output", str(folder)]
            assert "--output" in refused(capsys, *named)
    assert output.read_text() == "a file"
    output.unlink()
    output.mkdir()
    err = refused(capsys, *command, str(output / "report.html"))
    assert "--json" in err
    assert "--output" in err
    assert results.read_text() == before
    assert not list(output.iterdir())


@pytest.mark.parametrize("number", ["-1e-6", "-1E-06", "-.5e-6", "-0.000001"])
def test_a_negative_number_is_a_value(number: str, capsys: Capture) -> None:
    assert main(["solve", "rough-planes", "--grid", "16", "--approach", number, "--json", "-"]) == 0
    assert json.loads(capsys.readouterr().out)["approach"] == pytest.approx(float(number), rel=1e-12)


def test_a_list_that_starts_with_a_minus_sign_is_a_value(capsys: Capture) -> None:
    wave = ["--slope-deg", "0.5", "--wavelength", "50", "--position", "0.25", "--nu", "0.3", "--json", "-"]
    assert main(["appendix-a", "strip", *wave, "--offsets", "-3,3"]) == 0
    assert json.loads(capsys.readouterr().out)["offsets"] == [-3.0, 3.0]


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["solve", "hertz", "--approach", "-inf"], "approach = -inf"),
        (["solve", "hertz", "--accuracy", "-1e-3"], "accuracy = -0.001"),
        (["solve", "hertz", "--grid", "-8"], "grid = -8"),
        (["solve", "hertz", "--approach", "--budget"], "--approach"),
        (["solve", "hertz", "-1e-6"], "-1e-6"),
    ],
)
def test_what_follows_a_minus_sign_is_judged_by_its_option(
    arguments: list[str], says: str, capsys: Capture
) -> None:
    assert says in refused(capsys, *arguments)


def test_number_lists() -> None:
    assert numbers("-10,3") == [-10.0, 3.0]
    with pytest.raises(argparse.ArgumentTypeError):
        numbers("1;2")


def test_tables_keep_within_their_width() -> None:
    rows = [["case", "a reason that goes on " * 9], ["other", "short"]]
    lines = columns(rows).splitlines()
    assert max(map(len, lines)) <= WIDTH
    assert " ".join(columns(rows).split()) == " ".join(" ".join(row) for row in rows).replace("  ", " ")
    assert [line.startswith(" " * 9) for line in lines] == [False, *[True] * (len(lines) - 2), False]


@pytest.mark.parametrize("terminal", [True, False])
def test_a_status_line_is_for_terminals(
    terminal: bool, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    monkeypatch.setattr(sys.stderr, "isatty", lambda: terminal)
    line = StatusLine()
    line.show("one " * 100)
    line.show("too soon")
    line.close()
    line.show("two")
    line.close()
    shown = capsys.readouterr().err
    assert shown.replace("\r\x1b[K", "|") == ("|" + ("one " * 100)[:78] + "||two|" if terminal else "")


def test_columns_of_nothing_are_nothing() -> None:
    assert columns([]) == ""


def test_an_unknown_error_keeps_its_traceback(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(*_: object, **__: object) -> None:
        raise RuntimeError("a bug")

    monkeypatch.setattr(registry, "load", broken)
    with pytest.raises(RuntimeError, match="a bug"):
        main(["verify", "--list"])


def test_an_interrupt_ends_without_a_traceback(monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    def interrupted(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(registry, "load", interrupted)
    assert main(["verify", "--list"]) == 130
    assert capsys.readouterr().err == ""
