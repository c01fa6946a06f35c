"""`rough-friction sweep`: bad input in one line, progress for terminals only."""

from __future__ import annotations

import json
import re
import sys
from pathlib import Path

import numpy as np
import pytest

import refimpl as rf
from verification.cli import main
from verification.cli.sweep import _Line
from verification.sweep.engine import Progress, Sweep

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


@pytest.mark.parametrize("option", ["--store", "--csv", "--parquet", "--json"])
@pytest.mark.parametrize("name", ["study.toml", "scene.toml", "heights.npy"])
def test_an_output_is_no_input(
    option: str,
    name: str,
    tmp_path: Path,
    capsys: Capture,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    np.save("heights.npy", np.random.default_rng(1).standard_normal((8, 8)) * 1e-9)
    surface = '[[lower.surface]]\nkind = "measured"\npath = "heights.npy"\nunit = "m"\npixel_size = 2.1e-4\n'
    text = rf.scene_to_toml(rf.read_scene("table1-rough"))
    Path("scene.toml").write_text(text + surface)
    Path("study.toml").write_text('scene = "scene.toml"\n[vary]\ngrid = [8, 16]\n')
    before = Path(name).read_bytes()
    assert main(["sweep", "study.toml", option, name]) == 2
    assert f"{option} = '{name}'" in capsys.readouterr().err
    assert Path(name).read_bytes() == before
    assert len(list(tmp_path.iterdir())) == 3


def test_the_default_store_is_no_input(
    tmp_path: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("study.sqlite").write_text('scene = "hertz"\n[vary]\ngrid = [8]\n')
    assert main(["sweep", "study.sqlite"]) == 2
    assert "--store = 'study.sqlite'" in capsys.readouterr().err


def test_no_two_outputs_are_one_file(
    tmp_path: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("study.toml").write_text('scene = "hertz"\n[vary]\ngrid = [8]\n')
    outputs = [
        (["--store", "keep.sqlite", "--csv", "keep.sqlite"], ("--store", "--csv")),
        (["--csv", "study.sqlite"], ("--store", "--csv")),  # the default store
        (["--csv", "x.csv", "--json", "x.csv"], ("--csv", "--json")),
        (["--csv", "x.csv", "--json", "./x.csv"], ("--csv", "--json")),
        (["--csv", "-", "--json", "-"], ("--csv", "--json")),
        (["--store", "s.db", "--json", "s.db-wal"], ("--store", "--json")),
        (["--store", "s.db", "--csv", "s.db-shm"], ("--store", "--csv")),
        (["--store", "-"], ("--store",)),
        (["--parquet", "-"], ("--parquet",)),
        (["--parquet", "x.csv"], ("--parquet", ".csv")),
        (["--csv", "x.parquet"], ("--csv", ".parquet")),
        (["--json", "x.sqlite"], ("--json", ".sqlite")),
    ]
    for arguments, named in outputs:
        try:
            status = main(["sweep", "study.toml", *arguments])
        except SystemExit as usage:
            status = int(usage.code or 0)
        err = capsys.readouterr().err
        assert status == 2, arguments
        assert all(name in err for name in named), err
        assert err.count("\n") == 1
    assert [path.name for path in tmp_path.iterdir()] == ["study.toml"]


def test_csv_to_standard_output_is_all_that_is_there(
    tmp_path: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("study.toml").write_text('scene = "hertz"\n[vary]\ngrid = [8]\n')
    command = ["sweep", "study.toml", "--workers", "1", "--csv"]
    assert main([*command, "table.csv"]) == 0
    capsys.readouterr()
    assert main([*command, "-"]) == 0
    assert capsys.readouterr().out == Path("table.csv").read_text()
    assert not Path("-").exists()


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


@pytest.mark.parametrize(
    ("axes", "named"),
    [
        ("grid = [500000, 1000000]", "GB"),
        ("grid = [8, 16]\ncorrelation_length = [1e-4, 1e-9]", "correlation_length"),
        ("grid = [8, 16]\nlower_rms = [0.5, 1e-6]", "wrong unit"),
        ("grid = [8, 16]\nload = [1.0, 1e30]", "load = 1e+30"),
    ],
)
def test_what_no_run_could_pose_is_refused_before_there_is_a_store(
    axes: str, named: str, tmp_path: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("study.toml").write_text(f'scene = "table1-rough"\n[vary]\n{axes}\n')
    assert main(["sweep", "study.toml"]) == 2
    assert named in capsys.readouterr().err
    assert [path.name for path in tmp_path.iterdir()] == ["study.toml"]


LIMITED = 'scene = "table1-rough"\nrealisations = 2\n[vary]\ngrid = [12]\n[solve]\ntolerance = 1e-30\n'


def test_what_did_not_converge_is_no_success(tmp_path: Path, capsys: Capture) -> None:
    """No arithmetic meets 1e-30; whether a run stagnates or is cut off first is up to the last bits."""
    (tmp_path / "study.toml").write_text(LIMITED)
    store, table = tmp_path / "s.sqlite", tmp_path / "t.csv"
    command = ["sweep", str(tmp_path / "study.toml"), "--store", str(store), "--workers", "1"]
    assert main([*command, "--json", "-"]) == 1
    statuses = json.loads(capsys.readouterr().out)["statuses"]
    assert sum(statuses.values()) == 2
    assert set(statuses) <= {"iteration limit", "stagnated"}
    store.unlink()
    for _ in range(2):  # solved anew, and found in the store
        assert main([*command, "--csv", str(table)]) == 1
        printed = capsys.readouterr().out
        for status, count in statuses.items():
            assert re.search(rf"^  {status} +{count}$", printed, flags=re.M)
            assert table.read_text().count(f",{status},") == count
        assert "2 of 2 runs did not converge" in printed
    assert main([*command, "--csv", "-"]) == 1
    assert "2 of 2 runs did not converge" in capsys.readouterr().err


def test_a_settled_cycle_is_a_success(capsys: Capture) -> None:
    rows = [{"status": status} for status in ("converged", "cycled", "converged")]
    done = Sweep(3, 0, {}, rows, [1.0] * 3, 1.0)
    assert not done.unconverged
    assert done.statuses == {"converged": 2, "cycled": 1}


def test_progress_is_for_terminals(capsys: Capture, monkeypatch: pytest.MonkeyPatch) -> None:
    for terminal, shown in ((True, "[3/10], 1 failed 2 min left"), (False, "")):
        monkeypatch.setattr(sys.stderr, "isatty", lambda terminal=terminal: terminal)
        line = _Line()
        line.count(Progress(3, 10, 1, 125.0))
        line.close()
        written = capsys.readouterr().err
        assert (shown in written) if terminal else written == ""
