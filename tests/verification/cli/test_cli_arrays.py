"""`solve --npz`, `--netcdf`, `--patches`: files read back with numpy, xarray and csv."""

from __future__ import annotations

import csv
import json
import math
from pathlib import Path

import numpy as np
import pytest

import refimpl as rf
from verification.cli import main
from verification.cli.arrays import write_npz

SOLVE = ["solve", "table1-rough", "--grid", "32"]


def test_npz_and_patches_agree(tmp_path: Path) -> None:
    npz, table = tmp_path / "s.npz", tmp_path / "p.csv"
    assert main([*SOLVE, "--npz", str(npz), "--patches", str(table)]) == 0
    with np.load(npz) as found:
        attributes = json.loads(str(found["attributes"]))
        pressure, labels = found["pressure"], found["patch"]
    with table.open() as file:
        rows = list(csv.DictReader(file))
    assert attributes["units"]["pressure"] == "Pa"
    assert attributes["contact_area_error"] > 0
    assert len(rows) == labels.max()
    assert math.fsum(float(row["area [m^2]"]) for row in rows) == pytest.approx(attributes["contact_area"])
    first = pressure[labels == 1]
    assert float(rows[0]["max_pressure [Pa]"]) == first.max()


def test_netcdf_reads_back(tmp_path: Path) -> None:
    xarray = pytest.importorskip("xarray")
    pytest.importorskip("h5netcdf")
    assert main([*SOLVE, "--netcdf", str(tmp_path / "s.nc")]) == 0
    with xarray.open_dataset(tmp_path / "s.nc", engine="h5netcdf") as found:
        assert found.pressure.attrs["units"] == "Pa"
        assert found.attrs["max_pressure"] == float(found.pressure.max())


@pytest.mark.parametrize(("option", "name"), [("--npz", "s.csv"), ("--netcdf", "s.npz")])
def test_another_suffix_is_refused(option: str, name: str, tmp_path: Path) -> None:
    assert main([*SOLVE, option, str(tmp_path / name)]) == 2
    assert not (tmp_path / name).exists()


def test_coordinates_are_the_grids_along_x_and_y(tmp_path: Path) -> None:
    """4 x 3 elements on 8 x 3 um."""
    steel = rf.Material(E=200e9, nu=0.3)
    scene = rf.Scene(
        rf.Body(steel, rf.Sphere(1e-3)),
        rf.Body(steel, rf.Flat()),
        rf.Friction(),
        load=1e-5,
        size=(8e-6, 3e-6),
    )
    write_npz(rf.solve(scene, (4, 3), oblique=False), tmp_path / "s.npz")
    with np.load(tmp_path / "s.npz") as found:
        assert found["x"] == pytest.approx([1e-6, 3e-6, 5e-6, 7e-6])
        assert found["y"] == pytest.approx([0.5e-6, 1.5e-6, 2.5e-6])
        assert found["pressure"].shape == (4, 3)
