"""The shipped three-dimensional errors: tabulated values met, first order exact, pairs subtract."""

from __future__ import annotations

import json
import math
from dataclasses import astuple
from importlib import resources

import numpy as np
import pytest

import refimpl as rf
from appendix_a.fem3d.leading_order import first_order
from appendix_a.fem3d.patch import normal_coefficient
from appendix_a.fem3d.surface import X, Y
from appendix_a.fem3d.wavy import Waviness
from refimpl.element_error import element_error

STEEL, COPPER = rf.Material(E=200e9, nu=0.3), rf.Material(E=118e9, nu=0.3)
RIGID = rf.Material(E=1e22, nu=0.3)
TABLE = json.loads(
    resources.files("refimpl").joinpath("data", "coefficient_error_3d.json").read_text("utf-8")
)


@pytest.mark.parametrize("nu", [0.0, 0.3, 0.45])
@pytest.mark.parametrize("degrees", [2.5, 10.0, 30.0])
def test_tabulated_errors_are_met(nu: float, degrees: float) -> None:
    keys = {"slope_deg": degrees, "nu": nu, "wavelength": 20.0, "kind": "ridge", "width": "projected"}
    rows = [
        p
        for p in TABLE["points"]
        if all(p[k] == v for k, v in keys.items()) and p["position"] in (0, 0.25, 0.5)
    ]
    errors = np.abs([row["error"] for row in rows]).max(axis=0)
    expected = errors[0], errors[1:7].max(), errors[7:].max()
    found = element_error(math.radians(degrees), rf.Material(E=1e9, nu=nu))
    assert astuple(found) == pytest.approx(expected, rel=1e-9)


def test_a_ratio_between_the_tabulated_ones_against_first_order_theory() -> None:
    slope, unit = math.radians(0.5), Waviness(0.5, 20.0, 0.25)
    found, theory = [], []
    for nu in (0.15, 0.3):
        found.append(element_error(slope, rf.Material(E=1e9, nu=nu)).in_line)
        theory.append(np.abs(first_order(unit, X, Y, nu) / normal_coefficient(X, Y, nu))[1:7].max())
    # the quotient of 2.5 degrees is taken for 0.5; second order is 4 % of it at nu 0.3, and less at 0.15
    assert found[0] / found[1] == pytest.approx(theory[0] / theory[1], rel=0.04)


def test_pairs() -> None:
    slope = math.radians(6.5)
    assert astuple(element_error(slope, COPPER, RIGID)) == pytest.approx(
        astuple(element_error(slope, COPPER))
    )
    assert astuple(element_error(slope, RIGID, COPPER)) == pytest.approx(
        astuple(element_error(slope, COPPER))
    )
    assert element_error(slope, STEEL, STEEL).in_line < 0.2 * element_error(slope, STEEL).in_line


@pytest.mark.parametrize("slope", [-0.1, 0.53, math.nan])
def test_refuses_slopes_beyond_the_table(slope: float) -> None:
    with pytest.raises(rf.InputError, match="slope"):
        element_error(slope, STEEL)


def test_refuses_negative_ratios() -> None:
    with pytest.raises(rf.InputError, match="nu"):
        element_error(0.1, rf.Material(E=1e9, nu=-0.1))
