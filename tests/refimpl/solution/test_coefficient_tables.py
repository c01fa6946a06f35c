"""The reader of both shipped tables of coefficient errors: what it returns and what it refuses."""

from __future__ import annotations

import json
from importlib import resources
from itertools import product
from typing import Any

import numpy as np
import pytest

import refimpl as rf
from refimpl.half_space.coefficient_tables import PLANE, SPACE, Layout, read_table, shipped_table


def shipped(layout: Layout) -> dict[str, Any]:
    text = resources.files("refimpl").joinpath("data", layout.file).read_text("utf-8")
    document: dict[str, Any] = json.loads(text)
    return document


STRIPS, ELEMENTS = shipped(PLANE), shipped(SPACE)


@pytest.mark.parametrize("layout", [PLANE, SPACE], ids=["plane", "space"])
def test_axes_and_arrays_are_those_of_the_layout(layout: Layout) -> None:
    table = shipped_table(layout)
    assert list(table) == [*layout.axes, *layout.arrays]
    shape = tuple(len(table[name]) for name in layout.axes)
    assert all(table[name].shape[: len(shape)] == shape for name in layout.arrays)


def test_strips_are_read_as_they_stand() -> None:
    for name, found in shipped_table(PLANE).items():
        np.testing.assert_array_equal(found, STRIPS[name])


@pytest.mark.parametrize("points", [ELEMENTS["points"], ELEMENTS["points"][::-1]], ids=["filed", "reversed"])
def test_only_projected_ridges_of_the_standard_length_count(points: list[dict[str, Any]]) -> None:
    """Wherever egg-boxes, facets and longer waves stand in the file."""
    table = read_table(json.dumps(ELEMENTS | {"points": points}), SPACE)
    assert table["slope_deg"].tolist() == [2.5, 6.5, 10.0, 15.0, 20.0, 30.0]
    assert table["nu"].tolist() == [0.0, 0.3, 0.45]
    assert table["position"].tolist() == [0.0, 0.25, 0.5]
    rows = {
        (p["nu"], p["position"], p["slope_deg"]): p["error"]
        for p in points
        if (p["wavelength"], p["kind"], p["width"]) == (20.0, "ridge", "projected")
    }
    nodes = product(*(table[name].tolist() for name in SPACE.axes))
    np.testing.assert_array_equal(table["error"].reshape(-1, 10), [rows[node] for node in nodes])


@pytest.mark.parametrize("version", [0, 2, None])
@pytest.mark.parametrize("layout", [PLANE, SPACE], ids=["plane", "space"])
def test_a_table_of_another_version_is_refused(layout: Layout, version: int | None) -> None:
    with pytest.raises(rf.InputError, match=rf"^{layout.file} = {version}: expected version 1"):
        read_table(json.dumps(shipped(layout) | {"version": version}), layout)


@pytest.mark.parametrize(
    ("changed", "field"),
    [
        ({"position": [0.0, 0.25]}, "position"),
        ({"position": [0.0, 0.1, 0.5]}, "position"),
        ({"wavelength": [50.0]}, "wavelength"),
        ({"wavelength": None}, "wavelength"),
        ({"slope_deg": [2.5, 2.5, 5.0, 6.5]}, "slope_deg"),
        ({"slope_deg": [2.5, 6.5, 10.0]}, "slope_deg"),
        ({"offset": [-1.0, 1.0]}, "offset"),
        ({"kappa_part": [0.0]}, "kappa_part"),
        ({"constant_part": None}, "constant_part"),
    ],
)
def test_incomplete_strips_are_refused(changed: dict[str, object], field: str) -> None:
    with pytest.raises(rf.InputError, match=f"^{field} = "):
        read_table(json.dumps(STRIPS | changed), PLANE)


@pytest.mark.parametrize(
    ("missing", "field"),
    [
        ({"position": 0.25}, "position"),
        ({"nu": 0.45}, "nu"),
        ({"wavelength": 20.0}, "nu"),
        ({"nu": 0.3, "position": 0.5}, "slope_deg"),
    ],
)
def test_elements_without_a_whole_axis_are_refused(missing: dict[str, float], field: str) -> None:
    points = [p for p in ELEMENTS["points"] if any(p[name] != value for name, value in missing.items())]
    with pytest.raises(rf.InputError, match=f"^{field} = "):
        read_table(json.dumps(ELEMENTS | {"points": points}), SPACE)


def test_a_slope_without_one_of_its_points_is_left_out() -> None:
    points = [p for p in ELEMENTS["points"] if (p["nu"], p["position"], p["slope_deg"]) != (0.0, 0.5, 15.0)]
    table = read_table(json.dumps(ELEMENTS | {"points": points}), SPACE)
    assert table["slope_deg"].tolist() == [2.5, 6.5, 10.0, 20.0, 30.0]
