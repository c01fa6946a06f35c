"""Bars of the highest pressure and of the approach, on peaks that are made up."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

import refimpl as rf
from refimpl.accuracy import discretisation_error
from refimpl.accuracy.discretisation_error import OTHER, PEAK_BIAS, PEAK_BIAS_SPREAD, estimates
from refimpl.accuracy.peak import Peak
from tests.refimpl.accuracy.made_up import PEAK, made_up, peaked


def test_a_peak_that_grows_with_the_grid_is_not_known() -> None:
    """As long as its neighbours fall as far behind."""
    sharp = [peaked(M, height, height) for M, height in ((32, 1.0), (64, 2.4), (128, 2.9))]
    assert estimates(sharp)["max_pressure"].error_bound(2.9) > 1.5


def test_a_parabola_of_waves_has_no_bias() -> None:
    free = peaked(64, 1.0, 0.1)
    waves = replace(free, grid=replace(free.grid, periodic=True))
    found, unbiased = (estimates([grid])["max_pressure"] for grid in (free, waves))
    assert found.value == pytest.approx(1 - 0.1 * PEAK_BIAS)
    assert unbiased.value == pytest.approx(1.0)
    assert found.half_width == pytest.approx(unbiased.half_width)


def test_a_parabola_of_unforeseen_bias_is_learnt_from_the_grids() -> None:
    size = PEAK_BIAS + 3 * PEAK_BIAS_SPREAD
    grids = [peaked(M, 1 + size * (16 / M) ** 2, (16 / M) ** 2) for M in (32, 64, 128, 256)]
    assumed = grids[-1].peak.height - PEAK_BIAS * grids[-1].peak.curvature_drop
    assert abs(estimates(grids)["max_pressure"].value - 1) < abs(assumed - 1)


@pytest.mark.parametrize(
    ("non_parabolicity", "more"), [(0.0, 1.0), (0.5, (4 / 3) ** 4), (0.9, 0.19**-4), (1.0, math.inf)]
)
def test_a_peak_that_stands_alone_is_not_bounded(non_parabolicity: float, more: float) -> None:
    even, uneven = (estimates([peaked(64, 1.0, 0.1, rough)]) for rough in (0.0, non_parabolicity))
    for name in ("friction_coefficient", "contact_area"):
        assert uneven[name].half_width == even[name].half_width
    assert uneven["approach"].half_width == pytest.approx(math.sqrt(more) * even["approach"].half_width)
    of_parabola, found = (found["max_pressure"].half_width for found in (even, uneven))
    assert of_parabola > 1.96 * math.hypot(0.1 * PEAK_BIAS_SPREAD, 0.1 * discretisation_error.PEAK.scatter)
    assert found <= more * of_parabola
    assert (found > of_parabola) is (more > 1)
    assert math.isinf(found) is math.isinf(more)


def test_a_grid_whose_peak_stands_alone_does_not_count_beside_finer_ones() -> None:
    fine = [made_up(M) for M in (128, 256)]
    coarse = replace(made_up(64), peak=Peak(PEAK / 20, PEAK / 5, 1.0))
    with_it, without = (estimates(results)["max_pressure"] for results in ([coarse, *fine], fine))
    assert with_it.value == pytest.approx(without.value, rel=1e-9)


@pytest.mark.parametrize("M", [1, 2])
def test_fewer_than_three_elements_a_side_bound_neither_peak_nor_approach(M: int) -> None:
    steel = rf.Material(E=200e9, nu=0.3)
    scene = rf.Scene(
        rf.Body(steel, rf.Sphere(0.14)), rf.Body(steel, rf.Flat()), rf.Friction(), load=70.0, side=1.61e-3
    )
    found = rf.solve(scene, grid=M)
    for name in ("max_pressure", "approach"):
        assert math.isinf(sum(found.uncertainty[name].values())), name


def test_a_first_touch_that_is_not_resolved_leaves_the_approach_open() -> None:
    steep = [replace(made_up(64), first_contact=Peak(0.0, 1e-7, rough)) for rough in (0.0, 0.6, 1.0)]
    bounds = [estimates([result])["approach"].half_width for result in (made_up(64), *steep)]
    assert bounds == sorted(bounds)
    edge = OTHER.scatter * (made_up(64).edge / made_up(64).numbers["contact_area"]) ** 1.5 * 1e-6
    assert bounds[1] == pytest.approx(bounds[0] / edge * math.hypot(edge, 0.02 * 1e-7))
    assert math.isinf(bounds[-1])
