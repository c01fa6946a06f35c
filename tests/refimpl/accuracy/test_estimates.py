"""Estimates from a sequence of grids, on numbers made up to have a known limit."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import refimpl as rf
from refimpl.accuracy import discretisation_error
from refimpl.accuracy.discretisation_error import (
    SHEAR_BOUNDS,
    edge_scatter,
    estimates,
)
from refimpl.accuracy.refinement import FIRST_GRIDS, relative_bound, uncertainty
from refimpl.grid.straight_edges import StraightEdges
from refimpl.model.forces import EDGE_SHARE
from refimpl.solution.limits import Limit
from refimpl.solution.solution import REPORTED
from tests.refimpl.accuracy.made_up import AREA_LIMIT, BETA, DMU_DA, PEAK, SIDE, made_up, sloped

HERTZ_GRIDS = (80, 96, 112, 128, 160, 192, 256, 320)


def test_numbers_that_follow_the_model_are_extrapolated() -> None:
    found = estimates([made_up(M) for M in (32, 64, 128)])
    for name in ("contact_area", "contact_area_corrected"):
        assert found[name].value == pytest.approx(AREA_LIMIT, rel=1e-3)
        assert abs(found[name].value - AREA_LIMIT) < found[name].half_width
    mu = found["friction_coefficient"]
    assert mu.value == pytest.approx(BETA + DMU_DA * AREA_LIMIT, rel=1e-3)
    assert abs(mu.value - BETA - DMU_DA * AREA_LIMIT) < mu.half_width
    peak = found["max_pressure"]
    assert peak.value == pytest.approx(PEAK, rel=1e-6)
    assert abs(peak.value - PEAK) < peak.half_width < 0.02 * PEAK


def test_a_bar_reaches_from_the_number_over_the_estimate() -> None:
    results = [made_up(M) for M in (32, 64)]
    area = estimates(results)["contact_area"]
    raw = results[-1].numbers["contact_area"]
    bar = uncertainty(results)["contact_area"]["discretisation"]
    assert raw - area.value + 0.83 * area.half_width < bar < raw - area.value + 0.9 * area.half_width
    assert relative_bound(results, "contact_area") == pytest.approx(bar / raw)


def test_slopes_that_change_within_elements_leave_mu_open() -> None:
    """Once found 0.249 +- 0.009 of a measured surface, and 0.07 on grids that resolve it."""
    found = [sloped(mu, M, 0.02) for mu, M in ((0.09, 32), (0.12, 64), (0.25, 512))]
    mu = estimates(found)["friction_coefficient"]
    assert mu.error_bound(0.25) > 0.15
    alone = estimates(found[-1:])["friction_coefficient"]
    assert alone.half_width > 12.7 * 0.02  # Student's t with one degree of freedom
    settling = [sloped(0.1 + u, M, u) for u, M in ((0.08, 32), (0.02, 64), (0.0003, 512))]
    assert estimates(settling)["friction_coefficient"].error_bound(0.1003) < 2e-3


@pytest.mark.parametrize(
    ("scatter", "weights"),
    [
        ((1.0, 6.0, 3.0, 2.0), (3.0, 3.0, 1.5, 1.0)),
        ((1.0, 1.0, 1.0, 0.0), (8**1.5, 4**1.5, 2**1.5, 1.0)),
    ],
)
def test_no_grid_counts_for_more_than_a_finer_one(
    scatter: tuple[float, ...], weights: tuple[float, ...]
) -> None:
    """Without scatter on the finest grid, weights are those of an area. Q scatters by slopes alone here."""
    numbers = {**made_up(32).numbers, "friction_coefficient": 0.0}
    found = np.array([3.0, -1.0, 2.0, 5.0])
    results = [
        replace(
            made_up(M, slope_sampling_error=1e-3 * size), edge=0.0, numbers={**numbers, "binormal_force": Q}
        )
        for M, size, Q in zip((16, 32, 64, 128), scatter, found, strict=True)
    ]
    precision = np.array(weights) ** -2.0
    expected = float(found @ precision / precision.sum())
    assert estimates(results)["binormal_force"].value == pytest.approx(expected, rel=1e-9)


def test_single_elements_leave_an_area_open_down_to_nothing() -> None:
    area = 12 * (SIDE / 64) ** 2
    numbers = {**made_up(64).numbers, "contact_area": area}
    single = replace(made_up(64), edge=4 * EDGE_SHARE * area, numbers=numbers)
    assert area < estimates([single])["contact_area"].error_bound(area) < 1.3 * area
    many = replace(single, numbers={**numbers, "contact_area": 1e4 * area}, edge=4e4 * EDGE_SHARE * area)
    assert 1e4 * area < estimates([many])["contact_area"].error_bound(1e4 * area) < 1.3e4 * area
    assert estimates([many])["contact_area"].half_width == pytest.approx(0.4e4 * area, rel=0.02)


def test_the_finest_grids_slip_turns_area_into_friction() -> None:
    coarse, fine = made_up(32), made_up(128)
    mu = BETA + 3 * DMU_DA * coarse.numbers["contact_area"]
    coarse = replace(coarse, dmu_dA=3 * DMU_DA, numbers={**coarse.numbers, "friction_coefficient": mu})
    found = estimates([coarse, fine])
    assert found["friction_coefficient"].value == pytest.approx(BETA + DMU_DA * found["contact_area"].value)
    assert found["friction_coefficient"].half_width == pytest.approx(
        DMU_DA * found["contact_area"].half_width, rel=0.3
    )


def test_a_grid_without_contact_knows_nothing_beside_one_that_has() -> None:
    numbers = dict.fromkeys(REPORTED, 0.0) | {"normal_force": 70.0}
    apart, found = replace(made_up(32), numbers=numbers, edge=0.0), made_up(64)
    assert edge_scatter([apart, found]).tolist() == [1.0, (found.edge / found.numbers["contact_area"]) ** 1.5]
    assert edge_scatter([replace(found, edge=2 * found.numbers["contact_area"])]) == [1.0]
    assert edge_scatter([replace(found, edge=-0.5 * found.numbers["contact_area"])]) == [0.0]  # of holes
    assert discretisation_error.discretisation([found, apart]) == {}
    assert set(discretisation_error.discretisation([apart, found])) == set(REPORTED) - {"normal_force"}


def test_straight_edges_add_to_the_scatter_in_squares() -> None:
    """Runs of 10 and 24 faces: 0.2 * 26 elements; times the root of 2 where both come in and out as one."""
    found = made_up(64)
    area, dA = found.numbers["contact_area"], found.grid.element_area
    for multiplicity, together in ((1.0, 1.0), (4.0, 2.0)):
        strip = replace(found, straight=StraightEdges(34, 2, 676), symmetry_multiplicity=multiplicity)
        along = 5.2 * math.sqrt(together) * dA / area
        around = (found.edge / area) ** 1.5
        assert edge_scatter([strip])[0] == pytest.approx(math.hypot(around, along))
        assert along > around


@pytest.mark.parametrize("number", [1e101, -1e101, math.inf, math.nan])
def test_a_state_that_ran_off_is_not_bounded(number: float) -> None:
    """Nothing is not the same as zero: an accuracy would be met by it."""
    ran_off = replace(made_up(64), numbers={**made_up(64).numbers, "friction_force": number})
    parts = discretisation_error.discretisation([ran_off])
    assert set(parts) == set(discretisation_error.discretisation([made_up(64)]))
    assert all(part == {"discretisation": math.inf} for part in parts.values())


def test_what_an_edge_leaves_open_of_forces_goes_with_the_load() -> None:
    grids = [
        replace(
            made_up(64), numbers={**made_up(64).numbers, "normal_force": load, "binormal_force": load / 1e3}
        )
        for load in (70.0, 140.0)
    ]
    one, twice = (estimates([grid])["binormal_force"].half_width for grid in grids)
    assert twice == pytest.approx(2 * one)
    thin = (grids[0].edge / grids[0].numbers["contact_area"]) ** 1.5
    assert one == pytest.approx(
        12.706 * discretisation_error.BINORMAL.scatter * thin * 70.0, rel=1e-3
    )  # Student's t


@pytest.mark.filterwarnings("ignore::refimpl.surfaces.surface.SurfaceWarning")
@pytest.mark.nightly
def test_bars_on_heights_that_differ_from_point_to_point() -> None:
    """No grid resolves these. Of 160 solves of 32 such surfaces, 128 to 512 a side, all bars held, the peak's
    and the approach's in 90 for having no end. With grids of 32 and 64 before, which the bars take for
    surfaces that settle, A's, f_max's and the approach's hold in all, the corrected area's in 159, mu's in
    156 and Q's in 154.
    """
    noise = np.random.default_rng(0).normal(scale=60e-9, size=(128, 128))
    scene = rf.Scene(
        upper=rf.Body(rf.Material(E=200e9, nu=0.3), rf.Sphere(radius=0.01)),
        lower=rf.Body(rf.Material(E=118e9, nu=0.3), noise),
        friction=rf.Friction(tau=15e6, beta=0.08),
        load=0.05,
        side=50e-6,
    )
    fine = rf.solve(scene, 768, tolerance=1e-5)
    for M in (128, 192, 256, 512):
        found = rf.solve(scene, M, tolerance=1e-5)
        bars = {name: sum(found.uncertainty[name].values()) for name in REPORTED}
        for name, bar in bars.items():
            assert abs(getattr(found, name) - getattr(fine, name)) <= bar, (M, name)
        for name in ("friction_coefficient", "binormal_force", "contact_area"):
            assert math.isfinite(bars[name]) or found.grid.on_border(found.contact)
        wide = bars["max_pressure"] > found.max_pressure and bars["approach"] > found.approach
        assert wide, M
        assert Limit.RADIUS in {warning.limit for warning in found.warnings}


def test_bars_hold_against_hertz() -> None:
    """Of eight areas one is outside its 95 % bar, by 1 %: at 160, whose edge catches most elements."""
    scene = rf.read_scene("hertz")
    a = (3 * scene.load * 0.14 / (4 * scene.materials.reduced_modulus)) ** (1 / 3)
    area, peak = math.pi * a**2, 1.5 * scene.load / (math.pi * a**2)
    found = {M: rf.solve(scene, M).features for M in (*FIRST_GRIDS, *HERTZ_GRIDS)}
    shares = []
    for M in HERTZ_GRIDS:
        results = [found[N] for N in (*FIRST_GRIDS, M)]
        bars, numbers = uncertainty(results), results[-1].numbers
        shares.append(abs(numbers["contact_area"] - area) / sum(bars["contact_area"].values()))
        assert abs(numbers["max_pressure"] - peak) <= sum(bars["max_pressure"].values())
    assert sum(share > 1 for share in shares) <= 1
    assert max(shares) < 1.1
    assert np.median(shares) > 0.5  # no longer than need be


SOFT, HARD = rf.Material(E=1e9, nu=0.1), rf.Material(E=1e12, nu=0.3)
RADIUS, CONTACT = 1e-2, 2e-4
MODULUS = 1 / ((1 - SOFT.nu**2) / SOFT.E + (1 - HARD.nu**2) / HARD.E)
LOAD = 4 * MODULUS * CONTACT**3 / (3 * RADIUS)


def ball(lower: rf.Material, tau: float = 2e6, periodic: bool = False) -> rf.Scene:
    """A hard ball on something, under the load of a Hertz contact on the soft one."""
    return rf.Scene(
        upper=rf.Body(HARD, rf.Sphere(RADIUS)),
        lower=rf.Body(lower, rf.Flat()),
        friction=rf.Friction(tau=tau, beta=0.1),
        load=LOAD,
        side=SIDE,
        periodic=periodic,
    )


@pytest.mark.parametrize("periodic", [False, True])
def test_contact_is_pressed_in_by_four_fifths_of_a_hertz_approach(periodic: bool) -> None:
    """Less, where contact repeats, what a square lattice of point forces and its mean do at one of them."""
    lattice = 3.9003 * LOAD / (math.pi * MODULUS * SIDE) if periodic else 0.0
    found = rf.solve(ball(SOFT, 0.0, periodic), grid=64, coupled=False)
    assert found.features.depth == pytest.approx(0.8 * CONTACT**2 / RADIUS - lattice, rel=0.03)


def test_shear_to_normal_is_the_ratio_of_cerrutis_displacement_to_loves() -> None:
    found = rf.solve(ball(SOFT), grid=48)
    pair = found.problem.pair
    ratio = abs(pair.shear_compliance) / pair.normal_compliance
    assert found.features.shear_to_normal_ratio == pytest.approx(
        ratio * 2e6 * found.contact_area / LOAD, rel=1e-12
    )
    assert found.features.shear_to_normal_ratio > 0.1


@pytest.mark.parametrize(
    ("lower", "tau", "coupled"), [(HARD, 2e6, None), (SOFT, 0.0, None), (SOFT, 2e6, False)]
)
def test_twins_no_tau_and_no_coupling_displace_nothing(
    lower: rf.Material, tau: float, coupled: bool | None
) -> None:
    found = rf.solve(ball(lower, tau), grid=32, coupled=coupled)
    assert found.features.shear_to_normal_ratio == 0.0


def test_a_state_without_contact_has_no_depth() -> None:
    apart = rf.solve(ball(SOFT), grid=16, approach=-1e-6)
    assert apart.features.depth == apart.features.shear_to_normal_ratio == 0.0


def test_tau_on_the_edge_widens_the_approach_under_a_load_alone() -> None:
    grids = [replace(made_up(M), depth=2e-6) for M in (32, 64)]
    pulled = [replace(grid, shear_to_normal_ratio=0.3) for grid in grids]
    share = 0.3 * grids[-1].edge / grids[-1].numbers["contact_area"]
    before, after = estimates(grids), estimates(pulled)
    bound = SHEAR_BOUNDS["approach"] * share * 2e-6
    assert after["approach"].half_width == pytest.approx(
        math.hypot(before["approach"].half_width, bound), rel=1e-12
    )
    assert {name for name in after if after[name] != before[name]} == {"approach"}


def test_at_an_approach_it_widens_the_force_and_the_peak() -> None:
    grids = [replace(made_up(M), loaded=False) for M in (32, 64)]
    pulled = [replace(grid, shear_to_normal_ratio=0.3, depth=2e-6) for grid in grids]
    share = 0.3 * grids[-1].edge / grids[-1].numbers["contact_area"]
    before, after = estimates(grids), estimates(pulled)
    for name in ("normal_force", "max_pressure"):
        bound = SHEAR_BOUNDS[name] * share * grids[-1].numbers[name]
        assert after[name].half_width == pytest.approx(math.hypot(before[name].half_width, bound), rel=1e-12)
    assert {name for name in after if after[name] != before[name]} == {"normal_force", "max_pressure"}
