"""Studies vary files, seeds, tau and beta by full name; points whose error bar is too long are counted."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import refimpl as rf
from refimpl.errors import InputError
from tests.verification.sweep.test_quality import row
from verification.cli import main, plot_curves
from verification.sweep.curves import curves
from verification.sweep.export import unit_of
from verification.sweep.quality import points_of, quality_of
from verification.sweep.study_file import study_from_dict

Capture = pytest.CaptureFixture[str]
PATH, SEED = "lower.surface[0].path", "lower.surface[0].seed"
MEASURED = """load = 1e-3
side = 16e-6
[upper.material]
E = 1e9
nu = 0.3
[upper.surface]
kind = "sphere"
radius = 1e-4
[lower.material]
E = 1e9
nu = 0.3
[lower.surface]
kind = "measured"
path = "a.npy"
unit = "m"
pixel_size = 1e-6
"""


@pytest.fixture
def maps(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A scene with a measured surface, and three maps, in the working directory."""
    (tmp_path / "scene.toml").write_text(MEASURED)
    for k, name in enumerate("abc"):
        np.save(tmp_path / f"{name}.npy", 1e-9 * np.random.default_rng(k).standard_normal((16, 16)))
    monkeypatch.chdir(tmp_path)
    return tmp_path


def study(**vary: Any) -> Any:
    return study_from_dict({"scene": "table1-rough", "vary": {"grid": 8} | vary})


def test_files_vary_and_each_run_counts_by_its_own(maps: Path) -> None:
    def keys(names: list[str]) -> list[str]:
        found = study_from_dict({"scene": "scene.toml", "vary": {"grid": 8, PATH: names}}, maps)
        assert {Path(path).name for path in found.files} == {"scene.toml", "a.npy", *names}
        return [run.key for run in found.runs()]

    before = keys(["b.npy", "c.npy"])
    assert len(set(before)) == 2
    np.save(maps / "c.npy", 2e-9 * np.random.default_rng(2).standard_normal((16, 16)))
    after = keys(["b.npy", "c.npy"])
    assert after[0] == before[0]
    assert after[1] != before[1]


def test_a_sweep_over_files_has_a_curve_for_each(maps: Path, capsys: Capture) -> None:
    text = f'scene = "scene.toml"\n[vary]\ngrid = 8\nload = [1e-3, 2e-3]\n"{PATH}" = ["b.npy", "c.npy"]\n'
    Path("study.toml").write_text(text)
    assert main(["sweep", "study.toml", "--workers", "1", "--plot", "mu.svg", "--json", "s.json"]) == 0
    rows = json.loads(Path("s.json").read_text())["rows"]
    assert len(rows) == 4
    found = curves(rows, "load", "friction_coefficient", PATH)
    assert [Path(str(name)).name for name in found] == ["b.npy", "c.npy"]
    assert all(len(points) == 2 for points in found.values())
    assert plot_curves._entry(PATH, "/far/away/b.npy") == f"{PATH} = b.npy"
    assert main(["sweep", "study.toml", "--csv", "b.npy"]) == 2  # an input
    assert "--csv" in capsys.readouterr().err


def test_seeds_are_realisations() -> None:
    found = study(**{SEED: [0, 6]})
    assert [run.inputs["scene"]["lower"]["surface"][0]["seed"] for run in found.runs()] == [0, 6]
    rows = [
        row(0, 0.1, 1.0) | {"parameters": json.dumps({SEED: 5})},
        row(0, 0.3, 1.0) | {"parameters": json.dumps({SEED: 6})},
        row(0, 0.3, 1.0) | {"parameters": json.dumps({SEED: 6, "lower.material.E": 1.0})},
    ]
    assert [len(group) for group in points_of(rows).values()] == [2, 1]


def test_tau_and_beta_by_their_full_names_are_the_axes() -> None:
    assert study(**{"friction.tau": [1e6, 2e6]}).vary["tau"] == (1e6, 2e6)
    same = [[run.key for run in study(**{name: 0.2}).runs()] for name in ("beta", "friction.beta")]
    assert same[0] == same[1]


@pytest.mark.parametrize(
    ("vary", "named"),
    [
        ({PATH: ["b.npy"]}, PATH),  # the lower surface is not measured
        ({SEED: [1.5]}, SEED),
        ({SEED: [-1]}, SEED),
        ({SEED: [1, 1]}, SEED),
        ({"tau": 1e6, "friction.tau": 1e6}, "friction.tau"),
    ],
)
def test_bad_axes_are_refused(vary: dict[str, Any], named: str) -> None:
    with pytest.raises(InputError) as refused:
        study(**vary)
    assert named in str(refused.value)


@pytest.mark.parametrize("names", [["b.npy", "b.npy"], [], [1], "none.npy", ""])
def test_bad_files_are_refused(names: object, maps: Path) -> None:
    with pytest.raises(InputError):
        study_from_dict({"scene": "scene.toml", "vary": {"grid": 8, PATH: names}}, maps)


def test_seeds_and_realisations_exclude_one_another() -> None:
    with pytest.raises(InputError, match="realisations = 3"):
        study_from_dict({"scene": "table1-rough", "realisations": 3, "vary": {"grid": 8, SEED: [1, 2]}})


def test_points_whose_bar_exceeds_their_scatter_are_counted() -> None:
    # errors are 0.01: at load 1 the realisations differ by 0.2, at loads 2 and 3 by nothing
    pairs = [(1.0, 0.1, 0.3), (2.0, 0.2, 0.2), (3.0, 0.2, 0.2), (4.0, 0.1, 0.3), (5.0, 0.1, 0.3)]
    rows = [row(k, mu, 1.0) | {"load": load} for load, *both in pairs for k, mu in enumerate(both)]
    mu, _ = quality_of(rows)
    assert (mu.points, mu.biased, mu.is_biased) == (5, 2, False)


def test_a_sweep_says_where_the_grid_is_too_coarse(
    tmp_path: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("study.toml").write_text(
        'scene = "table1-rough"\nrealisations = 3\n[vary]\ngrid = 16\nload = [1.0, 70.0]\n'
        "lower_rms = 0.8e-6\n"
    )
    assert main(["sweep", "study.toml", "--workers", "1"]) == 0
    assert "points: use a finer grid" in " ".join(capsys.readouterr().out.split())


def test_units_and_labels_of_full_names() -> None:
    assert [unit_of(name) for name in ("upper.material.E", "lower.surface[1].lay", SEED, PATH)] == [
        "Pa", "rad", "", "",
    ]  # fmt: skip
    assert plot_curves.label("sliding_offset") == "sliding distance (µm)"
    assert plot_curves._entry("lower.material.hardness", 4e8) == "lower.material.hardness = 400 MPa"


def test_every_parameter_of_a_scene_can_vary() -> None:
    scene = rf.read_scene("table1-rough")
    for name, value in rf.scene.parameters.parameters(scene).items():
        found = study(**{name: int(value) if name.endswith("seed") else value})
        assert len(found) == 1
