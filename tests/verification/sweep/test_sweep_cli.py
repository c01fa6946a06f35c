"""`rough-friction sweep`: tables and documents, curves of files, runs without a solution, progress."""

from __future__ import annotations

import json
import math
import re
import sys
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import refimpl as rf
from tests.verification.cli.commands import Stream, answer, run, shown
from verification.cli.sweep import _Line, directions_note
from verification.sweep import engine
from verification.sweep.curves import curves
from verification.sweep.engine import Progress, Sweep
from verification.sweep.store import COLUMNS
from verification.sweep.study_file import read_study

PATH = "lower.surface[0].path"
pytestmark = pytest.mark.usefixtures("in_this_process")


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    Path("study.toml").write_text('scene = "table1-rough"\n[vary]\ngrid = [12]\nload = [1.0, 70.0]\n')
    return tmp_path


def test_csv_to_standard_output_is_all_that_is_there() -> None:
    shown("sweep study.toml --csv table.csv")
    assert shown("sweep study.toml --csv -") == Path("table.csv").read_text()
    assert not Path("-").exists()


def test_a_document_and_a_failed_run(monkeypatch: pytest.MonkeyPatch) -> None:
    document = answer("sweep study.toml")
    assert (document["found"], document["finished"], document["failures"]) == (0, 2, {})
    assert [row["load"] for row in document["rows"]] == [1.0, 70.0]
    failed = Sweep(2, 0, {"key": "ValueError: no luck"}, [], 1.0)
    monkeypatch.setattr(engine, "sweep", lambda *_, **__: failed)
    assert "failed: ValueError: no luck" in shown("sweep study.toml", 1)


def test_a_sweep_over_maps_has_one_size_for_all_offsets_and_a_curve_for_each() -> None:
    """60 um, of which 8 are lost on both sides, and 80."""
    rng = np.random.default_rng(1)
    for name, shape in (("low", (60, 80)), ("other", (60, 80)), ("up", (50, 90))):
        np.save(f"{name}.npy", 1e-8 * rng.normal(size=shape))
    text = "load = 1e-3\n"
    for body, name in (("lower", "low"), ("upper", "up")):
        text += f'[{body}.material]\nE = 2e11\nnu = 0.3\n[[{body}.surface]]\nkind = "measured"\n'
        text += f'path = "{name}.npy"\nunit = "m"\npixel_size = 1e-6\n'
    Path("scene.toml").write_text(text)
    offsets = "sliding_offset = [0.0, -4e-6, 8e-6]"
    files = f'"{PATH}" = ["low.npy", "other.npy"]'
    Path("study.toml").write_text(f'scene = "scene.toml"\n[vary]\ngrid = [16]\n{offsets}\n{files}\n')
    found = read_study("study.toml")
    assert found.scene["size"] == pytest.approx([44e-6, 80e-6])
    assert "no size given: 4.4e-05 x 8e-05 m" in found.notes[0]
    assert run("sweep study.toml --json s.json").status == 0
    by_file = curves(json.loads(Path("s.json").read_text())["rows"], "sliding_offset", "contact_area", PATH)
    assert {Path(str(name)).name: len(points) for name, points in by_file.items()} == {
        "low.npy": 3,
        "other.npy": 3,
    }


def test_runs_that_did_not_converge_are_no_success() -> None:
    """No arithmetic meets 1e-30; whether a run stagnates or is cut off first is up to the last bits."""
    Path("study.toml").write_text(
        'scene = "table1-rough"\nrealisations = 2\n[vary]\ngrid = [12]\n[solve]\ntolerance = 1e-30\n'
    )
    statuses = answer("sweep study.toml", 1)["statuses"]
    assert sum(statuses.values()) == 2
    assert set(statuses) <= {"iteration limit", "stagnated"}
    printed = shown("sweep study.toml --csv t.csv", 1)  # found in the store
    for status, count in statuses.items():
        assert re.search(rf"^  {status} +{count}$", printed, flags=re.M)
        assert Path("t.csv").read_text().count(f",{status},") == count
    assert "2 of 2 runs did not converge" in printed
    assert "2 of 2 runs did not converge" in run("sweep study.toml --csv -").err


@pytest.mark.parametrize("status", [rf.Status.CONVERGED, rf.Status.CYCLED, rf.Status.STAGNATED])
def test_rows_are_solutions_or_not_by_their_status(
    status: rf.Status, monkeypatch: pytest.MonkeyPatch
) -> None:
    rows = [
        dict.fromkeys(COLUMNS, 1.0)
        | {"status": end, "key": key, "grid": 6, "warnings": "", "parameters": "{}"}
        for end, key in (("converged", "a"), (status.value, "b"))
    ]
    done = Sweep(0, 2, {}, rows, 3.0)
    solved = status in (rf.Status.CONVERGED, rf.Status.CYCLED)
    assert done.unconverged == ([] if solved else rows[1:])
    expected = {"converged": 2} if status is rf.Status.CONVERGED else {"converged": 1, status.value: 1}
    assert done.statuses == expected
    monkeypatch.setattr(engine, "sweep", lambda *_, **__: done)
    assert run("sweep study.toml").status == int(not solved)


def test_a_grid_that_is_too_coarse_is_reported() -> None:
    Path("study.toml").write_text(
        'scene = "table1-rough"\nrealisations = 3\n[vary]\ngrid = 16\nlower_rms = 0.8e-6\n'
    )
    assert "points: use a finer grid" in " ".join(shown("sweep study.toml").split())


def test_progress_counts_failures_and_the_time_that_is_left(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stderr", Stream(terminal=True))
    line = _Line()
    line.count(Progress(3, 10, 1, 125.0))
    line.close()
    assert "[3/10], 1 failed 2 min left" in sys.stderr.getvalue()


@pytest.mark.parametrize(
    ("turns", "hint"), [((0.0,), False), ((0.0, math.pi), False), ((0.0, 0.785, math.pi), True)]
)
def test_directions_without_their_opposite_are_remarked_on(turns: tuple[float, ...], hint: bool) -> None:
    study: Any = SimpleNamespace(vary={"sliding_direction": turns})
    assert bool(directions_note(study)) is hint
