"""Errors by name, patches, arrays and texts at a prompt of a solution."""

from __future__ import annotations

import math
import re
import sys
from dataclasses import replace
from operator import attrgetter
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import refimpl as rf
from refimpl.errors import InputError
from refimpl.grid import Grid
from refimpl.solution import display
from refimpl.solution.arrays import as_dataset, attributes_of, patches_of
from refimpl.solution.model_warning import Notice
from tests.changed import changed


@pytest.fixture(scope="module")
def rough() -> rf.Solution:
    return rf.solve(rf.read_scene("table1-rough"), grid=48)


@pytest.fixture(scope="module")
def oblong() -> rf.Solution:
    lower = rf.Body(rf.Material(2e9, 0.35), rf.GaussianRoughness(2e-6, 6e-4, seed=4))
    upper = rf.Body(rf.Material(7e9, 0.2, hardness=2e9), rf.Sphere(0.05))
    scene = rf.Scene(upper, lower, rf.Friction(1e6, 0.2), 5.0, size=(3e-3, 1.6e-3), sliding_direction=0.3)
    return rf.solve(scene, (6, 4), plastic=False)


@pytest.mark.parametrize(
    "name",
    ["pressure", "traction", "gap", "plastic_indentation", "slopes.tan_x", "slopes.tan_y", "details.excluded",
     "details.state.displacement_lower", "details.state.v", "details.state.plastic"],
)  # fmt: skip
def test_arrays_are_read_only(name: str, rough: rf.Solution) -> None:
    """A solution is its certificate's, and a start that was changed would be none."""
    with pytest.raises(ValueError, match="read-only"):
        attrgetter(name)(rough)[0, 0] = 1
    for surface in rough.surfaces:
        assert not surface.flags.writeable


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


def test_a_dataset_has_coordinates_units_and_numbers(oblong: rf.Solution) -> None:
    pytest.importorskip("xarray")
    data = as_dataset(oblong, {"code": "1.2"})
    assert (data.gap.dims, data.plastic.dtype, data.attrs["code"]) == (("x", "y"), np.int8, "1.2")
    assert data.y.values == pytest.approx([0.2e-3, 0.6e-3, 1.0e-3, 1.4e-3])
    assert data.pressure.attrs["units"] == "Pa"
    assert np.array_equal(data.pressure.values, oblong.pressure)
    assert np.array_equal(data.x.values, oblong.grid.x)
    assert data.attrs["contact_area_error"] == oblong.error("contact_area")
    assert as_dataset(oblong).identical(oblong.to_xarray())


def test_without_xarray_the_extra_is_named(rough: rf.Solution, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "xarray", None)
    with pytest.raises(InputError, match=r"\.\[arrays\]"):
        rough.to_xarray()


SHOWN = {  # value and error in SI, the unit there, and the row
    "friction_coefficient_corrected": (0.1234, 0.002, "1", "friction coefficient mu 0.123 +- 0.002"),
    "friction_coefficient": (0.1301, 0.007, "1", "mu, summed over elements 0.130 +- 0.007"),
    "contact_area": (2.5e-6, 3e-7, "m^2", "contact area A 2.5 +- 0.3 mm^2"),
    "contact_area_corrected": (2.31e-6, 4e-8, "m^2", "A, perimeter-corrected 2.31 +- 0.04 mm^2"),
    "contact_area_share": (0.31, 0.04, "1", "A/A0 0.31 +- 0.04"),
    "plastic_area": (0.7e-6, 0.0, "m^2", "plastic area 0.7 mm^2"),
    "max_pressure": (8.1e8, math.inf, "Pa", "maximum pressure p_max 810 unbounded (not usable) MPa"),
    "mean_pressure": (6.2e7, 9e7, "Pa", "mean contact pressure 62 +- 90 (not usable) MPa"),
    "mean_gap": (4.5e-6, None, "m", "mean gap 4.50 - um"),
    "approach": (3.14e-6, 0.96e-8, "m", "approach 3.140 +- 0.010 um"),
    "normal_force": (70.0, 0.0, "N", "normal force N 70 N"),
    "friction_force_corrected": (-8.0, 0.5, "N", "friction force F -8.0 +- 0.5 N"),
    "binormal_force": (math.nan, 0.0, "N", "transverse force Q n/a N"),
}
FINE = np.zeros((4, 65))
FINE[2, 3], FINE[3, 64] = 8.0, 4.0
MADE: Any = SimpleNamespace(
    **{name: row[0] for name, row in SHOWN.items()}, error=lambda name: SHOWN[name][1], pressure=FINE,
    traction=FINE, friction_force=-8.0,
    plan=SimpleNamespace(method="dense"), status=rf.Status.CYCLED, grid="2 x 3",
    warnings=(Notice("c > d"), "a < b"),
)  # fmt: skip


def test_the_table_has_each_number_in_its_unit() -> None:
    head, *rows, note, last = display.table(MADE).splitlines()
    assert head == "status cycled, 2 x 3 elements, method dense"
    assert (note, last) == ("note: c > d", "warning: a < b")
    assert [" ".join(row.split()) for row in rows] == [row[3] for row in SHOWN.values()]
    assert display.line(MADE) == "<Solution cycled, 2 x 3: mu = 0.123 +- 0.002, A = 2.31 +- 0.04 mm^2>"


def test_the_map_has_x_to_the_right_and_y_up_and_the_maximum_of_each_cell() -> None:
    """65 elements along y are 22 cells of three; half of the peak is 0.2 + 0.8 / 2 opaque."""
    text = display.html(MADE)
    squares = re.findall(r"x='(\d+)' y='(\d+)' .*? fill-opacity='([\d.]+)'", text)
    assert squares == [("0", "20", "1.00"), ("1", "0", "0.60")]
    assert "<svg width='15' viewBox='0 0 2 22'" in text  # 160 high
    assert "<ul><li>c &gt; d</li><li>a &lt; b</li></ul>" in text


def test_a_file_has_settings_units_and_the_errors_that_there_are(oblong: rf.Solution) -> None:
    own = changed(oblong, uncertainty={"approach": {"a": 1e-7, "b": 2e-7}}, warnings=("x", "y"))
    found = attributes_of(changed(own, grid=replace(own.grid, periodic=True)), {"code": "1.2"})
    errors = {name: value for name, value in found.items() if name.endswith("_error")}
    assert errors == pytest.approx({"approach_error": 3e-7})
    names = ("method", "periodic", "tolerance", "largest_residual", "sliding_direction", "warnings", "code")
    expected = ["fft", 1, 1e-8, own.certificate.largest, 0.3, "x\ny", "1.2"]
    assert [found[name] for name in names] == expected
    assert [found[f"{name}_unit"] for name in SHOWN] == [row[2] for row in SHOWN.values()]
