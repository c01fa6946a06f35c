"""Errors by name, patches, arrays and texts at a prompt of a solution."""

from __future__ import annotations

import math
import re
import sys
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import refimpl as rf
from refimpl.errors import InputError
from refimpl.grid import Grid
from refimpl.grid.contact_patches import patch_labels
from refimpl.solution.arrays import UNITS, fields_of
from refimpl.solution.display import _map
from refimpl.solution.patches import patches_of


@pytest.fixture(scope="module")
def rough() -> rf.Solution:
    return rf.solve(rf.read_scene("table1-rough"), grid=48)


@pytest.fixture(scope="module")
def yielded() -> rf.Solution:
    return rf.solve(rf.read_scene("metal-polymer"), grid=32)


def test_error_is_the_sum_of_the_parts(rough: rf.Solution) -> None:
    parts = rough.uncertainty["contact_area"]
    assert rough.error("contact_area") == math.fsum(parts.values()) > 0
    side = rough.grid.lengths[0]
    assert rough.error("contact_area_share") == pytest.approx(rough.error("contact_area") / side**2)
    assert all(rough.error(name) >= 0 for name in UNITS)
    with pytest.raises(InputError, match="friction_coefficient"):
        rough.error("mu")


def test_ratios_follow_from_the_arrays(rough: rf.Solution) -> None:
    touching = rough.pressure > 0
    assert rough.contact_area_share == pytest.approx(np.count_nonzero(touching) / 48**2, rel=1e-14)
    assert rough.mean_pressure * rough.contact_area == pytest.approx(
        rough.pressure.sum() * rough.grid.element_area, rel=1e-12
    )
    assert rough.mean_gap > 0


def test_patches_by_hand() -> None:
    f = np.zeros((4, 4))
    f[0, 0], f[1, 1], f[3, 2] = 1.0, 3.0, 5.0
    first, second = patches_of(f, f >= 5, Grid((4, 4), (4.0, 8.0)))
    # elements of 1 x 2; corners touch; centres (0.5, 1) and (1.5, 3), weighted 1 to 3
    assert (first.elements, first.area, first.load) == (2, 4.0, 8.0)
    assert (first.mean_pressure, first.max_pressure) == (2.0, 3.0)
    assert (first.x, first.y) == pytest.approx((1.25, 2.5))
    assert (second.label, second.x, second.y, second.plastic_share) == (2, 3.5, 5.0, 1.0)
    assert first.plastic_share == 0


def test_a_patch_across_a_period_has_its_centre_at_the_border() -> None:
    f = np.zeros((8, 8))
    f[[0, 7], 4] = 1.0
    (patch,) = patches_of(f, f > 1, Grid((8, 8), (8.0, 8.0), periodic=True))
    assert patch.elements == 2
    assert min(patch.x, 8 - patch.x) == pytest.approx(0, abs=1e-12)
    assert patch.y == pytest.approx(4.5)


def test_labels_of_a_periodic_contact_are_numbered_without_holes() -> None:
    contact = np.zeros((6, 6), dtype=bool)
    contact[0, 1] = contact[2, 3] = contact[5, 1] = contact[4, 5] = True
    assert np.unique(patch_labels(contact, periodic=True)).tolist() == [0, 1, 2, 3]
    assert patch_labels(contact, periodic=True)[5, 1] == 1


def test_patches_add_up_to_the_solution(yielded: rf.Solution) -> None:
    found = yielded.patches()
    assert math.fsum(patch.area for patch in found) == pytest.approx(yielded.contact_area, rel=1e-12)
    plastic = math.fsum(patch.area * patch.plastic_share for patch in found)
    assert plastic == pytest.approx(yielded.plastic_area, rel=1e-12)


def test_every_field_has_the_shape_of_the_grid(rough: rf.Solution) -> None:
    for name, field in fields_of(rough).items():
        assert field.values.shape == rough.grid.shape, name
        assert field.description


def test_every_field_is_the_solutions_of_that_name() -> None:
    """No two of them are equal here; patches are labels of the contact."""
    grid = rf.Grid((2, 3), (1e-3, 2e-3))
    contact = np.array([[True, False, True], [False, False, True]])
    made: Any = SimpleNamespace(grid=grid, contact=contact)
    names = {
        "pressure": "Pa", "traction": "Pa", "gap": "m", "surface_lower": "m", "surface_upper": "m",
        "theta_x": "rad", "theta_y": "rad", "plastic_indentation": "m", "plastic": "1", "excluded": "1",
    }  # fmt: skip
    for k, name in enumerate(names):
        setattr(made, name, np.full(grid.shape, float(k)))
    found = fields_of(made)
    assert found.pop("patch").values.tolist() == [[1, 0, 2], [0, 0, 2]]
    assert {name: field.unit for name, field in found.items()} == names
    assert [float(field.values[0, 0]) for field in found.values()] == list(range(10))


def test_a_dataset_has_coordinates_units_and_numbers(rough: rf.Solution) -> None:
    pytest.importorskip("xarray")
    data = rough.to_xarray()
    assert data.pressure.attrs["units"] == "Pa"
    assert np.array_equal(data.pressure.values, rough.pressure)
    assert np.array_equal(data.x.values, rough.grid.x)
    assert data.attrs["contact_area_error"] == rough.error("contact_area")
    i, j = np.unravel_index(rough.pressure.argmax(), rough.grid.shape)
    peak = data.pressure.sel(x=rough.grid.x[i], y=rough.grid.y[j])
    assert float(peak) == rough.max_pressure


def test_without_xarray_the_extra_is_named(rough: rf.Solution, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "xarray", None)
    with pytest.raises(InputError, match=r"\.\[arrays\]"):
        rough.to_xarray()


def test_repr_is_one_line_and_str_a_short_table(rough: rf.Solution) -> None:
    assert "\n" not in repr(rough)
    assert repr(rough).startswith("<Solution converged, 48 x 48: mu = 0.1")
    text = str(rough)
    assert 8 < text.count("\n") < 20
    assert all(name in text for name in ("friction coefficient mu", "A/A0", "warning: "))


def test_html_escapes_and_draws_a_small_map(rough: rf.Solution) -> None:
    text = rough._repr_html_()
    assert len(text) < 20_000
    assert 0 < text.count("<rect") <= 1 + 32 * 32
    assert "<table>" in text


def test_yield_has_its_row(yielded: rf.Solution, rough: rf.Solution) -> None:
    assert ("plastic area" in str(yielded)) == bool(yielded.plastic_area)
    assert "plastic area" not in str(rough)


def test_patches_of_a_periodic_solution_go_on_across_its_border() -> None:
    contact = np.array([[True, False], [False, False], [True, False]])
    values = dict.fromkeys(
        ("pressure", "traction", "gap", "surface_lower", "surface_upper", "theta_x", "theta_y",
         "plastic_indentation", "plastic", "excluded"), np.zeros((3, 2)),
    )  # fmt: skip
    labels = {}
    for periodic in (False, True):
        grid = rf.Grid((3, 2), (3e-3, 2e-3), periodic=periodic)
        made: Any = SimpleNamespace(grid=grid, contact=contact, **values)
        labels[periodic] = fields_of(made)["patch"].values[:, 0].tolist()
    assert labels == {False: [1, 0, 2], True: [1, 0, 1]}


def test_the_map_at_a_prompt_has_x_to_the_right_and_y_up() -> None:
    """Pressures 2 and 1 at (0, 2) and (1, 1) of 2 x 3 elements: the first in the top row, darkest."""
    made: Any = SimpleNamespace(pressure=np.array([[0.0, 0.0, 2.0], [0.0, 1.0, 0.0]]))
    found = re.findall(r"x='(\d)' y='(\d)'.*?fill-opacity='([\d.]+)'", _map(made))
    assert found == [("0", "0", "1.00"), ("1", "1", "0.60")]
