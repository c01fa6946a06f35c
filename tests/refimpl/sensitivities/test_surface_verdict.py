"""The half-space judged on one's own surface: local map, share of the area, every number, advice."""

from __future__ import annotations

import math

import numpy as np
import pytest

import refimpl as rf
from refimpl.grid import Grid
from refimpl.model.elasticity import Elasticity
from refimpl.model.materials import Pair
from refimpl.model.problem import Problem, Terms
from refimpl.sensitivities.surface_verdict import (
    _evidence,
    pressed_on_a_flat,
    surface_verdict,
)
from refimpl.solution.influence_error import coefficient_error
from refimpl.solution.influence_error_3d import element_error
from refimpl.solution.local_error import local_error, share_above, short_wave_share

RIGID = rf.Material(math.inf, 0.3)
COPPER, STEEL = rf.Material(118e9, 0.3), rf.Material(200e9, 0.3)


def problem(grid: Grid, lower: np.ndarray, pair: Pair) -> Problem:
    gap = -lower - (-lower).min()
    return Problem(grid, gap, lower + gap / 2, Elasticity(pair), rf.Friction(), 0.0, Terms(), 1.0, None)


def test_surfaces_that_are_constant_along_an_axis_have_the_errors_of_strips() -> None:
    grid = Grid.square(1.0, 16)
    height = np.repeat(math.tan(math.radians(10.0)) * grid.x[:, None], 16, axis=1)
    found = local_error(problem(grid, height, Pair(COPPER, RIGID)))
    assert found == pytest.approx(coefficient_error(math.radians(10.0), COPPER), rel=1e-9)
    assert found[0, 0] < element_error(math.radians(10.0), COPPER).in_line


def test_the_share_of_the_area_is_counted() -> None:
    grid = Grid.square(1.0, 16)
    # 8 degrees on the right half; central differences leave a quarter of it at column 7, 3/4 at column 8
    height = math.tan(math.radians(8.0)) * np.maximum(grid.x - 0.5, 0.0)[:, None] + 0 * grid.y[None, :]
    height[0, 0] += 1e-15  # not constant along y
    found = local_error(problem(grid, height, Pair(COPPER, RIGID)))
    assert share_above(found, 0.02) == 8 / 16  # 6 degrees: 3.8 %, 2 degrees: 1.3 %
    assert share_above(np.full((2, 2), math.inf), 0.02) == 1.0
    with pytest.raises(rf.InputError):
        share_above(found, 0.0)


def test_two_waves_share_by_the_square_of_their_slopes() -> None:
    grid = Grid((64, 64), (1.0, 1.0), periodic=True)
    x, y = grid.x[:, None], grid.y[None, :]
    # amplitudes 4 and 1 at 4 and 8 waves: slopes 16 to 8, squares 4 to 1
    height = 4 * np.cos(8 * math.pi * x) + np.cos(16 * math.pi * y)
    assert short_wave_share(problem(grid, height, Pair(COPPER, RIGID))) == pytest.approx(0.2, rel=1e-9)


def rough(rms: float = 0.05) -> rf.ArraySurface:
    x = (np.arange(32) + 0.5) / 32
    height = rms * (np.cos(2 * math.pi * x)[:, None] * np.cos(4 * math.pi * x)[None, :])
    return rf.ArraySurface(height, pixel=1 / 32)


def test_a_surface_alone_is_pressed_by_a_twentieth_of_its_rms_gradient() -> None:
    """Slopes of 0.1 and -0.2 on 1 x 2 m: the gradient is sqrt(0.05). E* of one body: 118 / (1 - 0.16) GPa."""
    x, y = (np.arange(8) + 0.5) / 8, (np.arange(16) + 0.5) / 8
    plane, law = rf.ArraySurface(0.1 * x[:, None] - 0.2 * y[None, :], pixel=1 / 8), rf.Friction(3e6, 0.2)
    scene = pressed_on_a_flat(plane, rf.Material(118e9, 0.4), grid=16, friction=law)
    assert scene.load == pytest.approx(0.05 * 118e9 / 0.84 * math.sqrt(0.05) * 2, rel=1e-9)
    assert (scene.friction, scene.upper.material) == (law, rf.Material(math.inf, 0.4))
    assert pressed_on_a_flat(plane, COPPER, grid=16, pressure=3e6).load == pytest.approx(6e6)


@pytest.mark.parametrize("pressure", [None, -1.0, 0.0, math.inf])
def test_a_flat_surface_or_no_pressure_is_refused(pressure: float | None) -> None:
    surface = rf.ArraySurface(np.zeros((8, 8)), pixel=0.125) if pressure is None else rough()
    with pytest.raises(rf.InputError):
        pressed_on_a_flat(surface, COPPER, grid=8, pressure=pressure)


def test_the_verdict_has_every_number_its_share_and_its_evidence() -> None:
    scene = pressed_on_a_flat(rough(), COPPER, grid=32, friction=rf.Friction(beta=0.1))
    verdict = surface_verdict(scene, 32)
    assert verdict.local.shape == (32, 32)
    assert verdict.share_above == float(np.mean(verdict.local > 0.02)) > 0.5
    numbers = verdict.numbers()
    for name in ("friction_coefficient", "contact_area", "max_pressure", "approach", "normal_force"):
        row = numbers[name]
        parts = abs(row["corrected"] - row["value"]) + row["second_order"] + row["finite_strain"]
        assert row["corrected"] == row["value"] + verdict.error.first_order[name]
        assert row["stated"] == pytest.approx(parts)
    # rms gradient of the crossed waves: 0.05 * 2 pi * sqrt(1 + 4) / 2 = 0.351, times sqrt 2: 26.4 degrees
    assert verdict.evidence.startswith("slopes of 26 degrees")
    assert "beyond 20 degrees" in verdict.evidence
    assert verdict.advice.endswith("use finite elements")


def test_a_gentle_surface_keeps_the_half_space() -> None:
    verdict = surface_verdict(pressed_on_a_flat(rough(5e-4), COPPER, grid=32), 32)
    assert verdict.share_above == 0.0
    assert verdict.advice.startswith("keep the half-space")
    assert "finer grid" not in verdict.evidence


@pytest.mark.parametrize(("short", "said"), [(0.09, False), (0.15, True)])
def test_the_evidence_names_short_waves_from_a_tenth_of_the_mean_square_slope_on(
    short: float, said: bool
) -> None:
    upper, lower = rf.Body(RIGID, rf.Sphere(5.0)), rf.Body(COPPER, rf.Flat())
    found = _evidence(rf.solve(rf.Scene(upper, lower, rf.Friction(), load=1e4, side=1.0), 16), short)
    assert "rests on 56 plane contacts and 6 pairs" in found
    assert ("15% of the mean square slope is at wavelengths below ten elements" in found) is said
