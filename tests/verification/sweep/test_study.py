"""Study files: what they expand to, what identifies a run, and what is refused before any work."""

from __future__ import annotations

import dataclasses
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import refimpl as rf
from refimpl.errors import InputError
from refimpl.measured import measured_surface as measured
from refimpl.scene.scene_file import read_scene, scene_to_dict
from verification.sweep import study as study_module
from verification.sweep.run import COORDINATES, execute
from verification.sweep.study import Study
from verification.sweep.study_file import read_study, shipped_studies, study_from_dict

BASE: dict[str, Any] = {"scene": "table1-rough", "realisations": 2, "vary": {"grid": [16]}}


def varied(**axes: list[float]) -> Study:
    return study_from_dict(BASE | {"vary": {"grid": [16], **axes}})


def test_every_combination_once() -> None:
    study = varied(load=[14, 70.0], lower_rms=[0.0, 1e-6, 2e-6])
    with pytest.raises(dataclasses.FrozenInstanceError):
        study.realisations = 3  # type: ignore[misc]  # the point of the test
    runs = list(study.runs())
    assert len(runs) == len(study) == 2 * 2 * 3
    assert len({run.key for run in runs}) == len(runs)
    points = {(r.coordinates["realisation"], r.coordinates["load"], r.coordinates["lower_rms"]) for r in runs}
    assert points == {(k, P, s) for k in (0, 1) for P in (14.0, 70.0) for s in (0.0, 1e-6, 2e-6)}


def test_realisations_differ_in_their_seeds_only_and_keep_them_over_the_axes() -> None:
    runs = list(varied(lower_rms=[1e-6, 2e-6]).runs())
    seeds = [[part.get("seed") for part in run.inputs["scene"]["lower"]["surface"]] for run in runs]
    assert seeds == [[2], [2], [4], [4]]
    assert runs[0].inputs["scene"]["upper"]["surface"][-1]["seed"] == 1


def test_every_input_and_the_code_change_the_key(monkeypatch: pytest.MonkeyPatch) -> None:
    changes = [{}, {"grid": [24]}, {"load": [69.0]}, {"beta": [0.0]}, {"sliding_offset": [1e-6]}]
    studies = [study_from_dict(BASE | {"vary": {"grid": [16]} | change}) for change in changes]
    assert len({next(study.runs()).key for study in studies}) == len(changes)
    assert next(varied(load=[14]).runs()).key == next(varied(load=[14.0]).runs()).key
    before = next(varied().runs())
    monkeypatch.setattr(study_module, "code_digest", lambda: "another version")
    after = next(varied().runs())
    assert before.key != after.key
    with pytest.raises(RuntimeError, match="differs"):
        execute(after.inputs)


@pytest.mark.parametrize("name", shipped_studies())
def test_shipped_studies_are_good(name: str) -> None:
    assert tuple(next(iter(read_study(name).runs())).coordinates) == COORDINATES


def test_one_realisation_without_a_first_seed_is_the_scene_itself() -> None:
    base = scene_to_dict(read_scene("table1-rough"))
    for side, seed in (("upper", 5), ("lower", 8)):
        for part in base[side]["surface"]:
            part |= {"seed": seed} if part["kind"] == "gaussian" else {}
    bare = study_from_dict({"scene": "table1-rough", "vary": {"grid": 8}})
    scene = next(replace(bare, scene=base).runs()).inputs["scene"]
    assert {name: scene[name] for name in ("upper", "lower")} == {
        name: base[name] for name in ("upper", "lower")
    }
    assert study_from_dict({"scene": "table1-rough", "vary": {"grid": 8}, "realisations": 2}).first_seed == 1


PATH, SEED = "lower.surface[0].path", "lower.surface[0].seed"
ONE = {"scene": "hertz", "realisations": 1}
LONG = {"grid": [16], "lower_rms": [0], "correlation_length": [1e-4, 1e-2, 1e-3]}  # beyond the domain
REFUSED: list[tuple[str, dict[str, Any]]] = [
    ("study.colour", {"colour": 1}),
    ("scene", {"scene": None}),
    ("realisations", {"realisations": True}),
    ("first_seed", {"first_seed": 2**63 - 2}),
    ("normalise", {"normalise": 1}),
    ("vary", {"vary": [1]}),
    ("vary.grid", {"vary": {"grid": [16.5]}}),
    ("vary.grid", {"vary": {"grid": [16, 16]}}),
    ("vary.grid", {"vary": {"grid": True}}),
    ("vary.grid", {"solve": {"accuracy": 0.1}}),
    ("solve.quantity", {"solve": {"quantity": "contact_area"}}),
    ("vary.colour", {"vary": {"grid": [16], "colour": [1]}}),
    ("vary.load", {"vary": {"grid": [16], "load": [float("nan")]}}),
    ("vary.lower_rms", {"scene": "table1-smooth", "vary": {"grid": [16], "lower_rms": [1e-6]}}),
    ("realisations", {"scene": "hertz", "realisations": 3}),
    ("realisations", {"vary": {"grid": [16], "upper_rms": [0.0], "lower_rms": [0.0]}}),
    ("realisations", {"vary": {"grid": 8, SEED: [0, 6]}}),
    ("vary.correlation_length", ONE | {"vary": {"grid": [16], "correlation_length": [1e-4, 2e-4]}}),
    ("solve.method", {"solve": {"method": "x"}}),
    ("solve.method", {"scene": "rough-planes", "realisations": 1, "solve": {"method": "paper"}}),
    ("solve.tolerance", {"solve": {"tolerance": -1}}),
    ("solve.oblique", {"solve": {"oblique": "yes"}}),
    ("oblique", {"solve": {"oblique": False, "slope_correction": True}}),
    ("load", {"vary": {"grid": [16], "load": [70.0, 1e30]}}),
    ("lower.surface", {"vary": {"grid": [16], "lower_rms": [0.5, 1e-6]}}),
    ("lower.surface[0].correlation_length", {"vary": {"grid": [8, 16], "correlation_length": [1e-9, 1e-4]}}),
    ("upper.surface[1].normalise", {"normalise": True, "vary": LONG}),
    ("vary", {"realisations": 10**6, "vary": {"grid": [16], "load": [1, 2]}}),
    (f"vary.{PATH}", {"realisations": 1, "vary": {"grid": 8, PATH: ["b.npy"]}}),  # no measured surface
    (f"vary.{SEED}", {"realisations": 1, "vary": {"grid": 8, SEED: [-1]}}),
    ("vary.friction.tau", {"vary": {"grid": 8, "tau": 1e6, "friction.tau": 1e6}}),
    ("vary.lower.surface[0].rms", {"vary": {"grid": 8, "lower_rms": 1e-6, "lower.surface[0].rms": 2e-6}}),
]


@pytest.mark.parametrize(("field", "change"), REFUSED)
def test_bad_studies_are_refused_by_name(field: str, change: dict[str, Any]) -> None:
    with pytest.raises(InputError) as refused:
        study_from_dict(BASE | change)
    assert refused.value.field == field


def heights(seed: int, scale: float = 1e-9) -> np.ndarray:
    return scale * np.random.default_rng(seed).standard_normal((16, 16))


@pytest.fixture
def maps(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A scene of 8 um on a surface of which 16 um were measured, and three maps, in the working directory."""
    monkeypatch.chdir(tmp_path)
    Path("scene.toml").write_text(
        "load = 1e-3\nside = 8e-6\n[upper.material]\nE = 1e9\nnu = 0.3\n"
        "[upper.surface]\nkind='sphere'\nradius=1e-4\n[lower.material]\nE = 1e9\nnu = 0.3\n"
        "[lower.surface]\nkind = 'measured'\npath = 'a.npy'\nunit = 'm'\npixel_size = 1e-6\n"
    )
    for seed, name in enumerate("abc"):
        np.save(f"{name}.npy", heights(seed))
    return tmp_path


@pytest.fixture
def reads(monkeypatch: pytest.MonkeyPatch) -> list[object]:
    """A list that grows whenever a measured file is read."""
    counted: list[object] = []
    read = measured.read
    monkeypatch.setattr(measured, "read", lambda *a: (counted.append(a), read(*a))[1])
    return counted


def test_measured_surfaces_vary_by_file_and_count_by_content(maps: Path) -> None:
    def keys() -> list[str]:
        table = {"scene": "scene.toml", "vary": {"grid": 8, PATH: ["b.npy", "c.npy"]}}
        found = study_from_dict(table, maps)
        assert {Path(path).name for path in found.files} == {"scene.toml", "a.npy", "b.npy", "c.npy"}
        assert all(execute(run.inputs)["contact_area"] > 0 for run in found.runs())
        return [run.key for run in found.runs()]

    before = keys()
    assert len(set(before)) == 2
    np.save("c.npy", heights(2, 2e-9))
    after = keys()
    assert after[0] == before[0]
    assert after[1] != before[1]


def test_seeds_are_realisations() -> None:
    runs = study_from_dict({"scene": "table1-rough", "vary": {"grid": 8, SEED: [0, 6]}}).runs()
    assert [run.inputs["scene"]["lower"]["surface"][0]["seed"] for run in runs] == [0, 6]


def test_every_parameter_of_a_scene_varies_by_its_full_name() -> None:
    for name, value in rf.scene.parameters.parameters(rf.read_scene("table1-rough")).items():
        vary = {"grid": 8, name: int(value) if name.endswith("seed") else value}
        assert len(study_from_dict({"scene": "table1-rough", "vary": vary})) == 1
    assert varied(**{"friction.tau": [1e6, 2e6]}).vary["tau"] == (1e6, 2e6)
    same = [[run.key for run in varied(**{name: [0.2]}).runs()] for name in ("beta", "friction.beta")]
    assert same[0] == same[1]


TURNS = {"grid": [8], "sliding_direction": [0.0, 1.5707963267948966, 0.5]}


@pytest.mark.parametrize("offsets", [[0.0, 5e-6, 1e-6], [-5e-6, 1e-6]])
def test_a_slide_off_a_measured_surface_is_refused_at_once(offsets: list[float], maps: Path) -> None:
    with pytest.raises(InputError) as refused:
        study_from_dict({"scene": "scene.toml", "vary": TURNS | {"sliding_offset": offsets}}, maps)
    assert (refused.value.field, refused.value.value) == ("sliding_offset", max(offsets, key=abs))


def test_a_slide_within_it_is_good_and_the_file_is_read_once(maps: Path, reads: list[object]) -> None:
    axes = TURNS | {"sliding_offset": [-4e-6, 0.0, 4e-6]}
    assert len(study_from_dict({"scene": "scene.toml", "vary": axes}, maps)) == 9
    assert len(reads) == 1


def test_only_what_differs_in_its_limits_is_sampled(monkeypatch: pytest.MonkeyPatch) -> None:
    sampled: list[tuple[float, int]] = []
    heights = rf.Scene.sampled

    def counted(scene: rf.Scene, grid: rf.Grid) -> object:
        sampled.append((scene.sliding_offset, grid.shape[0]))
        return heights(scene, grid)

    monkeypatch.setattr(rf.Scene, "sampled", counted)
    axes = {
        "grid": [16, 4096],
        "load": [10.0, 20.0, 30.0],
        "lower_rms": [1e-6, 2e-6],
        "sliding_direction": [0.0, 0.5, 1.0],
        "correlation_length": [1e-4, 2e-4, 3e-4],
    }
    study_from_dict(BASE | {"realisations": 100, "vary": axes})
    assert sampled == [(0.0, 256)] * 2  # the shortest and the longest correlation


@pytest.mark.parametrize(
    "text",
    [
        "= 1",
        'scene = "hertz"\n[vary]\ngrid = [8]\nload = [' + "1" * 400 + "]",  # beyond every double
        'scene = "' + "x" * 5000 + '"\n[vary]\ngrid = [8]\n',  # longer than a file's name may be
    ],
    ids=["no TOML", "400 digits", "long name"],
)
def test_files_that_are_no_study(text: str, tmp_path: Path) -> None:
    (tmp_path / "bad.toml").write_text(text)
    for path in (tmp_path / "bad.toml", tmp_path / "none.toml", "no-such-study", "x" * 5000):
        with pytest.raises(InputError):
            list(read_study(path).runs())


SELF_AFFINE = """
[upper.material]
E = 2e11
nu = 0.3
[[upper.surface]]
kind = "gaussian"
rms = 1e-7
correlation_length = [3e-4, 1e-4]
seed = 1
lay = 0.3
[lower.material]
E = 2e11
nu = 0.3
[[lower.surface]]
kind = "self_affine"
hurst = 0.8
rms_gradient = 0.01
roll_off = 3e-4
long_cut = 6e-4
short_cut = 1e-4
seed = 1
"""


def test_numbers_of_surfaces_vary_by_their_full_names(tmp_path: Path) -> None:
    (tmp_path / "scene.toml").write_text(f"load = 1.0\nside = 1e-3\n{SELF_AFFINE}")
    axes = {
        "lower.surface[0].hurst": [0.3, 0.8],
        "lower.surface[0].short_cut": [5e-5, 1e-4],
        "upper.surface[0].correlation_length[1]": [5e-5],
        "upper.surface[0].lay": [0.0, 0.5],
    }
    table = {"scene": "scene.toml", "realisations": 2, "vary": {"grid": [32], **axes}}
    runs = list(study_from_dict(table, tmp_path).runs())
    assert len(runs) == len({run.key for run in runs}) == 16
    last = runs[-1].inputs["scene"]
    assert last["lower"]["surface"][0]["hurst"] == 0.8
    assert last["lower"]["surface"][0]["seed"] == 4
    assert last["upper"]["surface"][0]["correlation_length"] == [3e-4, 5e-5]
    assert last["upper"]["surface"][0]["lay"] == 0.5
    assert '"lower.surface[0].hurst": 0.8' in runs[-1].coordinates["parameters"]
    assert execute(runs[-1].inputs)["status"] == "converged"


@pytest.mark.parametrize(
    ("field", "axis", "values"),
    [
        ("vary.lower.surface[0].rms", "lower.surface[0].rms", [1e-7]),
        ("vary.lower_rms", "lower_rms", [1e-7]),
        ("vary.correlation_length", "correlation_length", [1e-4]),
        ("vary.upper.material.hardness", "upper.material.hardness", [1e9]),
        ("lower.surface[0].long_cut", "lower.surface[0].long_cut", [6e-4, 1e-4]),
    ],
)
def test_bad_numbers_of_surfaces_are_refused(
    tmp_path: Path, field: str, axis: str, values: list[float]
) -> None:
    (tmp_path / "scene.toml").write_text(f"load = 1.0\nside = 1e-3\n{SELF_AFFINE}")
    with pytest.raises(InputError) as refused:
        study_from_dict({"scene": "scene.toml", "vary": {"grid": [32], axis: values}}, tmp_path)
    assert refused.value.field == field


def test_a_requested_accuracy_chooses_the_grid_and_is_met() -> None:
    table = {"scene": "hertz", "vary": {"load": 50.0}, "solve": {"accuracy": 0.1, "quantity": "contact_area"}}
    (run,) = study_from_dict(table).runs()
    assert run.coordinates["grid"] is None
    row = execute(run.inputs)
    assert row["contact_area_error"] <= 0.1 * row["contact_area"]
    assert row["elements_x"] == row["elements_y"] > 1


@pytest.mark.parametrize(("scenes", "said"), [(False, True), (True, False), (True, None)])
def test_a_study_overrides_whether_a_scene_normalises(
    scenes: bool, said: bool | None, tmp_path: Path
) -> None:
    scene = rf.read_scene("table1-rough")
    rough = rf.GaussianRoughness(1e-6, 1e-4, seed=1, normalise=scenes)
    scene = replace(scene, lower=rf.Body(scene.lower.material, rough))
    (tmp_path / "rough.toml").write_text(rf.scene_to_toml(scene))
    table: dict[str, Any] = {"scene": "rough.toml", "vary": {"grid": [16]}}
    study = study_from_dict(table | ({} if said is None else {"normalise": said}), tmp_path)
    (run,) = study.runs()
    (part,) = run.inputs["scene"]["lower"]["surface"]
    assert part["normalise"] is (scenes if said is None else said)


def test_a_scene_beside_the_study_comes_before_one_in_the_working_directory(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "here").mkdir()
    for folder, load in ((tmp_path, 7.0), (tmp_path / "here", 9.0)):
        scene = replace(rf.read_scene("table1-smooth"), load=load)
        (folder / "ball.toml").write_text(rf.scene_to_toml(scene))
    monkeypatch.chdir(tmp_path / "here")
    table = {"scene": "ball.toml", "vary": {"grid": [16]}}
    assert [study_from_dict(table, folder).scene["load"] for folder in (tmp_path, Path())] == [7.0, 9.0]
