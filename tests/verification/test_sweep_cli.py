"""`rough-friction sweep`: bad input in one line, progress for terminals only."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import pytest

from verification.cli import main
from verification.cli.sweep import _Line
from verification.sweep.engine import Progress

Capture = pytest.CaptureFixture[str]


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        (["no-such-study"], "study"),
        (["table3", "--workers", "0"], "--workers"),
        (["table3", "--store", "nowhere/s.sqlite"], "--store"),
        (["table3", "--csv", "nowhere/t.csv"], "--csv"),
        ([], "STUDY"),
    ],
)
def test_bad_input_is_one_line_and_status_2(arguments: list[str], named: str, capsys: Capture) -> None:
    try:
        status = main(["sweep", *arguments])
    except SystemExit as usage:
        status = int(usage.code or 0)
    printed = capsys.readouterr()
    assert status == 2
    assert printed.out == ""
    assert printed.err.count("\n") == 1
    assert named in printed.err


def test_results_and_a_failed_run(tmp_path: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch) -> None:
    from verification.sweep import engine

    sweep = engine.sweep
    monkeypatch.setattr(engine, "sweep", lambda *a, **k: sweep(*a, **(k | {"workers": 0})))
    (tmp_path / "study.toml").write_text('scene = "table1-rough"\n[vary]\ngrid = [12]\nload = [1.0, 70.0]\n')
    arguments = ["sweep", str(tmp_path / "study.toml"), "--store", str(tmp_path / "s.sqlite"), "--json", "-"]
    assert main(arguments) == 0
    document = json.loads(capsys.readouterr().out)
    assert (document["found"], document["finished"], document["failures"]) == (0, 2, {})
    assert [row["load"] for row in document["rows"]] == [1.0, 70.0]

    def breaks(inputs: object) -> object:
        raise ValueError("no luck")

    monkeypatch.setattr(engine, "execute", breaks)
    assert main([*arguments[:-4], "--store", str(tmp_path / "other.sqlite")]) == 1
    assert "failed: ValueError: no luck" in capsys.readouterr().out


def test_progress_is_for_terminals(capsys: Capture, monkeypatch: pytest.MonkeyPatch) -> None:
    for terminal, shown in ((True, "[3/10], 1 failed 2 min left"), (False, "")):
        monkeypatch.setattr(sys.stderr, "isatty", lambda terminal=terminal: terminal)
        line = _Line()
        line.show(Progress(3, 10, 1, 125.0))
        line.close()
        written = capsys.readouterr().err
        assert (shown in written) if terminal else written == ""
