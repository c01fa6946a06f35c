"""Compliances in exact numbers, the friction law of Eqs (1) and (8), and signs of Eq. (7)."""

from __future__ import annotations

import math

import numpy as np
import pytest

import refimpl as rf
from refimpl.errors import InputError
from refimpl.grid import Array, Grid
from refimpl.model.elasticity import Elasticity
from refimpl.model.friction import (
    Friction,
    friction_coefficient_at,
    friction_per_area,
    is_frictionless,
    shear_at,
)
from refimpl.model.materials import Material, Pair
from refimpl.operators.influence import window_influence
from verification.exact.dense_influence import DenseInfluence


def test_hand_made_numbers() -> None:
    # nu = 1/4: 1 - nu^2 = 15/16; (1 + nu)(1 - 2 nu) / 2 = 5/16
    body = Material(E=1 / math.pi, nu=0.25)
    assert body.normal_compliance == pytest.approx(15 / 16, rel=1e-15)
    assert body.shear_compliance == pytest.approx(5 / 16, rel=1e-15)
    assert body.plane_strain_modulus == pytest.approx(16 / 15 / math.pi, rel=1e-15)


def test_shear_and_normal_compliance_have_their_known_ratio() -> None:
    """c / a = (1 - 2 nu) / (2 (1 - nu)): half of the ratio of wave speeds squared, Johnson (3.82)."""
    for nu in (-0.9, 0.0, 0.2, 0.49):
        body = Material(E=7e9, nu=nu)
        ratio = body.shear_compliance / body.normal_compliance
        assert ratio == pytest.approx((1 - 2 * nu) / (2 * (1 - nu)), rel=1e-14)


def test_a_pair_adds_normal_and_subtracts_shear() -> None:
    lower, upper = Material(E=2e9, nu=0.1), Material(E=5e9, nu=0.4)
    pair = Pair(lower=lower, upper=upper)
    assert pair.normal_compliance == lower.normal_compliance + upper.normal_compliance
    assert pair.shear_compliance == lower.shear_compliance - upper.shear_compliance > 0
    assert Pair(lower=upper, upper=lower).shear_compliance == -pair.shear_compliance
    assert Pair(lower=lower, upper=lower).shear_compliance == 0
    assert pair.normal_compliance * math.pi * pair.reduced_modulus == pytest.approx(1, rel=1e-15)


def test_shares_and_ratios_of_a_pair() -> None:
    """The softer body takes the larger share; shear r tilts each surface by its own ``pi c r``."""
    lower, upper = Material(E=2e9, nu=0.1), Material(E=5e9, nu=0.4)
    pair = Pair(lower=lower, upper=upper)
    a = lower.normal_compliance + upper.normal_compliance
    assert pair.upper_share == pytest.approx(upper.normal_compliance / a, rel=1e-15)
    assert pair.coupling_ratio == pytest.approx(
        (lower.shear_compliance - upper.shear_compliance) / a, rel=1e-15
    )
    assert pair.shear_ratio == pytest.approx((lower.shear_compliance + upper.shear_compliance) / a, rel=1e-15)
    tilts = math.pi * lower.shear_compliance * 1e6, math.pi * upper.shear_compliance * 1e6
    assert pair.tilts(1e6) == pytest.approx(tilts, rel=1e-15)


def test_the_softer_body_is_the_one_of_less_hardness() -> None:
    hard, soft, none = (Material(E=2e9, nu=0.25, hardness=H) for H in (90e6, 50e6, None))
    for lower, upper, expected in (
        (hard, soft, (50e6, -1.0)),
        (soft, hard, (50e6, 1.0)),
        (hard, none, (90e6, 1.0)),
        (none, none, (None, 0.0)),
    ):
        pair = Pair(lower=lower, upper=upper)
        assert (pair.softer_hardness, pair.softer_sign) == expected


LAW = Friction(tau=5.0, beta=0.5)
PRESSURE, ACTIVE = np.array([0.0, 2.0, 3.0]), np.array([False, True, False])


def test_the_traction_is_eq_8() -> None:
    np.testing.assert_array_equal(LAW.traction(PRESSURE, ACTIVE), [0.0, 6.0, 1.5])


def test_the_held_traction_is_what_is_no_multiple_of_the_pressure() -> None:
    held = LAW.held_traction(PRESSURE, ACTIVE)
    np.testing.assert_array_equal(held, [0.0, 5.0, 0.0])
    np.testing.assert_array_equal(LAW.traction(PRESSURE, ACTIVE), held + LAW.slope * PRESSURE)
    assert (LAW.jump, LAW.slope, LAW.is_linear) == (5.0, 0.5, True)


@pytest.mark.parametrize(
    ("law", "expected"), [(Friction(), True), (Friction(tau=1e-9), False), (Friction(beta=1e-9), False)]
)
def test_a_law_without_shear(law: Friction, expected: bool) -> None:
    assert is_frictionless(law) is expected


def test_of_smooth_contact_mu_follows_from_the_mean_pressure() -> None:
    """Eq. (10), ``mu = tau / f_m + beta``, and its derivative with the area, ``tau / N``."""
    law = Friction(tau=15e6, beta=0.08)
    assert shear_at(law, 1e8) == pytest.approx(23e6, rel=1e-15)
    assert friction_coefficient_at(law, 1e8) == pytest.approx(0.23, rel=1e-15)
    load, area, step = 70.0, 1e-6, 1e-9
    slope = friction_coefficient_at(law, load / (area + step)) - friction_coefficient_at(law, load / area)
    assert friction_per_area(law, load) == pytest.approx(slope / step, rel=1e-6)
    assert friction_per_area(law, 0.0) == 0


@pytest.mark.parametrize(
    ("field", "value"), [("tau", -1.0), ("tau", np.inf), ("tau", "1"), ("beta", -0.1), ("beta", np.nan)]
)
def test_parameters_out_of_range_are_refused(field: str, value: float) -> None:
    with pytest.raises(InputError, match=rf"^friction\.{field} = "):
        Friction(**{field: value})


def test_a_law_that_is_not_linear_is_friction_even_without_jump_and_slope() -> None:
    """r = f^2 / Pa, say: at no pressure it has neither."""

    class Square(Friction):
        is_linear = False

    assert is_frictionless(Friction(0.0, 0.0))
    assert not is_frictionless(Square(0.0, 0.0))


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
