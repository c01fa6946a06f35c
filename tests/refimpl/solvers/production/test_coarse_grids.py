"""Nested grids: shapes, means of four, Winkler pressures, sharpened guesses."""

from __future__ import annotations

import numpy as np
import pytest

import refimpl as rf
from refimpl.grid import Grid, Shape
from refimpl.model.problem import Problem, Terms
from refimpl.scene.discretise import discretise
from refimpl.solvers.production.coarse_grids import coarsened, nested_problems, winkler_pressure

SIDE = 2.0**-9


def problem(
    shape: Shape, *, approach: float | None = None, heights: np.ndarray | None = None, oblique: bool = False
) -> Problem:
    """A flat on heights, or on random ones."""
    lower = np.random.default_rng(shape[0]).normal(size=shape) * 1e-6 if heights is None else heights
    steel, grid = rf.Material(E=200e9, nu=0.3), Grid(shape, (SIDE, SIDE))
    scene = rf.Scene(
        upper=rf.Body(steel, rf.Flat()),
        lower=rf.Body(steel, rf.ArraySurface(lower, pixel=grid.spacings)),
        friction=rf.Friction(tau=0.0, beta=0.0),
        load=3.0,
        side=SIDE,
    )
    terms = Terms(coupled=False, oblique=oblique, tilted=False)
    return discretise(scene, grid, terms, approach)


@pytest.mark.parametrize(
    ("shape", "expected"),
    [
        ((30, 30), [(30, 30)]),
        ((31, 31), [(16, 16), (31, 31)]),
        ((124, 124), [(62, 62), (124, 124)]),
        ((125, 125), [(32, 32), (125, 125)]),
        ((129, 129), [(33, 33), (65, 65), (129, 129)]),
        ((256, 256), [(32, 32), (128, 128), (256, 256)]),
        ((256, 128), [(64, 32), (128, 64), (256, 128)]),  # a quarter only where both axes allow it
        ((100, 128), [(50, 64), (100, 128)]),
        ((300, 31), [(150, 16), (300, 31)]),
        ((7, 1), [(7, 1)]),
    ],
)
def test_grids_halve_then_quarter_and_small_grids_halve_once(shape: Shape, expected: list[Shape]) -> None:
    """As far as the shorter axis allows."""
    nested = nested_problems(problem(shape), None)
    assert [p.grid.shape for p in nested] == expected
    assert all(p.gap.shape == p.mean_surface.shape == p.grid.shape for p in nested)
    assert all(p.grid.lengths == (SIDE, SIDE) for p in nested)


@pytest.mark.parametrize(
    ("shape", "above", "expected"),
    [
        ((128, 128), (31, 31), [(32, 32), (128, 128)]),
        ((128, 128), (32, 32), [(128, 128)]),
        ((192, 192), (64, 64), [(96, 96), (192, 192)]),
        ((64, 64), (64, 64), [(64, 64)]),
        ((32, 32), (16, 16), [(32, 32)]),
        ((256, 128), (64, 32), [(128, 64), (256, 128)]),
    ],
)
def test_grids_no_finer_than_a_known_solution_are_left_out(
    shape: Shape, above: Shape, expected: list[Shape]
) -> None:
    assert [p.grid.shape for p in nested_problems(problem(shape), above)] == expected


@pytest.mark.parametrize(("shape", "factor"), [((3, 4), 2), ((2, 2), 4)])
def test_a_coarse_height_is_the_mean_of_the_fine_ones(shape: Shape, factor: int) -> None:
    fine = problem((factor * shape[0], factor * shape[1]), oblique=True)
    coarse = coarsened(fine, shape)
    for name in ("gap", "mean_surface"):
        blocks = getattr(fine, name).reshape(shape[0], factor, shape[1], factor)
        np.testing.assert_allclose(getattr(coarse, name), blocks.mean(axis=(1, 3)), rtol=1e-13)


def test_a_winkler_pressure_carries_the_load_where_surfaces_overlap() -> None:
    given = problem((16, 16))
    pressure = winkler_pressure(given)
    assert pressure.sum() * given.grid.element_area == pytest.approx(3.0, rel=1e-14)
    overlap = np.maximum(given.gap[pressure == 0].min() - given.gap, 0)
    np.testing.assert_allclose(pressure / pressure.max(), overlap / overlap.max(), rtol=1e-14)
