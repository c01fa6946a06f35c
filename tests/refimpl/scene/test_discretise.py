"""A scene's heights are sampled once where its terms are decided on the grid that is solved."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import ClassVar

import numpy as np
import pytest

import refimpl as rf
from refimpl.grid import Array
from refimpl.model.problem import Terms, pose
from refimpl.scene.discretise import EVERYTHING, Posing
from refimpl.surfaces import SurfaceWarning

SCENE = rf.read_scene("table1-smooth")
FLAT = Terms(coupled=False, oblique=False, slope_correction=False)


@dataclass(frozen=True)
class Counted(rf.Surface):
    """A bowl that counts how often it is sampled, and remarks on it each time."""

    sampled: list[int] = field(default_factory=list)
    kind: ClassVar[str] = "counted"

    def _sample(self, grid: rf.Grid, offset: tuple[float, float], periodic: bool) -> Array:
        self.sampled.append(grid.M)
        x = grid.x - 0.5 * grid.side
        return np.asarray((x[:, None] ** 2 + x[None, :] ** 2) / 0.28)

    def cautions(self, grid: rf.Grid) -> tuple[str, ...]:
        return ("counted by hand",)


def counted() -> tuple[rf.Scene, list[int]]:
    bowl = Counted()
    return replace(SCENE, upper=rf.Body(SCENE.upper.material, bowl)), bowl.sampled


def test_a_solve_on_a_grid_samples_once_and_says_once_what_surfaces_remark() -> None:
    scene, sampled = counted()
    found = rf.solve(scene, grid=32)
    assert sampled == [32]
    assert [str(line) for line in found.warnings].count("counted by hand") == 1


def test_a_climb_samples_each_grid_once_and_the_one_that_decides() -> None:
    scene, sampled = counted()
    rf.solve(scene, accuracy=0.03)
    assert sampled[0] == 256
    assert len(set(sampled)) == len(sampled)


def test_what_is_taken_is_what_would_be_posed_and_is_not_kept() -> None:
    grid = rf.Grid.square(SCENE.side, 24)
    posing, posed = Posing(SCENE, None), pose(SCENE, grid, FLAT, None)
    whole = posing.whole(grid)
    assert whole.terms == EVERYTHING
    for taken in (posing.take(grid, FLAT), posing.take(grid, FLAT)):
        assert taken.terms == FLAT
        assert np.array_equal(taken.gap, posed.gap)
        assert np.array_equal(taken.mean_surface, posed.mean_surface)
    assert posing.take(grid, FLAT).gap is not whole.gap


def test_another_grid_or_an_approach_is_posed_as_such() -> None:
    posing = Posing(SCENE, 1e-6)
    posing.whole(rf.Grid.square(SCENE.side, 24))
    taken = posing.take(rf.Grid.square(SCENE.side, 16), FLAT)
    assert taken.gap.shape == (16, 16)
    assert (taken.load, taken.approach) == (None, 1e-6)


def test_remarks_are_kept_once_each_and_not_shown(recwarn: pytest.WarningsRecorder) -> None:
    scene, _ = counted()
    twice = replace(scene, lower=rf.Body(scene.lower.material, Counted()))
    posing = Posing(twice, None)
    posing.whole(rf.Grid.square(scene.side, 8))
    assert posing.remarks == ("counted by hand",)
    assert not [warning for warning in recwarn if warning.category is SurfaceWarning]


def test_heights_of_a_scene_are_its_own() -> None:
    """Posing works in the memory of the sampled heights, never in a user's array."""
    heights = np.random.default_rng(2).uniform(0, 1e-6, (16, 16))
    kept = heights.copy()
    scene = replace(SCENE, lower=rf.Body(SCENE.lower.material, heights))
    first, second = (pose(scene, rf.Grid.square(SCENE.side, 16), FLAT, None) for _ in range(2))
    assert np.array_equal(heights, kept)
    assert np.array_equal(first.gap, second.gap)
    lower, upper = first.heights
    assert np.allclose(upper - lower, first.gap, rtol=0, atol=1e-18)
    assert np.array_equal(first.mean_surface, second.mean_surface)
