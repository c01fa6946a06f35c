"""No closed bar where a number has no limit: borders, sharp edges, contacts of two elements, unseen yield."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
import pytest

import refimpl as rf
from refimpl.grid import Array

SIDE = 1e-3  # m


def pressed(load: float, surface: rf.Surface, lower: rf.Material, **scene: bool) -> rf.Scene:
    """A rigid rough body on an elastic flat."""
    rigid = rf.Body(rf.Material(E=math.inf, nu=0.3), surface)
    return rf.Scene(rigid, rf.Body(lower, rf.Flat()), rf.Friction(0.0, 0.1), load=load, side=SIDE, **scene)


RUBBER = rf.Material(E=10e6, nu=0.3)
FULL = pressed(0.1, rf.GaussianRoughness(10e-9, 0.2e-3, seed=1), RUBBER)


def test_full_contact_of_a_free_domain_has_the_order_of_a_punch() -> None:
    """The approach falls by h to 7.9325e-6 (from 128 and 256 elements, order 1 seen from 32 on)."""
    solved = {M: rf.solve(FULL, M) for M in (32, 64, 128)}
    limit = 2 * solved[128].approach - solved[64].approach
    for s in solved.values():
        assert abs(s.approach - limit) <= s.error("approach") < 3 * abs(s.approach - limit)
        assert math.isinf(s.error("max_pressure"))


PHASES = (4 * (np.arange(96) + 0.5) / 96) % 1  # places within four equal grooves


@pytest.mark.parametrize(
    ("profile", "load"),
    [
        (np.clip(np.abs(PHASES - 0.5) - 0.25, -0.1, 0.1), 2.0),  # trapezoids, whose flats end as punches do
        (np.abs(PHASES - 0.5), 20.0),  # roofs, whose crest lies between two elements
    ],
)
def test_a_peak_at_a_sharp_edge_or_crest_is_open(profile: Array, load: float) -> None:
    grooves = rf.ArraySurface(1e-5 * profile[:, None] * np.ones(96))
    s = rf.solve(pressed(load, grooves, rf.Material(E=1e9, nu=0.3), periodic=True), 96)
    assert 0 < s.contact_area_share < 1
    assert s.contact.sum() > 96 * 4 * 4  # four elements wide at least
    assert math.isinf(s.error("max_pressure"))
    assert math.isfinite(s.error("contact_area"))


@dataclass(frozen=True)
class Grooves(rf.Surface):
    """Four waves along x."""

    kind: ClassVar[str] = "grooves"
    phase: float = 0.0

    def heights_on(self, grid: rf.Grid, offset: tuple[float, float]) -> Array:
        return 1e-6 * np.cos(8 * np.pi * grid.x / SIDE + self.phase)[:, None] * np.ones(grid.shape[1])


POLYMER, FINE_WAVES = rf.Material(E=1e9, nu=0.3), rf.GaussianRoughness(10e-9, 0.2e-3, seed=4)


@pytest.mark.parametrize(
    ("surface", "lower", "load", "grid", "full"),
    [
        (FINE_WAVES, RUBBER, 2e-3, 32, False),  # the edge over the contact's area gave a 17th of the error
        (Grooves(), POLYMER, 9.0, 32, False),  # straight edges along the grid: a quarter
        (Grooves(), POLYMER, 13.0, 32, True),  # a gap that opens between the points of this grid: a 280th
    ],
)
def test_gaps_of_few_elements_leave_the_approach_open(
    surface: rf.Surface, lower: rf.Material, load: float, grid: int, full: bool
) -> None:
    scene = pressed(load, surface, lower, periodic=True)
    coarse, fine = rf.solve(scene, grid), rf.solve(scene, 8 * grid)
    assert 0.6 < fine.contact_area_share < 1
    assert (coarse.contact_area_share == 1) is full
    off = abs(coarse.approach - fine.approach)
    assert off < coarse.error("approach") < 30 * off


@dataclass(frozen=True)
class Roof(rf.Surface):
    """A ridge along y at the middle, where it lies between the elements of even grids."""

    kind: ClassVar[str] = "roof"

    def heights_on(self, grid: rf.Grid, offset: tuple[float, float]) -> Array:
        return -3e-3 * np.abs(grid.x - SIDE / 2)[:, None] * np.ones(grid.shape[1])


def test_first_contact_on_a_sharp_crest_lies_above_the_parabola() -> None:
    """The bar of a smooth peak was 1.7 times too short."""
    rigid = rf.Body(rf.Material(E=math.inf, nu=0.3), rf.Sphere(0.05))
    scene = rf.Scene(rigid, rf.Body(POLYMER, Roof()), rf.Friction(0.0, 0.1), load=2.0, side=SIDE)
    coarse, fine = rf.solve(scene, 48), rf.solve(scene, 192)
    off = abs(coarse.approach - fine.approach)
    assert off < coarse.error("approach") < 5 * off


def steel_ball(load: float, friction: rf.Friction = rf.Friction()) -> rf.Scene:  # noqa: B008  # immutable
    """A ball on a flat, both of steel."""
    steel = rf.Material(E=200e9, nu=0.3)
    return rf.Scene(rf.Body(steel, rf.Sphere(0.02)), rf.Body(steel, rf.Flat()), friction, load, side=SIDE)


@pytest.mark.parametrize("load", [0.01, 1e-6])
@pytest.mark.parametrize("grid", [16, 17])
def test_a_contact_below_two_elements_bounds_no_pressure(load: float, grid: int) -> None:
    assert math.isinf(rf.solve(steel_ball(load), grid).error("max_pressure"))


def test_a_plastic_area_that_no_element_shows_is_bounded_by_the_pressures_bar() -> None:
    ball = steel_ball(20.0)
    elastic = rf.solve(ball, 24)
    top, bar = elastic.max_pressure, elastic.error("max_pressure")
    near, far = (
        rf.solve(replace(ball, lower=rf.Body(replace(ball.lower.material, hardness=H), rf.Flat())), 24)
        for H in (top + 0.5 * bar, top + 1.5 * bar)
    )
    assert near.plastic_area == far.plastic_area == 0
    assert near.error("plastic_area") >= near.grid.element_area
    assert far.error("plastic_area") < near.grid.element_area
    without_cap = rf.solve(near.details.evidence.scene, 24, plastic=False)
    assert without_cap.error("plastic_area") >= near.error("plastic_area")


def test_a_refinement_returns_its_best_finished_grid(monkeypatch: pytest.MonkeyPatch) -> None:
    from refimpl.driver import refined

    finest: list[int] = []
    solve_on_grid = refined.solve_on_grid

    def fails_beyond_64(plan, *rest, **named):  # type: ignore[no-untyped-def] # as the function itself
        solved = solve_on_grid(plan, *rest, **named)
        finest.append(plan.grid.shape[0])
        if plan.grid.shape[0] <= 64:
            return solved
        return replace(solved, state=replace(solved.state, status=rf.Status.STAGNATED))

    monkeypatch.setattr(refined, "solve_on_grid", fails_beyond_64)
    s = rf.solve(steel_ball(20.0, rf.Friction(1e7, 0.1)), accuracy=1e-4)
    assert s.grid.shape == (64, 64)
    assert max(finest) > 64
    assert s.status is rf.Status.ACCURACY_NOT_REACHED
    assert any("stagnated" in str(text) for text in s.warnings)
