"""The scene: frame, datum, sliding offset, numbers of any width, the roughness that a grid must resolve."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import refimpl as rf
from refimpl.driver.options import Options
from refimpl.grid import Grid
from refimpl.scene.parameters import moving, parameters
from refimpl.scene.resolution import resolution

STEEL = rf.Material(200e9, 0.3)
ROUGH = rf.GaussianRoughness(rms=1e-6, correlation_length=400e-6, seed=7)
SCENE = rf.Scene(
    upper=rf.Body(STEEL, rf.Sphere(0.14)),
    lower=rf.Body(STEEL, ROUGH),
    friction=rf.Friction(15e6, 0.08),
    load=70.0,
    side=1e-3,
)
GRID = rf.Grid.square(SCENE.side, 16)


def test_heights_are_about_their_mid_height() -> None:
    for z in SCENE.heights(GRID):
        assert z.shape == (16, 16)
        assert abs(z.min() + z.max()) <= 1e-15 * np.ptp(z)


def test_x_is_the_first_axis() -> None:
    z = np.arange(16.0)[:, None] * np.ones(16) * 1e-8
    lower, _ = replace(SCENE, lower=rf.Body(STEEL, z)).heights(GRID)
    np.testing.assert_allclose(np.diff(lower, axis=0), 1e-8, rtol=1e-9)
    assert np.all(np.diff(lower, axis=1) == 0)


@pytest.mark.parametrize("angle", [0.0, math.pi / 2, 0.7])
def test_sliding_samples_the_lower_surface_ahead_and_leaves_the_upper(angle: float) -> None:
    """The frame rides with the upper body; after one element along x the old row 1 is row 0."""
    h = GRID.spacings[0]
    slid = replace(SCENE, sliding_direction=angle, sliding_offset=h)
    lower, upper = slid.heights(GRID)
    np.testing.assert_array_equal(upper, SCENE.heights(GRID)[1])
    offset = (h * math.cos(angle), h * math.sin(angle))
    expected = ROUGH.heights(GRID, offset)
    np.testing.assert_allclose(np.diff(lower, axis=0), np.diff(expected, axis=0), atol=1e-20)
    if angle == 0:
        still = ROUGH.heights(GRID)
        # the field is sampled at positions that differ by rounding, times its slope of 0.005
        np.testing.assert_allclose(expected[:-1], still[1:], atol=1e-17)


def test_bodies_take_arrays_and_sums() -> None:
    z = np.ones((16, 16)) * 1e-6
    together = rf.Body(STEEL, rf.Sphere(0.14) + ROUGH + z)
    apart = rf.Sphere(0.14).heights(GRID) + ROUGH.heights(GRID) + z
    np.testing.assert_allclose(together.surface.heights(GRID), apart, rtol=1e-15)


def test_a_scenes_grid_has_its_side_and_its_kind() -> None:
    for periodic in (False, True):
        scene = replace(SCENE, periodic=periodic)
        assert scene.lengths == (1e-3, 1e-3)
        assert scene.grid(16) == rf.Grid.square(1e-3, 16, periodic=periodic)
    for count in (0, -1, 8.0, "8", True):
        with pytest.raises(rf.InputError, match="grid"):
            SCENE.grid(count)  # type: ignore[arg-type]  # the point of the test


ROUGH_BALL = rf.read_scene("table1-rough")
WIDTHS = (np.float32, np.float16, np.longdouble, np.int64, np.uint64, Fraction)


@pytest.mark.parametrize("width", WIDTHS)
def test_parameters_are_stored_as_doubles(width: Any) -> None:
    material = rf.Material(E=width(2), nu=width(0), hardness=width(3))
    friction = rf.Friction(tau=width(5), beta=width(1))
    scene = replace(
        ROUGH_BALL, load=width(70), side=width(1), sliding_direction=width(1), sliding_offset=width(0)
    )
    options = Options(scene=scene, grid=16, approach=width(1))
    numbers = (
        *(material.E, material.nu, material.hardness, friction.tau, friction.beta, options.approach),
        *(scene.load, scene.side, scene.sliding_direction, scene.sliding_offset),
    )
    assert {type(number) for number in numbers} == {float}
    assert numbers == (2.0, 0.0, 3.0, 5.0, 1.0, 1.0, 70.0, 1.0, 1.0, 0.0)


def test_single_precision_in_is_double_precision_throughout() -> None:
    side, load = np.float32(ROUGH_BALL.side), np.float32(ROUGH_BALL.load)
    single = rf.solve(replace(ROUGH_BALL, side=side, load=load), np.int64(24), tolerance=np.float64(1e-8))
    double = rf.solve(replace(ROUGH_BALL, side=float(side), load=float(load)), 24)
    assert single.converged
    assert np.array_equal(single.pressure, double.pressure)
    assert type(single.friction_coefficient) is type(single.contact_area) is float


def test_the_written_forms_take_them() -> None:
    scene = replace(ROUGH_BALL, load=np.int64(70), friction=rf.Friction(np.float32(15e6), np.float32(0.5)))
    assert "load = 70.0" in rf.scene_to_toml(scene)
    json.dumps(rf.solve(scene, np.int64(8), approach=np.float32(1e-6)).summary())


def measured(path: Path, shape: tuple[int, int]) -> rf.Body:
    np.save(path, np.random.default_rng(1).normal(size=shape))
    return rf.Body(STEEL, rf.MeasuredSurface(path, unit="um", pixel_size=1e-5))


def test_the_roughness_that_is_resolved_worst_counts() -> None:
    """Elements per length over those required: not the fewest elements."""
    gaussian = rf.GaussianRoughness(1e-6, 6e-5, seed=1)
    waves = rf.SelfAffineRoughness(
        hurst=0.8, rms=1e-7, roll_off=2e-4, long_cut=4e-4, short_cut=5.4e-5, seed=2
    )
    grid = Grid((100, 50), (1e-3, 1e-3))  # elements of 10 x 20 um: the longer edge counts

    def of(*parts: rf.Surface) -> tuple[float, float]:
        lower = rf.Body(STEEL, sum(parts[1:], start=parts[0]))
        scene = rf.Scene(rf.Body(STEEL, rf.Flat()), lower, rf.Friction(), 1.0, 1e-3)
        found = resolution(scene, grid, 1e-3)
        assert found is not None
        assert found == resolution(replace(scene, lower=scene.upper, upper=lower), grid, 1e-3)
        return found.elements, found.required

    alone = [of(gaussian), of(waves)]
    assert [elements for elements, _ in alone] == pytest.approx([3.0, 2.7])
    assert alone[0][1] == pytest.approx(math.sqrt(math.log(10) / 1e-3), rel=1e-2)
    worst = min(alone, key=lambda pair: pair[0] / pair[1])
    assert worst == alone[0] != min(alone)
    assert of(gaussian, waves) == of(waves, gaussian) == worst


def test_parameters_that_are_zero_do_not_move() -> None:
    lower = rf.Body(STEEL, rf.GaussianRoughness(1e-6, (1e-4, 2e-4), seed=3))
    scene = rf.Scene(rf.Body(STEEL, rf.Sphere(0.1)), lower, rf.Friction(tau=0.0, beta=0.2), 7.0, 1e-3)
    still = {"friction.tau", "lower.surface[0].lay", "lower.surface[0].seed"}
    assert set(parameters(scene)) - set(moving(scene)) == still
    rigid = replace(scene, upper=rf.Body(rf.Material(math.inf, 0.3), rf.Sphere(0.1)))
    assert set(parameters(rigid)) - set(moving(rigid)) == {*still, "upper.material.E", "upper.material.nu"}


@pytest.mark.parametrize("given", [{}, {"side": 1e-4}, {"size": (1.5e-4, 1e-4)}], ids=str)
def test_a_size_that_nobody_gave_is_noted(given: dict[str, Any], tmp_path: Path) -> None:
    body = measured(tmp_path / "a.npy", (30, 20))
    scene = rf.Scene(rf.Body(STEEL, rf.Flat()), body, rf.Friction(), 1.0, **given)
    assert any("no size given" in line for line in scene.cautions(scene.grid(8))) == (not given)


def test_balls_go_on_beyond_a_free_domain_alone() -> None:
    ball, bowl = rf.Body(STEEL, rf.Sphere(0.1)), rf.Body(STEEL, rf.Sphere(0.1))
    flat = rf.Body(STEEL, rf.Flat())
    free, periodic = (rf.Scene(ball, flat, rf.Friction(), 1.0, 1e-3, periodic=p) for p in (False, True))
    assert (free.continues, periodic.continues) == (True, False)
    assert not rf.Scene(ball, bowl, rf.Friction(), 1.0, 1e-3).continues  # one fills the other
