"""Summits of fields: exact on parabolas, on any grid, and open where elements stand alone."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from refimpl.accuracy.peak import NO_PEAK, Peak, deepest
from refimpl.accuracy.peak import highest as highest_on
from refimpl.grid import Array, Grid

inside = st.floats(-0.499, 0.499)
bends = st.floats(1e-3, 4.0)


def paraboloid(
    x0: float,
    y0: float,
    along: float,
    across: float,
    height: float = 500.0,
    shape: tuple[int, int] = (11, 11),
) -> Array:
    """Second differences ``-along`` and ``-across``, its peak that far from the middle element."""
    x, y = (np.arange(n) - n // 2 for n in shape)
    return height - 0.5 * (along * (x[:, None] - x0) ** 2 + across * (y - y0) ** 2)


def highest(field: Array, *, periodic: bool = False) -> Peak:
    """The peak of a field on elements that are not square: they are of no account."""
    return highest_on(field, Grid(field.shape, (1.0, 0.7), periodic))


@given(inside, inside, bends, bends, st.integers(3, 12), st.integers(3, 12))
def test_a_parabolas_peak_is_found_wherever_it_lies(
    x0: float, y0: float, along: float, across: float, rows: int, columns: int
) -> None:
    """Fourth differences need two elements on either side of it."""
    found = highest(paraboloid(x0, y0, along, across, shape=(rows, columns)))
    assert found.height == pytest.approx(500.0, rel=1e-12)
    assert found.curvature_drop == pytest.approx(along + across, rel=1e-9)
    assert found.non_parabolicity < 1e-9 or min(rows, columns) < 5


@given(inside, inside, st.integers(0, 3), st.booleans(), st.floats(1e-9, 1e9))
def test_turned_mirrored_and_scaled_fields_have_the_same_peak(
    x0: float, y0: float, turns: int, mirrored: bool, scale: float
) -> None:
    field = paraboloid(x0, y0, 1.0, 2.0) + 0.1 * np.random.default_rng(3).random((11, 11))
    moved = np.rot90(field.T if mirrored else field, turns)
    found, alike = highest(field), highest(scale * moved)
    assert alike.height == pytest.approx(scale * found.height, rel=1e-12)
    assert alike.curvature_drop == pytest.approx(scale * found.curvature_drop, rel=1e-9)
    assert alike.non_parabolicity == pytest.approx(found.non_parabolicity, rel=1e-9)


@pytest.mark.parametrize("shape", [(16, 16), (16, 10), (9, 24)])
@given(st.integers(0, 23), st.integers(0, 23), st.integers(0, 9))
def test_a_periodic_fields_peak_may_lie_across_its_border(
    shape: tuple[int, int], i: int, j: int, seed: int
) -> None:
    jagged = np.random.default_rng(seed).random(shape) ** 3
    hill = 0.3 * jagged
    hill[5:7, 5:8] += 1
    for field in (jagged, hill):
        moved = np.roll(field, (i, j), (0, 1))
        assert highest(moved, periodic=True) == highest(field, periodic=True)
    x, y = (2 * np.pi * np.arange(n) / n for n in shape)
    waves = 3 + np.cos(x - 0.1)[:, None] + np.cos(y + 0.05)
    assert highest(np.roll(waves, (i, j), (0, 1)), periodic=True).height == pytest.approx(5.0, abs=2e-3)


@pytest.mark.parametrize("shape", [(2, 9), (9, 2), (1, 1), (2, 2)])
@pytest.mark.parametrize("periodic", [False, True])
def test_along_fewer_than_three_elements_there_is_no_parabola(shape: tuple[int, int], periodic: bool) -> None:
    field = np.random.default_rng(1).random(shape)
    assert highest(field, periodic=periodic) == Peak(float(field.max()), 0.0, 1.0)


def test_non_parabolicity_is_fourth_differences_over_three_times_the_drop() -> None:
    """Of ``x^4`` they are 24, and the drop of ``x^2 + x^4 / 100`` is 2.02 along each axis."""
    x = np.arange(-4.0, 5.0)
    found = highest(500 - sum(np.meshgrid(x**2 + x**4 / 100, x**2 + x**4 / 100)))
    assert found.curvature_drop == pytest.approx(4.04)
    assert found.non_parabolicity == pytest.approx(0.48 / (3 * 4.04))


def test_non_parabolicity_sees_the_elements_next_but_one() -> None:
    """Also where none but the highest reaches half of it."""
    field = np.zeros((7, 7))
    field[3, 1:6] = field[1:6, 3] = 0.3, 0.45, 1.0, 0.45, 0.3
    assert highest(field).non_parabolicity == pytest.approx(6.0 / 6.6)


def test_neighbours_lower_than_those_beyond_are_as_rough_as_none() -> None:
    field = np.zeros((7, 7))
    field[3, 1:6] = field[1:6, 3] = 0.4, 0.0, 1.0, 0.0, 0.4
    assert highest(field) == Peak(1.0, 4.0, 1.0)


def test_an_element_that_stands_alone_is_rough_on_every_grid() -> None:
    lone = highest(np.pad([[7.0]], 4))
    assert lone == Peak(7.0, 28.0, 1.0)
    assert math.isinf(lone.error_factor)
    assert math.isinf(lone.widened(0.0))


def test_a_lone_element_beside_a_resolved_peak_counts_from_half_of_it_on() -> None:
    field = np.pad(np.maximum(paraboloid(0.2, 0.1, 8.0, 8.0), 0.0), ((0, 20), (0, 0)))
    alone = highest(field)
    assert alone.non_parabolicity < 1e-9
    for share, rough in ((0.49, False), (0.51, True)):
        beside = field.copy()
        beside[-5, 5] = share * field.max()
        found = highest(beside)
        assert found.height == alone.height
        assert (found.non_parabolicity == 1.0) is rough


def test_at_a_border_a_field_stays_as_it_is() -> None:
    """Its highest element then has fewer that are lower, and no peak beyond is made up."""
    field = np.array([[5.0, 4.0, 3.0], [4.0, 3.0, 2.0], [3.0, 2.0, 1.0]])
    corners = [highest(corner) for corner in (field, field[::-1], field[:, ::-1], field[::-1, ::-1])]
    assert corners == [Peak(5.25, 2.0, 2 / 3)] * 4


def test_of_elements_that_are_equally_high_all_are_looked_at() -> None:
    """The parabola through the one beside the deeper neighbour peaks higher: its field turned as well."""
    row = np.array([0.0, 0.0, 3.0, 3.0, 2.0, 0.0, 0.0])
    field = np.zeros((7, 7))
    field[3] = row
    found = highest(field)
    assert found.height == pytest.approx(3 + 9 / 24)
    assert highest(field[:, ::-1]) == highest(field.T) == highest(field.T[::-1]) == found


def test_level_and_empty_fields_have_no_relief() -> None:
    assert highest(np.zeros((5, 5))) == NO_PEAK
    assert deepest(np.zeros((5, 5))) == NO_PEAK
    full = highest(np.full((5, 5), 3.0))
    assert full == Peak(3.0, 0.0, 0.0)
    assert full.error_factor == 1.0


def test_a_gap_is_deepest_where_it_is_turned_over() -> None:
    gap = 500.0 - paraboloid(0.3, -0.4, 1.0, 2.0)
    found = deepest(gap - gap.min())
    assert found.height == pytest.approx(0.5 * (0.3**2 + 2 * 0.4**2))
    assert found.curvature_drop == pytest.approx(3.0)


@pytest.mark.parametrize("scale", [1e-300, 1e300])
def test_a_peak_of_any_size_is_found(scale: float) -> None:
    found = highest(scale * paraboloid(0.3, -0.4, 1.0, 2.0))
    assert found.height == pytest.approx(500 * scale, rel=1e-9)
    assert found.curvature_drop == pytest.approx(3 * scale, rel=1e-6)


@pytest.mark.parametrize("number", [math.nan, math.inf])
def test_a_field_that_ran_off_has_no_peak(number: float) -> None:
    assert highest(np.array([[1.0, number], [0.0, 0.0]])) == NO_PEAK
