"""Eq. (7): signs and compliances of both bodies, and one answer by matrices, products and symbols."""

from __future__ import annotations

import numpy as np
import pytest

import refimpl as rf
from refimpl.grid import Array, Grid
from refimpl.model.elasticity import Elasticity
from refimpl.model.materials import Pair
from refimpl.operators.influence import window_influence
from verification.exact.dense_influence import DenseInfluence

SOFT, HARD = rf.Material(2e9, 0.1), rf.Material(50e9, 0.4)
PAIR = Pair(lower=SOFT, upper=HARD)
GRIDS = [Grid((6, 9), (1e-3, 2e-3), periodic) for periodic in (False, True)]
ANGLE = 0.7
RANDOM = np.random.default_rng(4)
F, R = RANDOM.uniform(0, 5e6, (2, 6, 9))
SWITCHES = [(True, True), (True, False), (False, True), (False, False)]

on_grids = pytest.mark.parametrize("grid", GRIDS, ids=["free", "periodic"])


def close(found: Array, expected: Array) -> None:
    """To the rounding of sums over 54 elements."""
    np.testing.assert_allclose(found, expected, rtol=0, atol=3e-15 * np.abs(expected).max() * 54)


@on_grids
def test_pressure_goes_into_both_bodies_and_shear_pushes_one_in_where_it_lifts_the_other(grid: Grid) -> None:
    """Friction along +s pushes the lower surface in ahead, and the upper one behind."""
    A = DenseInfluence(grid, ANGLE)
    elasticity = Elasticity(PAIR)
    normal, shear = A.normal(F), A.shear(R)
    lower, upper = elasticity.body_displacements(elasticity.normal(A, F), F, shear)
    close(lower, SOFT.normal_compliance * normal + SOFT.shear_compliance * shear)
    close(upper, HARD.normal_compliance * normal - HARD.shear_compliance * shear)
    close(lower + upper, PAIR.normal_compliance * normal + PAIR.shear_compliance * shear)
    close(elasticity.gap_by_shear(shear), PAIR.shear_compliance * shear)


@pytest.mark.parametrize(("coupled", "tilted"), SWITCHES)
def test_shear_couples_by_the_difference_and_tilts_by_the_sum(coupled: bool, tilted: bool) -> None:
    """Either part of what shear does to two bodies may be neglected; both together are each body's own."""
    elasticity = Elasticity(PAIR, coupled, tilted)
    shear = DenseInfluence(GRIDS[0], ANGLE).shear(R)
    lower, upper = elasticity.body_displacements(0 * F, 0 * F, shear if elasticity.shear_displaces else None)
    c_lower, c_upper = SOFT.shear_compliance, HARD.shear_compliance
    bound = 1e-14 * np.abs(c_lower * shear).max()
    closing, tilting = lower + upper, upper - lower
    np.testing.assert_allclose(closing, coupled * (c_lower - c_upper) * shear, rtol=0, atol=bound)
    np.testing.assert_allclose(tilting, -tilted * (c_lower + c_upper) * shear, rtol=0, atol=bound)
    np.testing.assert_allclose(elasticity.gap_by_shear(shear), closing, rtol=0, atol=bound)
    assert Elasticity(PAIR) == Elasticity(PAIR, coupled=True, tilted=True)
    assert elasticity.coupling_ratio == (PAIR.shear_compliance / PAIR.normal_compliance if coupled else 0)


@on_grids
@pytest.mark.parametrize("coupled", [True, False])
def test_pressure_and_its_shear_in_one_product(grid: Grid, coupled: bool) -> None:
    elasticity, operator, slope = Elasticity(PAIR, coupled), window_influence(grid, ANGLE), 0.3
    expected = elasticity.normal(operator, F) + slope * elasticity.gap_by_shear(operator.shear(F))
    close(elasticity.normal_with_shear(operator, slope)(F), expected)


@pytest.mark.parametrize("q", [(1, 0), (0, 2), (3, -1)])
def test_the_symbol_is_the_response_to_waves(q: tuple[int, int]) -> None:
    grid = GRIDS[1]
    operator, elasticity = window_influence(grid, ANGLE), Elasticity(PAIR)
    phase = 2 * np.pi * (q[0] * grid.x[:, None] / grid.lengths[0] + q[1] * grid.y / grid.lengths[1])
    symbol = elasticity.symbol(operator.symbol)[q]
    close(elasticity.normal(operator, np.cos(phase)), symbol * np.cos(phase))


def test_single_compliances() -> None:
    """An element against its neighbours is as stiff as a wave of two elements: ``2 pi / q = 2 h``."""
    grid, elasticity = GRIDS[0], Elasticity(PAIR)
    assert elasticity.element_compliance(grid) == pytest.approx(
        2 * PAIR.normal_compliance * grid.element_size, rel=1e-6, abs=0
    )
    assert elasticity.mean_compliance(grid) == pytest.approx(
        PAIR.normal_compliance * grid.size, rel=1e-6, abs=0
    )
    square = Grid.square(1.0, 4, periodic=True)
    symbol = elasticity.symbol(window_influence(square, 0.0).symbol)
    assert elasticity.element_compliance(square) == pytest.approx(symbol[2, 0], rel=1e-14, abs=0)
