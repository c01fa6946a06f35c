"""Compliances in exact numbers, the friction law of Eqs (1) and (8), and shear on two bodies."""

from __future__ import annotations

import math

import numpy as np
import pytest

import refimpl as rf
from refimpl.grid import Grid
from refimpl.model.elasticity import Elasticity
from refimpl.model.friction import Friction, is_frictionless
from refimpl.model.materials import Material, Pair
from verification.exact.dense_influence import DenseInfluence


def test_hand_made_numbers() -> None:
    # nu = 1/4: 1 - nu^2 = 15/16; (1 + nu)(1 - 2 nu) / 2 = 5/16
    body = Material(E=1 / math.pi, nu=0.25)
    assert body.normal_compliance == pytest.approx(15 / 16, rel=1e-15)
    assert body.shear_compliance == pytest.approx(5 / 16, rel=1e-15)
    assert body.plane_strain_modulus == pytest.approx(16 / 15 / math.pi, rel=1e-15)


LAW = Friction(tau=5.0, beta=0.5)
PRESSURE, ACTIVE = np.array([0.0, 2.0, 3.0]), np.array([False, True, False])


def test_the_traction_is_eq_8() -> None:
    np.testing.assert_array_equal(LAW.traction(PRESSURE, ACTIVE), [0.0, 6.0, 1.5])


def test_the_shear_offset_is_what_is_no_multiple_of_the_pressure() -> None:
    held = LAW.shear_offset(PRESSURE, ACTIVE)
    np.testing.assert_array_equal(held, [0.0, 5.0, 0.0])
    np.testing.assert_array_equal(LAW.traction(PRESSURE, ACTIVE), held + LAW.slope * PRESSURE)
    assert (LAW.jump, LAW.slope, LAW.is_linear) == (5.0, 0.5, True)


@pytest.mark.parametrize(
    ("law", "expected"), [(Friction(), True), (Friction(tau=1e-9), False), (Friction(beta=1e-9), False)]
)
def test_a_law_without_shear(law: Friction, expected: bool) -> None:
    assert is_frictionless(law) is expected


SOFT, HARD = rf.Material(2e9, 0.1), rf.Material(50e9, 0.4)
PAIR = Pair(lower=SOFT, upper=HARD)
GRID = Grid((6, 9), (1e-3, 2e-3))
ANGLE = 0.7
RANDOM = np.random.default_rng(4)
F, R = RANDOM.uniform(0, 5e6, (2, 6, 9))
SWITCHES = [(True, True), (True, False), (False, True), (False, False)]


@pytest.mark.parametrize(("coupled", "tilted"), SWITCHES)
def test_shear_couples_by_the_difference_and_tilts_by_the_sum(coupled: bool, tilted: bool) -> None:
    """Either part of what shear does to two bodies may be neglected; both together are each body's own."""
    elasticity = Elasticity(PAIR, coupled, tilted)
    shear = DenseInfluence(GRID, ANGLE).shear(R)
    lower, upper = elasticity.body_displacements(0 * F, 0 * F, shear if elasticity.shear_displaces else None)
    c_lower, c_upper = SOFT.shear_compliance, HARD.shear_compliance
    bound = 1e-14 * np.abs(c_lower * shear).max()
    closing, tilting = lower + upper, upper - lower
    np.testing.assert_allclose(closing, coupled * (c_lower - c_upper) * shear, rtol=0, atol=bound)
    np.testing.assert_allclose(tilting, -tilted * (c_lower + c_upper) * shear, rtol=0, atol=bound)
    np.testing.assert_allclose(elasticity.gap_by_shear(shear), closing, rtol=0, atol=bound)
    assert Elasticity(PAIR) == Elasticity(PAIR, coupled=True, tilted=True)
    assert elasticity.coupling_ratio == (PAIR.shear_compliance / PAIR.normal_compliance if coupled else 0)
