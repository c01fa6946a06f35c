"""The grid where none is given: one rule for solves, identifications, verdicts and sweeps."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import refimpl as rf
from refimpl.driver.options import Options
from refimpl.identification import Row, identify
from refimpl.sensitivities.surface_verdict import surface_verdict
from tests import plate
from verification.cli.options import DEFAULT_GRID

POINTS = (24, 18)


def measured(folder: Path, points: tuple[int, int] = POINTS) -> rf.Scene:
    """A ball that hardly touches a map of so many points."""
    path = plate.write(plate.sampled(plate.worn(rms=0.05e-6), plate.CLEAN, points), folder / "map.txt")
    return replace(plate.scene(plate.measured(path), load=0.02, points=points), size=None)


def asked(scene: rf.Scene) -> tuple[int, ...]:
    return Options(scene=scene).solve_grid.shape


@pytest.mark.parametrize(("points", "elements"), [(POINTS, POINTS), ((600, 450), (512, 384))])
def test_a_map_has_an_element_per_point_up_to_a_limit(
    tmp_path: Path, points: tuple[int, int], elements: tuple[int, int]
) -> None:
    assert asked(measured(tmp_path, points)) == elements
    assert f"up to {512}" in DEFAULT_GRID


def test_the_finest_data_count_and_formulas_have_a_number_of_their_own() -> None:
    scene = plate.scene(plate.worn())
    assert asked(scene) == (256, 192)
    assert DEFAULT_GRID.startswith("default 256")
    fine, coarse = (rf.ArraySurface(np.zeros(shape)) for shape in ((40, 30), (20, 10)))
    assert asked(replace(scene, lower=rf.Body(plate.STEEL, rf.SurfaceSum((fine, coarse))))) == (40, 30)


def test_solves_identifications_and_verdicts_take_it(tmp_path: Path) -> None:
    scene = measured(tmp_path)
    assert rf.solve(scene).grid.shape == POINTS == surface_verdict(scene).solution.grid.shape
    rows = [Row(load, 0.2, 0.02) for load in (0.02, 0.04)]
    default, stated = (identify(scene, rows, grid, design=False) for grid in (None, POINTS))
    assert default.values == stated.values


def test_the_dense_method_takes_as_many_elements_as_it_may_by_default() -> None:
    assert Options(scene=rf.read_scene("table1-smooth"), method="dense").grid == 64
