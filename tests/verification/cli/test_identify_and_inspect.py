"""`rough-friction identify` and `inspect`: fits and measured surfaces as tables, JSON and pictures."""

from __future__ import annotations

import json
import math
import tomllib
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace as Made
from typing import Any

import numpy as np
import pytest
from matplotlib.container import ErrorbarContainer
from matplotlib.figure import Figure
from PIL import Image

import refimpl as rf
from refimpl.identification import Interval, Prediction, Row, forward
from refimpl.identification.design import Proposal
from refimpl.identification.laws import Law
from refimpl.measured.inspection import PARAMETERS
from tests.verification.cli.commands import answer, refused, shown
from verification.cli import identify, identify_store, inspect, plot_surface
from verification.cli.output import plain
from verification.cli.plot_curves import _fit

ROWS = "load,mu,u_mu\n5,0.4103,0.0082\n11,0.3337,0.0066\n24,0.2788,0.0055\n54,0.2253,0.0046\n"
FIT = "identify table1-smooth data.csv --grid 24"
SPECIMEN = "inspect specimen.npy --unit um --pixel-size 1e-6,1.5e-6"


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A table of measured friction and a measured map in the working directory."""
    monkeypatch.chdir(tmp_path)
    Path("data.csv").write_text(ROWS)
    roughness = rf.GaussianRoughness(rms=0.3e-6, correlation_length=12e-6, seed=4)
    np.save("specimen.npy", roughness.heights(rf.Grid((120, 90), (120e-6, 135e-6))) * 1e6)


def rows(text: str) -> set[str]:
    return {" ".join(line.split()) for line in text.splitlines()}


def test_a_fit_is_shown_written_and_drawn() -> None:
    printed = shown(f"{FIT} --loads 2,100 --json found.json --plot found.png")
    stated = json.loads(Path("found.json").read_text())
    assert all(stated[name]["low"] < stated[name]["high"] for name in ("tau", "beta"))
    assert len(stated["covariance"]) == 2
    assert [p["load"] for p in stated["predictions"]] == [5, 11, 24, 54, 2, 100]
    assert Path("found.png").read_bytes()[:4] == b"\x89PNG"
    for word in ("tau (MPa)", "measurement", "numerical", "contact edge", "Coulomb", "chi-square"):
        assert word in printed
    modelled = [line.split()[:2] for line in printed.partition("mu of the model")[2].splitlines()[1:7]]
    measured = [line.split(",")[:2] for line in ROWS.splitlines()[1:]]
    assert modelled == [*measured, ["2", "-"], ["100", "-"]]


def test_a_stopped_fit_goes_on(monkeypatch: pytest.MonkeyPatch) -> None:
    solve, solved = forward.solve, []

    def interrupted(*arguments: object) -> object:
        if len(solved) == 5:
            raise KeyboardInterrupt
        solved.append(arguments)
        return solve(*arguments)  # type: ignore[arg-type]

    monkeypatch.setattr(forward, "solve", interrupted)
    shown(f"{FIT} --store store.json", 130)
    assert len(json.loads(Path("store.json").read_text())["solves"]) == 5
    monkeypatch.setattr(forward, "solve", solve)
    whole, resumed = answer(FIT), answer(f"{FIT} --store store.json")
    assert resumed["tau"] == whole["tau"]
    assert resumed["solves"] == whole["solves"] - 5
    document = json.loads(Path("store.json").read_text())
    some = list(document["solves"].values())[7]["response"]
    some["mu"] *= 1 + 1e-12
    Path("store.json").write_text(json.dumps(document))
    refused(f"{FIT} --store store.json", "rows as they were written; that of key")


def test_solves_are_kept_by_the_contents_of_measured_files() -> None:
    """The key changes with the map, the scene and the settings, and with nothing else."""
    surface = rf.MeasuredSurface("specimen.npy", unit="nm", pixel_size=1e-6)
    body = rf.Body(rf.Material(2e9, 0.3), surface)
    scene = rf.Scene(rf.Body(rf.Material(3e9, 0.2), rf.Flat()), body, rf.Friction(), load=1.0)
    first = identify_store.key(scene, {"grid": 8})
    assert identify_store.key(scene, {"grid": 8}) == first
    assert identify_store.key(scene, {"grid": 16}) != first
    assert identify_store.key(replace(scene, load=2.0), {"grid": 8}) != first
    np.save("specimen.npy", 2 * np.load("specimen.npy"))
    assert identify_store.key(scene, {"grid": 8}) != first


BETA = Interval(0.2, 0.1, math.inf)
MADE_UP: Any = Made(
    values={"tau": Interval(2e6, 1e6, 4e6), "beta": BETA, "hardness": Interval(3e8, 2e8, 5e8)},
    rows=(Row(8, 0.33, 0.01), Row(5, 0.36, 0.02)), is_identified=False, covariance=np.zeros((3, 3)),
    shares={"measurement": (3e5, 0.02, 1e7)}, method="ellipse", factor=2e-8, solves=11, passes=3,
    combination=Interval(0.24, 0.23, 0.26), residuals=(3, -2), deleted=(4, -2.5), degrees=1, chi_square=13,
    outliers=(0,), fitted=Made(dropped=0),
    predictions=[Prediction(P, Interval(m, m - 0.05, m + 0.1)) for P, m in ((8, 0.3), (5, 0.4), (40, 0.5))],
    probability=0.0, laws=(Law("Coulomb", {}, 14, 6, 7),), warnings=("vague",),
    proposal=Proposal((2, 90), (0.25, math.inf)),
)  # fmt: skip


def test_a_fit_as_a_table_and_as_json() -> None:
    assert rows(identify.table(MADE_UP)) > {
        "tau (MPa) 2 1 to 4", "beta 0.2 0.1 to inf", "hardness (MPa) 300 200 to 500", "warning: vague",
        "0.02 tau/MPa + beta 0.24 0.23 to 0.26", "measurement 0.3 0.02 10", "8 0.33 0.3 0.25 to 0.4 +3.0",
        "5 0.36 0.4 0.35 to 0.5 -2.0", "40 - 0.5 0.45 to 0.6 -", "Coulomb 14 6 7",
    }  # fmt: skip
    found: Any = json.loads(json.dumps(plain(identify.document(MADE_UP)), allow_nan=False))
    assert (found["tau"], found["beta"]["high"]) == ({"value": 2e6, "low": 1e6, "high": 4e6}, None)
    assert found["shares"] == {"measurement": {"tau": 3e5, "beta": 0.02, "hardness": 1e7}}
    assert (found["residuals"], found["deleted_residuals"]) == ([3, -2], [4, -2.5])
    assert found["outliers"] == [{"row": 1, "load": 8, "deviation": 4, "dropped": True}]
    assert (found["degrees_of_freedom"], found["solves"], found["passes"]) == (1, 11, 3)
    assert (found["laws"][0]["aic"], found["laws"][0]["bic"]) == (6, 7)
    assert found["further_loads"] == {"loads": [2, 90], "tau": 0.25, "beta": None}


def test_measured_points_have_bars_of_95_per_cent() -> None:
    """1.96 standard uncertainties of 0.01 and 0.02."""
    axes = Figure().add_subplot()
    _fit(axes, MADE_UP)
    (drawn,) = (c for c in axes.containers if isinstance(c, ErrorbarContainer))
    bars = [segment[:, 1] for segment in drawn[2][0].get_segments()]
    assert bars == [pytest.approx([0.3104, 0.3496]), pytest.approx([0.3208, 0.3992])]


def test_an_inspected_map_is_shown_written_and_drawn() -> None:
    printed = shown(f"{SPECIMEN} --plot a.png --json a.json --fit gaussian")
    for word in ("120 x 90, 0 missing", "1 um x 1.5 um", "120 um x 135 um", "Sq ", "Sdq "):
        assert word in printed
    document = json.loads(Path("a.json").read_text())
    assert set(document["parameters"]) == set(PARAMETERS)
    assert document["parameters"]["Sq"] == pytest.approx(0.3e-6, rel=0.3)
    assert document["fit"]["deviations"]["rms"] > 0
    with Image.open("a.png") as drawn:
        assert min(drawn.size) > 800
    surface = rf.surfaces.surface_from_dict(tomllib.loads(printed.split("\n\n")[-1]))  # TOML of a scene
    assert isinstance(surface, rf.GaussianRoughness)
    assert surface.rms == pytest.approx(0.3e-6, rel=0.3)
    assert document["fit"]["table"]["kind"] == "gaussian"


def test_keys_reach_the_surface() -> None:
    keys = "--level 3 --scan-lines x --outliers 9 --low-pass 4e-6 --high-pass 60e-6 --size 80e-6"
    document = answer(f"{SPECIMEN} {keys} --centre 60e-6,60e-6")
    assert document["level"] == 3
    assert document["window"]["points"] == [80, 54]
    assert [note.split()[0] for note in document["notes"]] == [
        "0", "scan", "wavelengths", "wavelengths"
    ]  # fmt: skip


def test_the_table_of_an_inspected_surface() -> None:
    document = {
        "file": "a.sur", "format": "sur", "channel": "Z", "channels": ["Z", "I"], "points": [30, 20],
        "missing": 7, "pixel": [2e-6, 5e-7], "size": [6e-5, 1e-5], "unit": "um", "orientation": "",
        "level": "sphere", "slopes": [0.01, -0.02], "radius": 0.4, "notes": (),
        "window": {"points": [8, 9], "missing": 2}, "parameters": dict.fromkeys(PARAMETERS, 3e-12),
        "deviations": {"psd_slope": 1e-12},
    }  # fmt: skip
    found: Any = Made(document=lambda: document)
    assert rows(inspect.table(found)) > {
        "channel Z; there are also I", "points 30 x 20, 7 missing", "pixel 2 um x 500 nm",
        "size 60 um x 10 um", "level sphere, slopes 0.01, -0.02, radius 400 mm",
        "psd_slope 3.0e-12 +- 1e-12 d ln C / d ln q below pi times the 1/e length",
        "window 8 x 9 points, 2 missing", "Sz 3 pm highest to lowest point",
    }  # fmt: skip


def test_the_picture_of_an_oblong_surface() -> None:
    """60 um along x and 10 along y; 1e-30 m^4 are a um^2 nm^2."""
    spectrum = Made(q=np.array([2e6]), C=np.array([4e-29]))
    found: Any = Made(z=np.arange(600.0).reshape(30, 20) * 1e-9, pixel=(2e-6, 5e-7), spectrum=spectrum)
    heights, power = Figure().subplots(1, 2)
    plot_surface.draw_map(heights, found)
    assert heights.images[0].get_extent() == pytest.approx((0, 60, 0, 10))
    assert np.asarray(heights.images[0].get_array())[1, 2] == pytest.approx(41)  # nm, at i = 2, j = 1
    plot_surface._spectrum(power, found)
    assert power.lines[0].get_xydata()[0] == pytest.approx((2, 40))
