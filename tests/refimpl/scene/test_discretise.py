"""From scenes to problems: heights sampled once a grid, and one place for the datum of the approach."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import ClassVar

import numpy as np
import pytest

import refimpl as rf
from refimpl.grid import Array, Grid
from refimpl.model.problem import Terms
from refimpl.scene.discretise import discretise

SCENE = rf.read_scene("table1-smooth")
FLAT = Terms(coupled=False, oblique=False, tilted=False)
ROUGH = replace(SCENE, lower=rf.Body(SCENE.lower.material, rf.GaussianRoughness(1e-6, 4e-4, seed=2)))
PLANES = rf.read_scene("rough-planes")
RECTANGLE = Grid((12, 20), (1.2e-3, 2.5e-3))


@dataclass(frozen=True)
class Counted(rf.Sphere):
    """A ball that counts how often it is sampled, and warns each time."""

    radius: float = 0.14
    sampled: list[int] = field(default_factory=list)
    kind: ClassVar[str] = "counted"

    def sample(self, grid: Grid, offset: tuple[float, float] = (0.0, 0.0)) -> Array:
        self.sampled.append(grid.shape[0])
        return super().sample(grid, offset)

    def cautions(self, grid: Grid) -> tuple[str, ...]:
        return ("counted by hand",)


def counted() -> tuple[rf.Scene, list[int]]:
    ball = Counted()
    return replace(SCENE, upper=rf.Body(SCENE.upper.material, ball)), ball.sampled


def test_a_solve_on_a_grid_samples_once_and_says_once_what_surfaces_note() -> None:
    scene, sampled = counted()
    found = rf.solve(scene, grid=32)
    assert sampled == [32]
    assert [str(line) for line in found.warnings].count("counted by hand") == 1


def test_a_refinement_samples_each_grid_once_and_the_one_that_decides() -> None:
    scene, sampled = counted()
    rf.solve(scene, accuracy=0.03)
    assert sampled[0] == 256
    assert len(set(sampled)) == len(sampled)


def test_heights_of_a_scene_are_its_own() -> None:
    """Problems are built in the memory of the sampled heights, never in a user's array."""
    heights = np.random.default_rng(2).uniform(0, 1e-6, (16, 16))
    kept = heights.copy()
    scene = replace(SCENE, lower=rf.Body(SCENE.lower.material, heights))
    first, second = (discretise(scene, scene.grid(16), FLAT) for _ in range(2))
    assert np.array_equal(heights, kept)
    assert np.array_equal(first.gap, second.gap)
    lower, upper = first.heights
    assert np.allclose(upper - lower, first.gap, rtol=0, atol=1e-18)
    assert np.array_equal(first.mean_surface, second.mean_surface)


@pytest.mark.parametrize("grid", [ROUGH.grid(16), RECTANGLE], ids=str)
def test_gap_and_mean_surface_are_those_of_the_heights_at_first_contact(grid: Grid) -> None:
    lower, upper = ROUGH.sampled(grid)
    problem, raised = discretise(ROUGH, grid), (lower - upper).max()
    assert problem.gap.min() == 0.0
    np.testing.assert_allclose(problem.gap, upper + raised - lower, rtol=0, atol=1e-20)
    np.testing.assert_allclose(problem.mean_surface, (lower + upper + raised) / 2, rtol=0, atol=1e-20)


# --- approach and datum ---


@pytest.mark.parametrize("grid", [SCENE.grid(16), RECTANGLE], ids=str)
def test_approaches_count_from_first_contact_where_a_scene_is_free(grid: Grid) -> None:
    for approach in (-1e-6, 0.0, 2e-6):
        problem = discretise(ROUGH, grid, approach=approach)
        assert (problem.load, problem.approach, problem.datum) == (None, approach, 0.0)
        assert problem.counts_from_first_contact
    assert (discretise(ROUGH, grid).load, discretise(ROUGH, grid).approach) == (ROUGH.load, None)


@pytest.mark.parametrize("grid", [PLANES.grid(16), replace(RECTANGLE, periodic=True)], ids=str)
def test_approaches_count_from_mean_planes_where_a_scene_is_periodic(grid: Grid) -> None:
    """First contact lies the mean gap above: the datum, which a problem adds and a solution subtracts."""
    problem = discretise(PLANES, grid, approach=-1e-9)
    assert problem.datum == problem.gap.mean() > 1e-9
    assert problem.approach == problem.datum - 1e-9
    assert not problem.counts_from_first_contact
    assert discretise(PLANES, grid).datum == problem.datum


@pytest.mark.parametrize("method", ["fft", "dense"])
def test_a_periodic_solution_reports_its_approach_from_mean_planes(method: str) -> None:
    under_load = rf.solve(PLANES, 16, method=method, tolerance=1e-11)
    problem = under_load.problem
    assert under_load.approach < 0 < under_load.approach + problem.datum
    touching, v = under_load.contact, under_load.clearance + under_load.approach + problem.datum
    assert np.abs(v[touching] / (under_load.approach + problem.datum) - 1).max() < 1e-9
    at_approach = rf.solve(PLANES, 16, method=method, approach=under_load.approach, tolerance=1e-11)
    assert at_approach.approach == under_load.approach
    assert at_approach.normal_force == pytest.approx(PLANES.load, rel=1e-7)
    # that far apart, mean planes are separated by more than the mean gap: no contact
    apart = rf.solve(PLANES, 16, method=method, approach=-1.001 * problem.datum)
    assert apart.status is rf.Status.NO_CONTACT


def test_the_least_approach_of_mean_planes_is_ten_units_in_the_last_place_of_their_gap() -> None:
    heights = np.zeros((4, 4))
    heights[0, 0] = 1.6e-5  # the mean gap, 15 / 16 of it, is 1.5e-5 m: doubles there are 1.7e-21 m apart
    lower, upper = rf.Body(SCENE.lower.material, heights), rf.Body(SCENE.upper.material, rf.Flat())
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
        body = rf.Body(SCENE.lower.material, rf.ArraySurface(heights, pixel=pixel))
        flat = rf.Body(SCENE.upper.material, rf.Flat())
        return replace(SCENE, upper=flat, lower=body, side=None, size=size)

    rough(1.9e-3).sampled(Grid((2, 2), size))
    with pytest.raises(rf.InputError, match=r"at most the longer side, 0\.002 m"):
        rough(2.1e-3).sampled(Grid((2, 2), size))
