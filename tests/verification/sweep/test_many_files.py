"""A night over many files of which some cannot be read: all named at once, the rest run, the rows kept."""

from __future__ import annotations

import csv
import json
from dataclasses import replace
from pathlib import Path

import pytest

import refimpl as rf
from refimpl.errors import InputError
from tests import plate
from verification.cli import main
from verification.sweep.study_file import read_study

POINTS = (40, 30)
pytestmark = pytest.mark.usefixtures("in_this_process")


@pytest.fixture
def study(tmp_path: Path) -> Path:
    """Eight maps, and two files that are none."""
    for k in range(8):
        z = plate.sampled(plate.worn(seed=k, rms=0.05e-6), plate.CLEAN, POINTS)
        plate.write(z, tmp_path / f"map{k}.txt")
    (tmp_path / "broken.txt").write_text("power failure at 02:13")
    scene = plate.scene(plate.measured(tmp_path / "map0.txt"), load=0.05, points=POINTS)
    (tmp_path / "scene.toml").write_text(rf.scene_to_toml(replace(scene, size=None)))
    names = [f"map{k}.txt" for k in range(8)] + ["broken.txt", "lost.txt"]
    table = f'scene = "scene.toml"\n[vary]\ngrid = 64\n"lower.surface[0].path" = {json.dumps(names)}\n'
    (tmp_path / "night.toml").write_text(table)
    return tmp_path / "night.toml"


def test_all_files_that_cannot_be_read_are_named_at_once(study: Path) -> None:
    with pytest.raises(InputError, match="2 files") as refused:
        read_study(study)
    assert all(name in str(refused.value) for name in ("broken.txt", "lost.txt", "--keep-going"))


def test_keep_going_runs_the_rest_and_leaves_failed_rows(
    study: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    folder = study.parent
    given = ["--store", str(folder / "n.sqlite"), "--csv", str(folder / "n.csv")]
    picture = ["--plot", str(folder / "n.svg"), "--x", "load"]
    assert main(["sweep", str(study), "--keep-going", *given, *picture]) == 1
    rows = list(csv.DictReader((folder / "n.csv").open()))
    named = {Path(row["lower.surface[0].path"]).name: row for row in rows}
    assert len(named) == len(rows) == 10
    failed = {name for name, row in named.items() if row["status"] == "FAILED"}
    assert failed == {"broken.txt", "lost.txt"}
    assert "lost.txt" in named["lost.txt"]["warnings"]
    assert "map3.txt" not in (folder / "n.svg").read_text()  # eight files are a mean with its scatter
    printed = capfd.readouterr()
    assert "files skipped       2" in printed.out
    assert "Warning" not in printed.err


def test_where_no_file_can_be_used_the_first_ones_reason_is_told(study: Path) -> None:
    text = study.read_text()
    study.write_text(text[: text.index('["map0')] + '["lost.txt"]\n')
    with pytest.raises(InputError, match=r"lost\.txt"):
        read_study(study, keep_going=True)


def test_a_note_names_the_map_that_limits_the_domain_of_all(study: Path) -> None:
    z = plate.sampled(plate.worn(seed=9, rms=0.05e-6), plate.CLEAN, (20, 15))
    plate.write(z, study.parent / "map5.txt")
    notes = read_study(study, keep_going=True).notes
    assert notes[0].startswith("no size given: 3.2e-05 x 2.4e-05 m")
    assert notes[0].endswith("by map5.txt; the largest scene has 6.4e-05 x 4.8e-05 m")


def test_a_study_of_turns_and_height_scales_takes_the_domain_that_all_maps_cover(study: Path) -> None:
    """Keys that the scene's file leaves at their defaults vary too; the smallest domain need be no end's."""
    vary = '"lower.surface[0].height_scale" = [1.0, 1.1]\n"lower.surface[0].rotate_deg" = [0, 45, 90]\n'
    study.write_text(f'scene = "scene.toml"\n[vary]\ngrid = 16\n{vary}')
    found = read_study(study)
    assert found.notes[0].startswith("no size given: 3.36e-05 x 3.36e-05 m")  # 48 um over sqrt(2)
    surfaces = [run.inputs["scene"]["lower"]["surface"][0] for run in found.runs()]
    assert [(one["rotate_deg"], one["height_scale"]) for one in surfaces[:4]] == [
        (0, 1.0), (45, 1.0), (90, 1.0), (0, 1.1),
    ]  # fmt: skip
    assert main(["sweep", str(study), "--store", str(study.parent / "turns.sqlite"), "--workers", "1"]) == 0
