"""The scene: frame, datum, offsets, numbers of any width, resolution, and the problem posed on a grid."""

from __future__ import annotations

import math
from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

import refimpl as rf
from refimpl.driver.options import Options
from refimpl.grid import Grid
from refimpl.model.problem import Terms
from refimpl.scene.discretise import discretise
from refimpl.solution.domain_error import resolution

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


def test_balls_go_on_beyond_a_free_domain_alone() -> None:
    ball, bowl = rf.Body(STEEL, rf.Sphere(0.1)), rf.Body(STEEL, rf.Sphere(0.1))
    flat = rf.Body(STEEL, rf.Flat())
    free, periodic = (rf.Scene(ball, flat, rf.Friction(), 1.0, 1e-3, periodic=p) for p in (False, True))
    assert (free.continues, periodic.continues) == (True, False)
    assert not rf.Scene(ball, bowl, rf.Friction(), 1.0, 1e-3).continues  # one fills the other


SMOOTH = rf.read_scene("table1-smooth")
FLAT = Terms(coupled=False, oblique=False, tilted=False)
ROUGH_FLAT = replace(SMOOTH, lower=rf.Body(SMOOTH.lower.material, rf.GaussianRoughness(1e-6, 4e-4, seed=2)))
PLANES = rf.read_scene("rough-planes")
RECTANGLE = Grid((12, 20), (1.2e-3, 2.5e-3))


def test_heights_of_a_scene_are_its_own() -> None:
    """Problems are built in the memory of the sampled heights, never in a user's array."""
    heights = np.random.default_rng(2).uniform(0, 1e-6, (16, 16))
    kept = heights.copy()
    scene = replace(SMOOTH, lower=rf.Body(SMOOTH.lower.material, heights))
    first, second = (discretise(scene, scene.grid(16), FLAT) for _ in range(2))
    assert np.array_equal(heights, kept)
    assert np.array_equal(first.gap, second.gap)
    lower, upper = first.heights
    assert np.allclose(upper - lower, first.gap, rtol=0, atol=1e-18)
    assert np.array_equal(first.mean_surface, second.mean_surface)


@pytest.mark.parametrize("grid", [ROUGH_FLAT.grid(16), RECTANGLE], ids=str)
def test_gap_and_mean_surface_are_those_of_the_heights_at_first_contact(grid: Grid) -> None:
    lower, upper = ROUGH_FLAT.sampled(grid)
    problem, raised = discretise(ROUGH_FLAT, grid), (lower - upper).max()
    assert problem.gap.min() == 0.0
    np.testing.assert_allclose(problem.gap, upper + raised - lower, rtol=0, atol=1e-20)
    np.testing.assert_allclose(problem.mean_surface, (lower + upper + raised) / 2, rtol=0, atol=1e-20)


# --- approach and datum ---


@pytest.mark.parametrize("grid", [SMOOTH.grid(16), RECTANGLE], ids=str)
def test_approaches_count_from_first_contact_where_a_scene_is_free(grid: Grid) -> None:
    for approach in (-1e-6, 0.0, 2e-6):
        problem = discretise(ROUGH_FLAT, grid, approach=approach)
        assert (problem.load, problem.approach, problem.datum) == (None, approach, 0.0)
        assert problem.counts_from_first_contact
    assert (discretise(ROUGH_FLAT, grid).load, discretise(ROUGH_FLAT, grid).approach) == (
        ROUGH_FLAT.load,
        None,
    )


@pytest.mark.parametrize("grid", [PLANES.grid(16), replace(RECTANGLE, periodic=True)], ids=str)
def test_approaches_count_from_mean_planes_where_a_scene_is_periodic(grid: Grid) -> None:
    """First contact lies the mean gap above: the datum, which a problem adds and a solution subtracts."""
    problem = discretise(PLANES, grid, approach=-1e-9)
    assert problem.datum == problem.gap.mean() > 1e-9
    assert problem.approach == problem.datum - 1e-9
    assert not problem.counts_from_first_contact
    assert discretise(PLANES, grid).datum == problem.datum


def test_the_least_approach_of_mean_planes_is_ten_units_in_the_last_place_of_their_gap() -> None:
    heights = np.zeros((4, 4))
    heights[0, 0] = 1.6e-5  # the mean gap, 15 / 16 of it, is 1.5e-5 m: doubles there are 1.7e-21 m apart
    lower, upper = rf.Body(SMOOTH.lower.material, heights), rf.Body(SMOOTH.upper.material, rf.Flat())
    scene = replace(PLANES, lower=lower, upper=upper)
    grid = scene.grid(4)
    with pytest.raises(rf.InputError, match=r"at least 1\.7e-20 m below 0"):
        discretise(scene, grid, approach=-1.6e-20)
    assert discretise(scene, grid, approach=-1.8e-20).approach is not None


@pytest.mark.parametrize("size", [(2e-3, 1e-3), (1e-3, 2e-3)])
def test_heights_may_reach_the_longer_side_of_a_rectangle(size: tuple[float, float]) -> None:
    def rough(height: float) -> rf.Scene:
        heights = np.array([[0.0, height], [0.0, 0.0]])
        pixel = (size[0] / 2, size[1] / 2)
        body = rf.Body(SMOOTH.lower.material, rf.ArraySurface(heights, pixel=pixel))
        flat = rf.Body(SMOOTH.upper.material, rf.Flat())
        return replace(SMOOTH, upper=flat, lower=body, side=None, size=size)

    rough(1.9e-3).sampled(Grid((2, 2), size))
    with pytest.raises(rf.InputError, match=r"at most the longer side, 0\.002 m"):
        rough(2.1e-3).sampled(Grid((2, 2), size))
