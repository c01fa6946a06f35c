"""`rough-friction solve`: table, JSON, picture and files of fields state the same as the solution itself."""

from __future__ import annotations

import csv
import dataclasses
import json
import math
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import meshio
import numpy as np
import pytest

import refimpl as rf
from refimpl.solution.quantities import QUANTITIES
from tests.changed import changed
from tests.verification.cli.commands import SCENE, answer, run, shown
from verification.cli import solve_table
from verification.cli.plot import hertz_of

NUMBERS = {
    "friction_coefficient_corrected": 0.24,
    "friction_coefficient": 0.25,
    "contact_area": 3e-6,
    "contact_area_corrected": 2.5e-6,
    "plastic_area": 0.75e-6,
    "max_pressure": 400e6,
    "approach": -1.5e-6,
    "normal_force": 12.5,
    "friction_force": 3.125,
    "friction_force_corrected": 3.0,
    "binormal_force": -0.5,
}
BARS = {
    "friction_coefficient_corrected": {"discretisation": 0.02},
    "friction_coefficient": {"iteration": 0.01, "discretisation": 0.03},
    "contact_area": {"iteration": 2e-7},
    "contact_area_corrected": {"discretisation": 3e-7},
    "plastic_area": {"iteration": 5e-8, "discretisation": 1e-8},
    "max_pressure": {"discretisation": 7e6},
    "approach": {"discretisation": 6e-8},
    "normal_force": {"iteration": 0.0},
    "friction_force_corrected": {"iteration": 0.5},
    "binormal_force": {"discretisation": math.inf},
}

Replace = Callable[..., rf.Solution]


@pytest.fixture
def replaced(folder: Path, monkeypatch: pytest.MonkeyPatch) -> Replace:
    """Function that makes every solve end with the solution of the scene, some of its fields replaced."""
    solution = rf.solve(rf.read_scene("scene.toml"), grid=8)

    def replace(**fields: Any) -> rf.Solution:
        made = changed(solution, **fields)
        monkeypatch.setattr(rf, "solve", lambda *_, **__: made)
        return made

    return replace


def test_numbers_bars_and_units_of_the_table() -> None:
    """The plastic area is a quarter of A; bars are sums of parts, in the unit beside them."""
    scene = rf.Scene(
        rf.Body(rf.Material(7e9, 0.2), rf.Sphere(0.05)),
        rf.Body(rf.Material(2e9, 0.35, hardness=5e6), rf.Flat()),
        rf.Friction(tau=1e6, beta=0.2),
        load=5.0,
        side=4e-3,
    )
    solution = changed(rf.solve(scene, 12, plastic=True), **NUMBERS, uncertainty=BARS)
    found = [line.split() for line in solve_table.table(solution, "scene").splitlines()]
    for row in (
        "friction coefficient mu 0.24 +- 0.02",
        "mu, summed over elements 0.25 +- 0.04",
        "contact area A 3.0 +- 0.2 mm^2",
        "A, perimeter-corrected 2.5 +- 0.3 mm^2",
        "plastic area 0.75 +- 0.06 mm^2",
        "plastic share of A 0.25 +- 0.04",
        "maximum pressure p_max 400 +- 7 MPa",
        "approach -1.50 +- 0.06 um",
        "normal force N 12.5 N",
        "friction force F 3.0 +- 0.5 N",
        "transverse force Q -0.50 unbounded (not usable) N",
    ):
        assert row.split() in found, row


@pytest.mark.parametrize("status", list(rf.Status))
def test_exit_status(status: rf.Status, replaced: Replace) -> None:
    """A certificate that holds is not enough: the accuracy may be missing."""
    assert replaced(status=status).details.certified
    solved = status in (rf.Status.CONVERGED, rf.Status.CYCLED)
    printed = shown("solve scene.toml", int(not solved))
    assert f"status: {status.name}" in printed
    assert ("--" in printed.partition("friction coefficient")[0]) is not solved  # what to do next


UNUSABLE = {
    "friction_coefficient_corrected": 0.2,
    "max_pressure": 3e13,
}  # bars found with mu 0.1 and p_max 0.2 GPa


@pytest.mark.parametrize(
    ("bars", "named", "strict"),
    [
        ({}, [], 0),
        (UNUSABLE, list(UNUSABLE), 1),
        ({"binormal_force": 0.01}, [], 0),  # Q is zero by symmetry, F about 0.5 N
        ({"binormal_force": 10.0}, ["binormal_force"], 1),
    ],
)
def test_a_number_whose_bar_exceeds_half_of_it_is_not_usable(
    bars: dict[str, float], named: list[str], strict: int, replaced: Replace
) -> None:
    replaced(uncertainty={name: {"discretisation": bar} for name, bar in bars.items()})
    document = answer("solve scene.toml")
    assert document["not_usable"] == named
    stated = {name: {"discretisation": bar if math.isfinite(bar) else None} for name, bar in bars.items()}
    assert document["uncertainty"] == stated
    printed = shown("solve scene.toml --strict", strict)
    assert printed.count("(not usable)") == len(named)
    if bars == UNUSABLE:
        assert re.search(r"mu +0\.\d\d +\+- 0\.2 \(not usable\)", printed)
        assert re.search(r"p_max +\d\d?0* +\+- 3e\+07 \(not usable\) +MPa", printed)


@pytest.mark.parametrize("finished", [True, False])
def test_an_interrupt_shows_the_last_finished_grid(
    finished: bool, replaced: Replace, monkeypatch: pytest.MonkeyPatch
) -> None:
    """No JSON file is made."""
    solution = replaced()

    def interrupted(*_: object, **__: object) -> None:
        raise KeyboardInterrupt(*([solution] if finished else []))

    monkeypatch.setattr(rf, "solve", interrupted)
    printed = shown("solve scene.toml --accuracy 0.01 --json s.json", 130)
    assert printed.startswith("interrupted; the last finished grid:") is finished
    assert ("8 x 8 elements" in printed) is finished
    assert not Path("s.json").exists()


@pytest.mark.parametrize(
    ("words", "grid", "size"),
    [
        ("scene.toml --grid 48", 48, {"side": 1e-3}),
        ("oblong.toml --grid 30 --size 1e-3x3e-3", [10, 30], {"size": [1e-3, 3e-3]}),
    ],
)
def test_json_has_the_solutions_numbers(words: str, grid: Any, size: dict[str, Any], folder: Path) -> None:
    found = answer(f"solve {words}")
    scene = dataclasses.replace(rf.read_scene(words.split()[0]), **{"side": None, "size": None} | size)
    solution = rf.solve(scene, tuple(grid) if isinstance(grid, list) else grid)
    for attribute in QUANTITIES:
        assert found[attribute] == getattr(solution, attribute)
    assert (found["grid"], found["status"]) == (grid, "converged")
    assert {name: found[name] for name in ("side", "size") if name in found} == size
    assert found["certificate"]["gap"] <= 1e-8
    assert {"plan", "warnings", "cost", "uncertainty", "provenance"} <= set(found)


def test_the_table_names_grid_status_and_neglected_terms(folder: Path) -> None:
    printed = shown("solve oblong.toml --grid 48x20 --no-oblique")
    assert all(words in printed for words in ("48 x 20 elements", "CONVERGED", "penetration"))
    assert "slope terms" in printed.partition("not modelled")[2]


def test_without_contact_mu_is_not_a_number_in_words(folder: Path) -> None:
    printed = shown("solve scene.toml --grid 8 --approach 0 --json s.json --plot s.png", 1)
    assert re.search(r"friction coefficient mu +n/a", printed)
    assert json.loads(Path("s.json").read_text())["friction_coefficient"] is None


@pytest.mark.parametrize(("words", "included"), [("", True), ("--plastic off", False)])
def test_pressures_end_at_the_hardness(words: str, included: bool, folder: Path) -> None:
    Path("hard.toml").write_text(SCENE.replace("nu = 0.38", "nu = 0.38\nhardness = 8e6"))
    table = shown(f"solve hard.toml --grid 32 --json hard.json {words}")
    document = json.loads(Path("hard.json").read_text())
    assert ("plastic area" in table) == included
    assert ("at the hardness A is at least" in " ".join(table.split())) == (not included)
    assert (document["plastic_share"] > 0.3) == included
    assert (document["max_pressure"] == 8e6) == included
    assert document["uncertainty"]["plastic_area"]


def test_vtu_holds_both_surfaces_and_the_whole_load(folder: Path) -> None:
    assert (
        "48 x 20 elements"
        in run("solve oblong.toml --grid 48x20 --vtk s.vtu --no-oblique", terminal=True).err
    )
    mesh = meshio.read("s.vtu")
    fields, corners = mesh.point_data, mesh.cells_dict["quad"]
    assert set(fields) == {"pressure", "traction", "gap", "height", "body"}
    assert (len(mesh.points), len(corners)) == (2 * 48 * 20, 2 * 47 * 19)
    lower, upper = mesh.points[fields["body"] == 0], mesh.points[fields["body"] == 1]
    np.testing.assert_array_equal(lower[:, :2], upper[:, :2])
    spacing = np.array([2e-3 / 48, 1e-3 / 20])
    assert lower[0, :2] == pytest.approx(spacing / 2)
    # without slope terms N is the plain sum of the pressures, and balances the load to rounding
    pressure = fields["pressure"][fields["body"] == 0]
    assert pressure.sum() * spacing.prod() == pytest.approx(5.0, rel=1e-12)
    # each square joins four neighbours of one sheet: its corners span one spacing along x and along y
    assert np.ptp(fields["body"][corners], axis=1).max() == 0
    assert set(corners.ravel()) == set(range(len(mesh.points)))
    np.testing.assert_allclose(np.ptp(mesh.points[corners][..., :2], axis=1), [spacing] * len(corners), 1e-9)
    gap = (upper - lower)[:, 2]
    np.testing.assert_allclose(gap, fields["gap"][fields["body"] == 0], atol=1e-18)
    # in contact the surfaces coincide to the certificate's 1e-8 of an approach of about 2e-5 m
    assert np.abs(gap[pressure > 0]).max() < 1e-12 < gap[pressure == 0].max()
    assert np.abs(lower[np.argmax(pressure), :2] - [1e-3, 0.5e-3]).max() < 0.1e-3


def test_npz_netcdf_and_patches_agree(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    xarray = pytest.importorskip("xarray")
    pytest.importorskip("h5netcdf")
    monkeypatch.chdir(tmp_path)
    shown("solve table1-rough --grid 32 --npz s.npz --patches p.csv --netcdf s.nc")
    with np.load("s.npz") as found:
        attributes = json.loads(str(found["attributes"]))
        pressure, labels = found["pressure"], found["patch"]
    with Path("p.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert attributes["units"]["pressure"] == "Pa"
    assert attributes["contact_area_error"] > 0
    assert len(rows) == labels.max()
    measures = ["area [m^2]", "load [N]", "mean_pressure [Pa]", "max_pressure [Pa]", "x [m]", "y [m]"]
    assert list(rows[0]) == ["label", "elements", *measures, "plastic_share"]
    assert math.fsum(float(row["area [m^2]"]) for row in rows) == pytest.approx(attributes["contact_area"])
    assert float(rows[0]["max_pressure [Pa]"]) == pressure[labels == 1].max()
    with xarray.open_dataset("s.nc", engine="h5netcdf") as dataset:
        assert dataset.pressure.attrs["units"] == "Pa"
        assert dataset.attrs["max_pressure"] == float(dataset.pressure.max())
        np.testing.assert_array_equal(dataset.pressure, pressure)


def test_hertz_of_a_ball_in_a_cup_and_of_no_ball() -> None:
    soft, flat = rf.Material(E=1e9, nu=0.5), rf.Flat()

    def scene(upper: rf.Surface, lower: rf.Surface, periodic: bool = False) -> rf.Scene:
        bodies = rf.Body(soft, upper), rf.Body(soft, lower)
        return rf.Scene(*bodies, rf.Friction(), load=1.0, side=1e-3, periodic=periodic)

    ball, cup = rf.Sphere(radius=0.1), rf.Sphere(radius=0.2)
    found = hertz_of(scene(ball + flat, cup), load=1.0)
    assert found is not None
    assert found.radius == pytest.approx(0.2)  # 1/R = 1/0.1 - 1/0.2: the cup curves the same way
    for without in (scene(flat, flat), scene(cup, ball), scene(ball, flat, periodic=True)):
        assert hertz_of(without, load=1.0) is None


def test_warnings_are_printed_before_notes_and_notes_take_a_line_each(folder: Path) -> None:
    """A copper flat that yields, under a ball without a hardness: the notes of yield and input follow."""
    scene = rf.read_scene("scene.toml")
    copper = rf.Material(118e9, 0.34, hardness=50e6)
    rough = rf.GaussianRoughness(rms=0.2e-6, correlation_length=30e-6, seed=1)
    hard = dataclasses.replace(scene, lower=rf.Body(copper, rough))
    Path("hard.toml").write_text(rf.scene_to_toml(hard), encoding="utf-8")
    printed = run("solve hard.toml --grid 16").out
    found = re.findall(r"^(warning|note)\b", printed, flags=re.M)
    assert {"warning", "note"} == set(found)
    assert found == sorted(found, reverse=True)
    assert "\n\n" not in printed[printed.index("\nnote: ") :].strip()
    assert "at the hardness" in printed.partition("\nnote: ")[2].partition("\n")[0]
