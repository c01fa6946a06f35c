"""Nested grids: levels, means of four, planes carried exactly, pressures to start from and their detail."""

from __future__ import annotations

import numpy as np
import pytest

import refimpl as rf
from refimpl.grid import Grid
from refimpl.nesting import coarsened, foundation_pressure, levels, prolonged, sharpened, touching
from refimpl.problem import Problem, Terms, pose

SIDE = 2.0**-9


def problem(M: int, *, approach: float | None = None, heights: np.ndarray | None = None) -> Problem:
    """A flat on heights, or on random ones."""
    lower = np.random.default_rng(M).normal(size=(M, M)) * 1e-6 if heights is None else heights
    steel = rf.Material(E=200e9, nu=0.3)
    scene = rf.Scene(
        upper=rf.Body(steel, rf.Flat()),
        lower=rf.Body(steel, lower),
        friction=rf.Friction(tau=0.0, beta=0.0),
        load=3.0,
        side=SIDE,
    )
    return pose(scene, Grid(SIDE, M), Terms(oblique=False, coupled=False, slope_correction=False), approach)


@pytest.mark.parametrize(
    ("M", "expected"),
    [
        (32, [32]),
        (62, [62]),
        (63, [63]),
        (64, [32, 64]),
        (65, [65]),
        (66, [33, 66]),
        (96, [48, 96]),
        (128, [32, 64, 128]),
    ],
)
def test_levels_halve_even_grids_down_to_32(M: int, expected: list[int]) -> None:
    nested = levels(problem(M))
    assert [p.grid.M for p in nested] == expected
    assert all(p.gap.shape == p.mean_surface.shape == (p.grid.M, p.grid.M) for p in nested)
    assert all(p.grid.side == SIDE for p in nested)


def test_a_coarse_height_is_the_mean_of_four() -> None:
    fine = problem(6)
    coarse = coarsened(fine)
    for i in range(3):
        for j in range(3):
            four = (slice(2 * i, 2 * i + 2), slice(2 * j, 2 * j + 2))
            assert coarse.gap[i, j] == pytest.approx(fine.gap[four].mean(), rel=1e-15)
            assert coarse.mean_surface[i, j] == pytest.approx(fine.mean_surface[four].mean(), rel=1e-14)


def test_carrying_is_exact_for_a_plane_inside_and_level_beyond_the_border() -> None:
    x, y = np.meshgrid(np.arange(4) + 0.5, np.arange(4) + 0.5, indexing="ij")  # coarse centres
    carried = prolonged(3 * x - 5 * y)
    fine = np.clip(
        (np.arange(8) + 0.5) / 2, 0.5, 3.5
    )  # fine centres, no further than the outermost coarse ones
    np.testing.assert_array_equal(carried, 3 * fine[:, None] - 5 * fine[None, :])


def test_the_starting_pressure_carries_the_load_where_surfaces_overlap() -> None:
    posed = problem(16)
    pressure = foundation_pressure(posed)
    assert pressure.sum() * posed.grid.element_area == pytest.approx(3.0, rel=1e-14)
    overlap = np.maximum(np.quantile(posed.gap, 0.3) - posed.gap, 0)
    np.testing.assert_allclose(pressure / pressure.max(), overlap / overlap.max(), rtol=1e-14)


def test_at_an_approach_it_is_a_foundation_of_the_sides_stiffness() -> None:
    posed = problem(16, approach=1e-6)
    expected = np.maximum(1e-6 - posed.gap, 0) / (posed.pair.normal_compliance * SIDE)
    np.testing.assert_allclose(foundation_pressure(posed), expected, rtol=1e-15)


def test_without_overlap_the_lowest_element_starts() -> None:
    heights = np.zeros((4, 4))
    heights[1, 2] = 1e-6
    for approach in (None, 0.0):
        pressure = foundation_pressure(problem(4, approach=approach, heights=heights))
        if approach is None:
            assert np.flatnonzero(pressure).tolist() == [6]
        else:
            expected = 1 / (problem(4).pair.normal_compliance * SIDE)
            assert pressure[1, 2] == pytest.approx(expected, rel=1e-15)
            assert np.count_nonzero(pressure) == 1


def test_touching_is_a_damped_jacobi_step() -> None:
    """Half of the misfit over ``a`` at the grid's highest frequency, 2 compliance spacing."""
    posed = problem(4)
    stiffness = 1 / (2 * posed.pair.normal_compliance * SIDE / 4)
    approach, pressure = 1e-6, np.full((4, 4), 1e6)
    limit = approach + 1e6 / (0.5 * stiffness)
    v = np.full((4, 4), limit * (1 - 1e-9))
    v[1, 2] = limit * (1 + 1e-9)
    expected = np.ones((4, 4), dtype=bool)
    expected[1, 2] = False
    np.testing.assert_array_equal(touching(pressure, v, approach, posed), expected)
    assert not touching(np.zeros((4, 4)), np.full((4, 4), approach), approach, posed).any()


@pytest.mark.parametrize("loaded", [True, False])
def test_sharpening_by_hand(loaded: bool) -> None:
    contact = np.array([[True, True], [True, False]])
    pressure, misfit = np.array([[5.0, 1.0], [3.0, 7.0]]), np.array([[4.0, -10.0], [3.0, 100.0]])
    corner = np.array([[1.0, 0.0], [0.0, 0.0]])
    found = sharpened(
        pressure=pressure,
        misfit=misfit,
        contact=contact,
        precondition=lambda r: 2 * r + r.sum() * corner,
        loaded=loaded,
    )
    mean = -1.0 if loaded else 0.0  # of 4, -10 and 3: the load is kept before elements are cut at zero
    residual = np.array([[4.0, -10.0], [3.0, 0.0]]) - mean * contact  # of which a loaded sum is zero
    step = 0.7 * (2 * residual + residual.sum() * corner)
    np.testing.assert_allclose(found, np.maximum((pressure + step) * contact, 0), rtol=1e-14)
    assert found[0, 1] == found[1, 1] == 0
