"""The shipped table of coefficient errors against its closed first-order part and its symmetries."""

from __future__ import annotations

import math

import numpy as np
import pytest

import refimpl as rf
from refimpl.coefficient_error import coefficient_error, slope_error

STEEL, COPPER = rf.Material(E=200e9, nu=0.3), rf.Material(E=118e9, nu=0.3)
SOFT, STIFF = rf.Material(E=1e9, nu=0.1), rf.Material(E=1e15, nu=0.1)


def flat_neighbour(nu: float) -> float:
    """u(2a) - u(0) of a strip on a flat half-plane, by adding 20000 line loads (p a / E)."""
    source = (np.arange(20000) + 0.5) / 10000 - 1
    log = np.log(np.abs(2 - source)) - np.log(np.abs(source))
    return float(2 * (1 - nu**2) / math.pi * log.mean() * 2)


@pytest.mark.parametrize("nu", [0.0, 0.3, 0.45])
def test_gentle_slope_has_the_first_order_error(nu: float) -> None:
    slope = math.radians(0.5)
    expected = (1 + nu) * (1 - 2 * nu) * math.tan(slope) / flat_neighbour(nu)
    found = coefficient_error(slope, rf.Material(E=1e9, nu=nu), position=0.25)
    # the rest is second order: below 3 tan^2 by the table's largest entries
    assert found == pytest.approx(expected, abs=3 * math.tan(slope) ** 2)


def test_identical_bodies_keep_only_the_second_order() -> None:
    one, pair = (coefficient_error(math.radians(5), STEEL, upper) for upper in (None, STEEL))
    assert pair < 0.2 * one
    halved = coefficient_error(math.radians(2.5), STEEL, STEEL)
    assert pair / halved == pytest.approx(4, rel=0.05)


def test_a_rigid_partner_changes_nothing() -> None:
    for slope in np.radians([1.0, 6.5, 20.0]):
        alone = coefficient_error(slope, SOFT)
        assert coefficient_error(slope, SOFT, STIFF) == pytest.approx(alone, rel=1e-5)


def test_steel_on_copper_stays_below_two_percent_where_one_body_does_not() -> None:
    slope = math.radians(6.5)
    assert coefficient_error(slope, COPPER, STEEL) < 0.02 < coefficient_error(slope, COPPER)


def test_mirrored_positions_agree() -> None:
    for position in (0.1, 0.25, 0.4):
        first, second = (
            coefficient_error(0.1, COPPER, STEEL, position=place) for place in (position, 1 - position)
        )
        assert first == pytest.approx(second, rel=1e-12)


@pytest.mark.parametrize(("name", "value"), [("slope", 0.6), ("slope", math.nan), ("wavelength", 2.0)])
def test_outside_the_table_is_refused(name: str, value: float) -> None:
    arguments = {"slope": 0.1} | {name: value}
    with pytest.raises(rf.InputError, match=name):
        coefficient_error(lower=STEEL, **arguments)


def test_a_solution_quotes_its_slopes() -> None:
    solution = rf.solve(rf.read_scene("table1-rough"), grid=64)
    quoted = solution.slope_error
    loaded = solution.contact
    steepest = np.hypot(np.tan(solution.theta_x), np.tan(solution.theta_y))[loaded].max()
    assert quoted.max_slope == pytest.approx(math.atan(steepest), rel=1e-12)
    assert quoted.at_max == coefficient_error(quoted.max_slope, COPPER, STEEL)
    assert quoted.rms_slope <= quoted.max_slope


def test_beyond_the_table_is_not_available() -> None:
    steep, none = np.array([[1.0]]), np.zeros((1, 1))
    assert slope_error(steep, none, np.ones((1, 1)), COPPER, STEEL).at_max is None
    assert slope_error(steep, none, none, COPPER, STEEL).at_max == 0.0
