"""Rectangles on the command line: options, JSON, picture, VTK file, sweeps, and what is refused."""

from __future__ import annotations

import json
import math
from pathlib import Path

import meshio
import numpy as np
import pytest
from PIL import Image

import refimpl as rf
from tests.verification.cli.test_cli import Capture, refused
from verification.cli import main
from verification.sweep.study_file import read_study

SCENE = """
load = 5.0
size = [2e-3, 1e-3]
[upper.material]
E = "rigid"
nu = 0.3
[[upper.surface]]
kind = "sphere"
radius = 0.05
[lower.material]
E = 3e9
nu = 0.38
[friction]
tau = 0.3e6
beta = 0.1
"""


@pytest.fixture
def scene(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    monkeypatch.chdir(tmp_path)
    Path("scene.toml").write_text(SCENE)
    return "scene.toml"


def test_outputs_of_a_rectangle(scene: str, capsys: Capture) -> None:
    wanted = ["--json", "out.json", "--plot", "out.png", "--vtk", "out.vtu"]
    assert main(["solve", scene, "--grid", "48x20", *wanted]) == 0
    assert "48 x 20 elements" in capsys.readouterr().out
    document = json.loads(Path("out.json").read_text())
    assert (document["grid"], document["size"]) == ([48, 20], [2e-3, 1e-3])
    assert "side" not in document
    found = rf.solve(rf.read_scene(scene), (48, 20))
    assert document["friction_coefficient"] == found.friction_coefficient
    with Image.open("out.png") as picture:
        assert min(picture.size) > 150
    mesh = meshio.read("out.vtu")
    assert len(mesh.points) == 2 * 48 * 20
    assert len(mesh.cells[0].data) == 2 * 47 * 19
    np.testing.assert_allclose(mesh.point_data["pressure"][: 48 * 20], found.pressure.ravel())
    assert float(np.ptp(mesh.points[:, 0])) == pytest.approx(2e-3 * 47 / 48)
    assert float(np.ptp(mesh.points[:, 1])) == pytest.approx(1e-3 * 19 / 20)


def test_the_size_may_be_another_one(scene: str, capsys: Capture) -> None:
    assert main(["solve", scene, "--size", "1e-3x3e-3", "--grid", "30", "--json", "-"]) == 0
    document = json.loads(capsys.readouterr().out)
    assert (document["grid"], document["size"]) == ([10, 30], [1e-3, 3e-3])


def test_explain_and_budget(scene: str, capsys: Capture) -> None:
    assert main(["solve", scene, "--grid", "40x20", "--explain"]) == 0
    assert "40 x 20 elements" in capsys.readouterr().out
    assert main(["solve", scene, "--accuracy", "0.05", "--explain"]) == 0
    assert "256 x 128 elements" in capsys.readouterr().out
    assert main(["solve", scene, "--grid", "40x20", "--budget", "--json", "-"]) == 0
    budget = json.loads(capsys.readouterr().out)["budget"]
    assert "upper.material.E" not in json.dumps(budget)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--grid", "48x"], "--grid"),
        (["--grid", "48x20x2"], "--grid"),
        (["--grid", "48x0"], "grid = "),
        (["--grid", "8000x1"], "grid = "),
        (["--size", "1e-3"], "--size"),
        (["--size", "1e-3x0"], "size = "),
        (["--size", "1e-3x-1"], "size = "),
        (["--size", "1e-3x1.01"], "size = "),
        (["--size", "nanx1"], "size = "),
    ],
)
def test_bad_input_ends_in_one_line(scene: str, options: list[str], said: str, capsys: Capture) -> None:
    assert said in refused(capsys, "solve", scene, *options)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("size = ", "side = 1e-3\nsize = "),
        ("[2e-3, 1e-3]", "[2e-3]"),
        ("[2e-3, 1e-3]", "[0.0, 1e-3]"),
        ("[2e-3, 1e-3]", "2e-3"),
        ("size = [2e-3, 1e-3]", ""),
        ("E = 3e9", 'E = "rigid"'),
    ],
)
def test_bad_scenes_end_in_one_line(scene: str, old: str, new: str, capsys: Capture) -> None:
    Path(scene).write_text(SCENE.replace(old, new, 1))
    refused(capsys, "solve", scene)


def test_a_sweep_of_maps_chooses_one_size_for_all_offsets(tmp_path: Path) -> None:
    rng = np.random.default_rng(1)
    for name, shape in (("low", (60, 80)), ("up", (50, 90))):
        np.save(tmp_path / f"{name}.npy", 1e-8 * rng.normal(size=shape))
    measured = '\n[[{0}.surface]]\nkind = "measured"\npath = "{1}.npy"\nunit = "m"\npixel_size = 1e-6\n'
    text = "load = 1e-3\n"
    for body, name in (("lower", "low"), ("upper", "up")):
        text += f"[{body}.material]\nE = 2e11\nnu = 0.3{measured.format(body, name)}"
    (tmp_path / "scene.toml").write_text(text)
    study = tmp_path / "study.toml"
    study.write_text('scene = "scene.toml"\n[vary]\ngrid = [16]\nsliding_offset = [0.0, -4e-6, 8e-6]\n')
    found = read_study(study)
    assert found.scene["size"] == pytest.approx([44e-6, 80e-6])  # 60 um less 8 um on both sides
    assert "no size given: 4.4e-05 x 8e-05 m" in found.notes[0]
    assert (
        main(["sweep", str(study), "--store", str(tmp_path / "s.sqlite"), "--csv", str(tmp_path / "s.csv")])
        == 0
    )
    rows = (tmp_path / "s.csv").read_text().splitlines()
    assert len(rows) == 4


def test_a_sweep_of_a_rectangle(tmp_path: Path) -> None:
    (tmp_path / "scene.toml").write_text(SCENE)
    study = tmp_path / "study.toml"
    study.write_text('scene = "scene.toml"\n[vary]\ngrid = [24]\nload = [1.0, 5.0]\n')
    runs = list(read_study(study).runs())
    assert [run.inputs["scene"]["size"] for run in runs] == [[2e-3, 1e-3]] * 2
    assert (
        main(["sweep", str(study), "--store", str(tmp_path / "s.sqlite"), "--csv", str(tmp_path / "s.csv")])
        == 0
    )
    row = (tmp_path / "s.csv").read_text().splitlines()[-1].split(",")
    mu = rf.solve(rf.read_scene(tmp_path / "scene.toml"), 24).friction_coefficient
    assert any(
        math.isclose(float(cell), mu, rel_tol=1e-12) for cell in row if cell.replace(".", "").isdigit()
    )
