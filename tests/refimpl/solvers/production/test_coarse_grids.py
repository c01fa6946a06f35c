"""Nested grids: levels, means of four, planes carried exactly, pressures to start from and their detail."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import refimpl as rf
from refimpl.grid import Array, Grid, resampled
from refimpl.grid.window import Window
from refimpl.model.problem import Problem, Terms, pose
from refimpl.operators.fft import Counter
from refimpl.operators.preconditioner import SpectralPreconditioner
from refimpl.solvers.production.coarse_grids import (
    coarsened,
    foundation_pressure,
    levels,
    sharpened,
    touching,
)
from refimpl.solvers.production.level import LevelSolver, influence
from tests.refimpl.solvers.production.levels import BALL
from tests.refimpl.solvers.production.levels import posed as level_posed

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
        (30, [30]),
        (31, [16, 31]),
        (32, [16, 32]),
        (62, [31, 62]),
        (63, [32, 63]),
        (64, [32, 64]),
        (65, [33, 65]),
        (96, [48, 96]),
        (124, [62, 124]),
        (125, [32, 125]),
        (127, [32, 127]),
        (128, [32, 128]),
        (129, [33, 65, 129]),
        (256, [32, 128, 256]),
    ],
)
def test_levels_halve_then_quarter_and_small_grids_halve_once(M: int, expected: list[int]) -> None:
    nested = levels(problem(M), 0)
    assert [p.grid.M for p in nested] == expected
    assert all(p.gap.shape == p.mean_surface.shape == (p.grid.M, p.grid.M) for p in nested)
    assert all(p.grid.side == SIDE for p in nested)


@pytest.mark.parametrize(
    ("M", "above", "expected"),
    [(128, 31, [32, 128]), (128, 32, [128]), (192, 64, [96, 192]), (64, 64, [64]), (32, 16, [32])],
)
def test_levels_no_finer_than_a_known_answer_are_passed_over(M: int, above: int, expected: list[int]) -> None:
    assert [p.grid.M for p in levels(problem(M), above)] == expected


def test_a_quartered_grid_has_means_of_sixteen() -> None:
    fine = problem(128)
    coarse = levels(fine, 0)[0]
    assert coarse.gap[3, 5] == pytest.approx(fine.gap[12:16, 20:24].mean(), rel=1e-14)


def test_a_coarse_height_is_the_mean_of_four() -> None:
    fine = problem(6)
    fine = replace(fine, terms=replace(fine.terms, oblique=True))
    coarse = coarsened(fine)
    for i in range(3):
        for j in range(3):
            four = (slice(2 * i, 2 * i + 2), slice(2 * j, 2 * j + 2))
            assert coarse.gap[i, j] == pytest.approx(fine.gap[four].mean(), rel=1e-15)
            assert coarse.mean_surface[i, j] == pytest.approx(fine.mean_surface[four].mean(), rel=1e-14)


def test_a_common_surface_that_no_slope_looks_at_is_not_carried_down() -> None:
    fine = problem(6)
    assert not fine.terms.oblique
    assert fine.mean_surface.any()
    np.testing.assert_array_equal(coarsened(fine).mean_surface, np.zeros((3, 3)))


@pytest.mark.parametrize(("n", "M"), [(4, 8), (4, 6), (4, 7), (5, 16), (2, 3), (7, 4), (9, 9)])
def test_carrying_is_exact_for_a_plane_inside_and_level_beyond_the_border(n: int, M: int) -> None:
    centres = np.arange(n) + 0.5
    carried = resampled(3 * centres[:, None] - 5 * centres[None, :], M)
    there = np.clip((np.arange(M) + 0.5) * n / M, 0.5, n - 0.5)  # no further than the outermost centres
    np.testing.assert_allclose(carried, 3 * there[:, None] - 5 * there[None, :], rtol=0, atol=1e-14 * 5 * n)
    assert carried.flags.c_contiguous


def test_the_starting_pressure_carries_the_load_where_surfaces_overlap() -> None:
    posed = problem(16)
    pressure = foundation_pressure(posed)
    assert pressure.sum() * posed.grid.element_area == pytest.approx(3.0, rel=1e-14)
    overlap = np.maximum(posed.gap[pressure == 0].min() - posed.gap, 0)
    np.testing.assert_allclose(pressure / pressure.max(), overlap / overlap.max(), rtol=1e-14)


def borne(posed: Problem, depth: float) -> float:
    """What springs bear at a depth (N), as stiff as a half-space under a load as wide as they are."""
    dA = posed.grid.element_area
    width = math.sqrt(np.count_nonzero(posed.gap <= depth) * dA)
    return float(np.maximum(depth - posed.gap, 0).sum() * dA / (posed.pair.normal_compliance * width))


@pytest.mark.parametrize("load", [0.01, 3.0, 50.0])
def test_it_is_as_deep_as_springs_must_be_to_bear_the_load(load: float) -> None:
    posed = replace(problem(32), load=load)
    depth = posed.gap[foundation_pressure(posed) == 0].min()
    assert load <= borne(posed, depth)
    assert all(borne(posed, shallower) < load for shallower in posed.gap[posed.gap < depth])


def steps_from(pressure: Array, posed: Problem) -> int:
    operator = influence(posed, Window.full(posed.grid.M), Counter())
    precondition = SpectralPreconditioner(operator, posed.pair.normal_compliance)
    solver = LevelSolver(posed, operator, precondition, pressure)
    assert solver.settle(1e-3)
    return solver.cg_iterations


@pytest.mark.parametrize("load", [0.01, 0.1, 1.0, 10.0])
def test_it_spares_steps_on_rough_surfaces(load: float) -> None:
    """Against contact on the lowest 3 elements of 10, for six surfaces together: 4 steps for 51 at the least
    load, 19 for 58, 29 for 51, and 31 for 39 where three tenths are about right (measured)."""
    springs = tenths = 0
    for seed in range(6):
        rough = rf.GaussianRoughness(rms=1e-6, correlation_length=3e-4, seed=seed)
        scene = replace(BALL, load=load, friction=rf.Friction(), lower=rf.Body(BALL.lower.material, rough))
        posed = level_posed(scene, 32)
        overlap = np.maximum(np.quantile(posed.gap, 0.3) - posed.gap, 0)
        springs += steps_from(foundation_pressure(posed), posed)
        tenths += steps_from(overlap * (load / (overlap.sum() * posed.grid.element_area)), posed)
    assert springs <= (0.9 if load == 10 else 0.65) * tenths


def test_a_load_that_no_depth_bears_presses_on_all_but_the_deepest() -> None:
    posed = replace(problem(16), load=1e6)
    np.testing.assert_array_equal(foundation_pressure(posed) > 0, posed.gap < posed.gap.max())


def test_at_an_approach_it_is_a_foundation_of_the_sides_stiffness() -> None:
    posed = problem(16, approach=1e-6)
    expected = np.maximum(1e-6 - posed.gap, 0) / (posed.pair.normal_compliance * SIDE)
    np.testing.assert_allclose(foundation_pressure(posed), expected, rtol=1e-15)


def test_a_load_that_the_lowest_elements_bear_starts_on_them() -> None:
    heights = np.zeros((4, 4))
    heights[1, 2] = heights[3, 0] = 1e-6
    pressure = foundation_pressure(problem(4, heights=heights))
    assert np.flatnonzero(pressure).tolist() == [6, 12]
    assert pressure[1, 2] == pressure[3, 0] == pytest.approx(0.5 * 3.0 / (SIDE / 4) ** 2, rel=1e-14)


def test_flats_start_with_the_mean_pressure_everywhere() -> None:
    pressure = foundation_pressure(problem(4, heights=np.zeros((4, 4))))
    np.testing.assert_allclose(pressure, 3.0 / SIDE**2, rtol=1e-14)


def test_at_an_approach_that_no_element_reaches_nothing_presses() -> None:
    """As on a coarse grid, whose means lie above first touch."""
    posed = problem(4, approach=1e-9)
    assert not foundation_pressure(replace(posed, gap=posed.gap + 2e-9)).any()


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
    found, used = touching(pressure, v, approach, posed)
    np.testing.assert_array_equal(found, expected)
    assert used == approach
    assert not touching(np.zeros((4, 4)), np.full((4, 4), approach), approach, posed)[0].any()


@pytest.mark.parametrize("shift", [-3e-6, 0.0, 2e-5])
def test_an_approach_that_is_not_known_keeps_the_load(shift: float) -> None:
    """Wherever heights are counted from: the step's pressures add up to those it started from."""
    posed = problem(16)
    stiffness = 0.5 / (2 * posed.pair.normal_compliance * SIDE / 16)
    rng = np.random.default_rng(5)
    pressure = np.maximum(rng.normal(size=(16, 16)), 0) * 1e7
    v = shift + np.where(pressure > 0, 0.0, 2e-6) + rng.normal(size=(16, 16)) * 1e-7
    contact, approach = touching(pressure, v, None, posed)
    stepped = np.maximum(pressure + stiffness * (approach - v), 0)
    np.testing.assert_array_equal(contact, stepped > 0)
    assert stepped.sum() == pytest.approx(pressure.sum(), rel=1e-12)


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


@pytest.mark.parametrize(("n", "M"), [(12, 6), (12, 5), (5, 12), (2, 1), (12, 4), (8, 3)])
def test_resampling_is_interpolation_along_either_axis(n: int, M: int) -> None:
    """Halved grids, by pairs, as all others; `np.interp` is level beyond the outermost centres too."""
    values = np.random.default_rng(8).normal(size=(n, n))
    old, new = ((np.arange(k) + 0.5) / k for k in (n, M))
    across = np.array([np.interp(new, old, row) for row in values])
    expected = np.array([np.interp(new, old, column) for column in across.T]).T
    np.testing.assert_allclose(resampled(values, M), expected, rtol=0, atol=1e-14)


@pytest.mark.parametrize("M", [1, 2, 3])
def test_of_a_single_element_there_is_its_own_value_everywhere(M: int) -> None:
    assert np.array_equal(resampled(np.array([[3.0]]), M), np.full((M, M), 3.0))
