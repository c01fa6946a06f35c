"""What tau displaces where bodies differ: on whole elements it acts on more than the contact."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

import refimpl as rf
from refimpl.accuracy.discretisation_error import SHEAR_BOUNDS, estimates
from tests.refimpl.accuracy.made_up import made_up

SOFT, HARD = rf.Material(E=1e9, nu=0.1), rf.Material(E=1e12, nu=0.3)
RADIUS, CONTACT, SIDE = 1e-2, 2e-4, 1e-3
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
