"""Summits of fields, exact on parabolas and open where elements stand alone, and the bars that follow."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import refimpl as rf
from refimpl.accuracy import discretisation_error
from refimpl.accuracy.contact_edge import NO_FACES
from refimpl.accuracy.discretisation_error import APPROACH_SCATTER, PEAK_BIAS, PEAK_BIAS_SPREAD, estimates
from refimpl.accuracy.peak import NO_PEAK, Peak, deepest
from refimpl.accuracy.peak import highest as highest_on
from refimpl.grid import Array, Grid
from tests.refimpl.accuracy.made_up import PEAK, made_up, peaked

RISING = 26  # index of faces to which pressures do not fall, in the table of kinds
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


def test_non_parabolicity_is_fourth_differences_over_three_times_the_drop() -> None:
    """Of ``x^4`` they are 24, and the drop of ``x^2 + x^4 / 100`` is 2.02 along each axis."""
    x = np.arange(-4.0, 5.0)
    found = highest(500 - sum(np.meshgrid(x**2 + x**4 / 100, x**2 + x**4 / 100)))
    assert found.curvature_drop == pytest.approx(4.04)
    assert found.non_parabolicity == pytest.approx(0.48 / (3 * 4.04))


def test_an_element_that_stands_alone_is_rough_on_every_grid() -> None:
    lone = highest(np.pad([[7.0]], 4))
    assert lone == Peak(7.0, 28.0, 1.0, smooth=False)
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
        assert found.smooth is not rough


def test_at_a_border_a_field_stays_as_it_is() -> None:
    """Its highest element then has fewer that are lower, and no peak beyond is made up."""
    field = np.array([[5.0, 4.0, 3.0], [4.0, 3.0, 2.0], [3.0, 2.0, 1.0]])
    corners = [highest(corner) for corner in (field, field[::-1], field[:, ::-1], field[::-1, ::-1])]
    assert corners == [Peak(5.25, 2.0, 2 / 3, smooth=False)] * 4


def test_level_and_empty_fields_have_no_relief() -> None:
    assert highest(np.zeros((5, 5))) == NO_PEAK
    assert deepest(np.zeros((5, 5))) == NO_PEAK
    full = highest(np.full((5, 5), 3.0), periodic=True)
    assert full == Peak(3.0, 0.0, 0.0)
    assert full.error_factor == 1.0
    assert highest(np.full((5, 5), 3.0)) == replace(full, smooth=False)  # at a free border


@pytest.mark.parametrize("number", [math.nan, math.inf])
def test_a_field_that_ran_off_has_no_peak(number: float) -> None:
    assert highest(np.array([[1.0, number], [0.0, 0.0]])) == NO_PEAK


def test_a_parabola_of_waves_has_no_bias() -> None:
    free = peaked(64, 1.0, 0.1)
    waves = replace(free, grid=replace(free.grid, periodic=True))
    found, unbiased = (estimates([grid])["max_pressure"] for grid in (free, waves))
    assert found.value == pytest.approx(1 - 0.1 * PEAK_BIAS)
    assert unbiased.value == pytest.approx(1.0)
    assert found.half_width == pytest.approx(unbiased.half_width)


@pytest.mark.parametrize(
    ("non_parabolicity", "more"), [(0.0, 1.0), (0.5, (4 / 3) ** 4), (0.9, 0.19**-4), (1.0, math.inf)]
)
def test_a_peak_that_stands_alone_is_not_bounded(non_parabolicity: float, more: float) -> None:
    even, uneven = (estimates([peaked(64, 1.0, 0.1, rough)]) for rough in (0.0, non_parabolicity))
    for name in ("friction_coefficient", "contact_area", "approach"):
        assert uneven[name].half_width == even[name].half_width
    of_parabola, found = (found["max_pressure"].half_width for found in (even, uneven))
    assert of_parabola > 1.96 * math.hypot(0.1 * PEAK_BIAS_SPREAD, 0.1 * discretisation_error.PEAK_SCATTER[0])
    assert found <= more * of_parabola
    assert (found > of_parabola) is (more > 1)
    assert math.isinf(found) is math.isinf(more)


def test_a_grid_whose_peak_stands_alone_does_not_count_beside_finer_ones() -> None:
    fine = [made_up(M) for M in (128, 256)]
    coarse = replace(made_up(64), peak=Peak(PEAK / 20, PEAK / 5, 1.0))
    with_it, without = (estimates(results)["max_pressure"] for results in ([coarse, *fine], fine))
    assert with_it.value == pytest.approx(without.value, rel=1e-9)


def test_a_first_touch_that_is_not_resolved_leaves_the_approach_open() -> None:
    rim = replace(made_up(64), faces=(*NO_FACES[:RISING], sum(made_up(64).faces), *NO_FACES[RISING + 1 :]))
    steep = [replace(rim, first_contact=Peak(0.0, 1e-7, rough)) for rough in (0.0, 0.6, 1.0)]
    bounds = [estimates([result])["approach"].half_width for result in (rim, *steep)]
    assert bounds == sorted(bounds)
    edge = APPROACH_SCATTER[0] * rim.edge / rim.numbers["contact_area"] * 1e-6
    assert bounds[1] == pytest.approx(bounds[0] / edge * math.hypot(edge, APPROACH_SCATTER[5] * 0.02 * 1e-7))
    assert math.isinf(bounds[-1])


@pytest.mark.parametrize("M", [1, 2])
def test_fewer_than_three_elements_a_side_bound_neither_peak_nor_approach(M: int) -> None:
    steel = rf.Material(E=200e9, nu=0.3)
    scene = rf.Scene(
        rf.Body(steel, rf.Sphere(0.14)), rf.Body(steel, rf.Flat()), rf.Friction(), load=70.0, side=1.61e-3
    )
    found = rf.solve(scene, grid=M)
    for name in ("max_pressure", "approach"):
        assert math.isinf(sum(found.uncertainty[name].values())), name
