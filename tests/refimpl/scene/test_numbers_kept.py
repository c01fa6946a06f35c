"""Numbers of any width go into a scene; doubles are computed with, and come out."""

from __future__ import annotations

import json
from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

import refimpl as rf
from refimpl.driver.options import Options

SCENE = rf.read_scene("table1-rough")
WIDTHS = (np.float32, np.float16, np.longdouble, np.int64, np.uint64, Fraction)


@pytest.mark.parametrize("width", WIDTHS)
def test_parameters_are_stored_as_doubles(width: Any) -> None:
    material = rf.Material(E=width(2), nu=width(0), hardness=width(3))
    friction = rf.Friction(tau=width(5), beta=width(1))
    scene = replace(SCENE, load=width(70), side=width(1), sliding_direction=width(1), sliding_offset=width(0))
    options = Options(scene=scene, grid=16, approach=width(1))
    numbers = (
        *(material.E, material.nu, material.hardness, friction.tau, friction.beta, options.approach),
        *(scene.load, scene.side, scene.sliding_direction, scene.sliding_offset),
    )
    assert {type(number) for number in numbers} == {float}
    assert numbers == (2.0, 0.0, 3.0, 5.0, 1.0, 1.0, 70.0, 1.0, 1.0, 0.0)


def test_single_precision_in_is_double_precision_throughout() -> None:
    side, load = np.float32(SCENE.side), np.float32(SCENE.load)
    single = rf.solve(replace(SCENE, side=side, load=load), np.int64(24), tolerance=np.float64(1e-8))
    double = rf.solve(replace(SCENE, side=float(side), load=float(load)), 24)
    assert single.converged
    assert np.array_equal(single.pressure, double.pressure)
    assert type(single.friction_coefficient) is type(single.contact_area) is float


def test_the_written_forms_take_them() -> None:
    scene = replace(SCENE, load=np.int64(70), friction=rf.Friction(np.float32(15e6), np.float32(0.5)))
    assert "load = 70.0" in rf.scene_to_toml(scene)
    json.dumps(rf.solve(scene, np.int64(8), approach=np.float32(1e-6)).summary())
