"""`rough-friction inspect`: what it prints, writes and refuses."""

from __future__ import annotations

import json
import tomllib
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import refimpl as rf
from refimpl.measured.inspection import PARAMETERS
from tests.refimpl.surfaces.instrument_writers import write_plu, write_txt
from verification.cli import main

SHAPE, PIXEL = (120, 90), (1e-6, 1.5e-6)


@pytest.fixture
def specimen(tmp_path: Path) -> Path:
    roughness = rf.GaussianRoughness(rms=0.3e-6, correlation_length=12e-6, seed=4)
    grid = rf.Grid(SHAPE, (120e-6, 135e-6))
    np.save(tmp_path / "specimen.npy", roughness.heights(grid) * 1e6)
    return tmp_path / "specimen.npy"


GIVEN = ["--unit", "um", "--pixel-size", "1e-6,1.5e-6"]


def test_all_of_it(specimen: Path, capsys: pytest.CaptureFixture[str]) -> None:
    picture, result = specimen.with_name("a.png"), specimen.with_name("a.json")
    outputs = ["--plot", str(picture), "--json", str(result), "--fit", "gaussian"]
    assert main(["inspect", str(specimen), *GIVEN, *outputs]) == 0
    printed = capsys.readouterr()
    assert printed.err == ""
    for word in (
        "120 x 90, 0 missing",
        "1 um x 1.5 um",
        "120 um x 135 um",
        "Sq ",
        "Sdq ",
        'kind = "gaussian"',
    ):
        assert word in printed.out
    document = json.loads(result.read_text())
    assert set(document["parameters"]) == set(PARAMETERS)
    assert document["parameters"]["Sq"] == pytest.approx(0.3e-6, rel=0.3)
    assert document["fit"]["table"]["kind"] == "gaussian"
    assert document["fit"]["deviations"]["rms"] > 0
    with Image.open(picture) as drawn:
        assert min(drawn.size) > 800


def test_the_fit_is_toml_of_a_scene(specimen: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["inspect", str(specimen), *GIVEN, "--fit", "gaussian"]) == 0
    table = tomllib.loads(capsys.readouterr().out.split("\n\n")[-1])
    surface = rf.surfaces.surface_from_dict(table)
    assert isinstance(surface, rf.GaussianRoughness)
    assert surface.rms == pytest.approx(0.3e-6, rel=0.3)


def test_keys_reach_the_surface(specimen: Path, capsys: pytest.CaptureFixture[str]) -> None:
    keys = ["--level", "3", "--outliers", "9", "--low-pass", "4e-6", "--high-pass", "60e-6"]
    window = ["--centre", "60e-6,60e-6", "--size", "80e-6"]
    assert main(["inspect", str(specimen), *GIVEN, *keys, *window, "--json", "-"]) == 0
    document = json.loads(capsys.readouterr().out)
    assert document["level"] == 3
    assert document["window"]["points"] == [80, 54]
    assert [note.split()[0] for note in document["notes"]] == ["0", "wavelengths", "wavelengths"]


def test_what_a_map_does_not_tell_is_a_dash_and_null(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    np.save(tmp_path / "flat.npy", np.zeros((8, 8)))
    command = ["inspect", str(tmp_path / "flat.npy"), "--unit", "um", "--pixel-size", "1e-6"]
    assert main(command) == 0
    assert "Sal         -" in capsys.readouterr().out
    assert main([*command, "--json", "-"]) == 0
    assert json.loads(capsys.readouterr().out)["parameters"]["Sal"] is None


def test_instruments_files_need_no_keys(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    from tests.refimpl.surfaces.instrument_writers import MAP

    for name, writer in (("map.plu", write_plu), ("map.txt", write_txt)):
        writer(tmp_path / name, MAP)
        assert main(["inspect", str(tmp_path / name)]) == 0
        assert "20 x 12, 1 missing" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ([], "unit, pixel_size"),
        (["--unit", "furlong", "--pixel-size", "1"], "unit = 'furlong'"),
        ([*GIVEN, "--level", "cone"], "level = 'cone'"),
        ([*GIVEN, "--size", "1"], "at most the measured"),
        ([*GIVEN, "--plot", "a.jpg"], "--plot"),
        ([*GIVEN, "--json", "specimen.npy"], "--json"),
    ],
)
def test_refusals_are_one_line(
    specimen: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    options: list[str],
    said: str,
) -> None:
    monkeypatch.chdir(specimen.parent)
    assert main(["inspect", "specimen.npy", *options]) == 2
    error = capsys.readouterr().err
    assert said in error
    assert error.count("\n") == 1


@pytest.mark.parametrize("options", [["--pixel-size", "wide"], ["--size", "1,2,3"], ["--fit", "cubist"]])
def test_usage_is_refused(specimen: Path, options: list[str]) -> None:
    with pytest.raises(SystemExit) as left:
        main(["inspect", str(specimen), *options])
    assert left.value.code == 2
