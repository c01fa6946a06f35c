"""`rough-friction identify`: the JSON, the table, the picture, resuming, and bad input."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from matplotlib.container import ErrorbarContainer
from matplotlib.figure import Figure

import refimpl as rf
from refimpl.identification.data_table import Row
from verification.cli import identify_store, main
from verification.cli.plot_curves import _fit

ROWS = "load,mu,u_mu\n5,0.4103,0.0082\n11,0.3337,0.0066\n24,0.2788,0.0055\n54,0.2253,0.0046\n"


@pytest.fixture
def data(tmp_path: Path) -> Path:
    path = tmp_path / "data.csv"
    path.write_text(ROWS)
    return path


def test_the_result_is_shown_written_and_drawn(data: Path, capsys: pytest.CaptureFixture[str]) -> None:
    found, picture = data.with_name("found.json"), data.with_name("found.png")
    command = ["identify", "table1-smooth", str(data), "--grid", "48", "--loads", "2,100"]
    assert main([*command, "--json", str(found), "--plot", str(picture)]) == 0
    stated = json.loads(found.read_text())
    for name, truth in (("tau", 15e6), ("beta", 0.08)):
        assert stated[name]["low"] < truth < stated[name]["high"]
    assert len(stated["covariance"]) == 2
    assert [p["load"] for p in stated["predictions"]] == [5, 11, 24, 54, 2, 100]
    assert picture.read_bytes()[:4] == b"\x89PNG"
    shown = capsys.readouterr().out
    for word in ("tau (MPa)", "measurement", "numerical", "contact edge", "Coulomb", "chi-square"):
        assert word in shown
    modelled = [line.split()[:2] for line in shown.partition("mu of the model")[2].splitlines()[1:7]]
    measured = [line.split(",")[:2] for line in ROWS.splitlines()[1:]]
    assert modelled == [*measured, ["2", "-"], ["100", "-"]]


def test_a_stopped_fit_goes_on(
    data: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    from refimpl.identification import forward

    store, solve, solved = data.with_name("store.json"), forward.solve, []

    def interrupted(*arguments: object) -> object:
        if len(solved) == 5:
            raise KeyboardInterrupt
        solved.append(arguments)
        return solve(*arguments)  # type: ignore[arg-type]

    command = ["identify", "table1-smooth", str(data), "--grid", "48", "--store", str(store)]
    monkeypatch.setattr(forward, "solve", interrupted)
    assert main(command) == 130
    assert len(json.loads(store.read_text())["solves"]) == 5
    monkeypatch.setattr(forward, "solve", solve)
    plain = data.with_name("plain.json")
    assert main([*command[:-2], "--json", str(plain)]) == 0
    assert main([*command, "--json", str(data.with_name("resumed.json"))]) == 0
    whole, resumed = (json.loads(data.with_name(f"{name}.json").read_text()) for name in ("plain", "resumed"))
    assert resumed["tau"] == whole["tau"]
    assert resumed["solves"] == whole["solves"] - 5
    capsys.readouterr()


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("load,mu,u_mu\n-5,0.1,0.01\n9,0.1,0.01\n", "a positive number"),
        ("load,mu\n5,0.1\n9,0.1\n", "u_mu"),
        ("load,mu,u_mu\n5,0.1,0.01\n", "two different loads"),
        ("load,mu,u_mu\n5,low,0.01\n9,0.1,0.01\n", "finite number"),
        ("load,mu,u_mu\n0.005,0.1,0.01\n9,0.1,0.01\n", "kN"),
    ],
)
def test_bad_data_end_in_one_line(
    data: Path, capsys: pytest.CaptureFixture[str], text: str, message: str
) -> None:
    data.write_text(text)
    assert main(["identify", "table1-smooth", str(data), "--grid", "48"]) == 2
    shown = capsys.readouterr()
    assert (shown.out, shown.err.count("\n")) == ("", 1)
    assert message in shown.err


def test_a_store_of_something_else_is_refused(data: Path, capsys: pytest.CaptureFixture[str]) -> None:
    store = data.with_name("store.json")
    for text in ("{}", "[1", '{"format": "rough-friction identify 1", "solves": {"a": {"mu": 1}}}'):
        store.write_text(text)
        assert main(["identify", "table1-smooth", str(data), "--store", str(store)]) == 2
        assert "store" in capsys.readouterr().err


def test_solves_are_kept_by_the_contents_of_measured_files(tmp_path: Path) -> None:
    """The key changes with the map, the scene and the settings, and with nothing else."""
    path, heights = tmp_path / "map.npy", np.random.default_rng(1).normal(size=(8, 8))
    np.save(path, heights)
    body = rf.Body(rf.Material(2e9, 0.3), rf.MeasuredSurface(path, unit="nm", pixel_size=1e-6))
    scene = rf.Scene(rf.Body(rf.Material(3e9, 0.2), rf.Flat()), body, rf.Friction(), load=1.0)
    settings = {"grid": 8}
    first = identify_store.key(scene, settings)
    assert identify_store.key(scene, {"grid": 8}) == first
    assert identify_store.key(scene, {"grid": 16}) != first
    assert identify_store.key(replace(scene, load=2.0), settings) != first
    np.save(path, 2 * heights)
    assert identify_store.key(scene, settings) != first


def test_measured_points_have_bars_of_95_per_cent() -> None:
    """1.96 standard uncertainties of 0.01 on both sides of 0.3."""
    mu = SimpleNamespace(value=0.3, low=0.25, high=0.35)
    made: Any = SimpleNamespace(
        predictions=[SimpleNamespace(load=2.0, mu=mu)], rows=[Row(load=2.0, mu=0.3, u_mu=0.01)]
    )
    axes = Figure().add_subplot()
    _fit(axes, made)
    (drawn,) = (c for c in axes.containers if isinstance(c, ErrorbarContainer))
    assert drawn[2][0].get_segments()[0][:, 1] == pytest.approx([0.2804, 0.3196])
