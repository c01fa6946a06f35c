"""The reader of both shipped tables of coefficient errors: what it returns and what it refuses."""

from __future__ import annotations

import json
from importlib import resources
from itertools import product
from typing import Any

import numpy as np
import pytest

import refimpl as rf
from refimpl.solution.coefficient_tables import PLANE, SPACE, Layout, read_table, shipped_table


def shipped(layout: Layout) -> dict[str, Any]:
    text = resources.files("refimpl").joinpath("data", layout.file).read_text("utf-8")
    document: dict[str, Any] = json.loads(text)
    return document


STRIPS, ELEMENTS = shipped(PLANE), shipped(SPACE)


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


def without(**values: float) -> dict[str, Any]:
    """The file of elements without points of these values."""
    points = [p for p in ELEMENTS["points"] if any(p[name] != value for name, value in values.items())]
    return ELEMENTS | {"points": points}


@pytest.mark.parametrize(
    ("layout", "document", "refusal"),
    [
        (PLANE, STRIPS | {"version": 2}, rf"{PLANE.file} = 2: expected version 1"),
        (SPACE, ELEMENTS | {"version": None}, rf"{SPACE.file} = None: expected version 1"),
        (PLANE, STRIPS | {"position": [0.0, 0.25]}, "position = "),
        (PLANE, STRIPS | {"position": [0.0, 0.1, 0.5]}, "position = "),
        (PLANE, STRIPS | {"wavelength": None}, "wavelength = "),
        (PLANE, STRIPS | {"slope_deg": [2.5, 2.5, 5.0, 6.5]}, "slope_deg = "),
        (PLANE, STRIPS | {"slope_deg": [2.5, 6.5, 10.0]}, "slope_deg = "),
        (PLANE, STRIPS | {"offset": [-1.0, 1.0]}, "offset = "),
        (PLANE, STRIPS | {"kappa_part": [0.0]}, "kappa_part = "),
        (SPACE, without(position=0.25), "position = "),
        (SPACE, without(nu=0.45), "nu = "),
        (SPACE, without(nu=0.3, position=0.5), "slope_deg = "),
    ],
)
def test_malformed_input_is_refused(layout: Layout, document: dict[str, Any], refusal: str) -> None:
    with pytest.raises(rf.InputError, match=f"^{refusal}"):
        read_table(json.dumps(document), layout)


def test_a_slope_without_one_of_its_points_is_left_out() -> None:
    table = read_table(json.dumps(without(nu=0.0, position=0.5, slope_deg=15.0)), SPACE)
    assert table["slope_deg"].tolist() == [2.5, 6.5, 10.0, 20.0, 30.0]
