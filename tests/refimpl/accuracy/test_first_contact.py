"""Numbers at a prescribed approach, beside Hertz' for the surfaces' own first touch."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

import refimpl as rf
from refimpl.accuracy.discretisation_error import estimates
from refimpl.accuracy.first_contact import (
    at_first_contact,
    first_contact_bounds,
    first_contact_error,
)
from refimpl.accuracy.grid_features import GridFeatures
from refimpl.accuracy.peak import Peak
from refimpl.solution.solution import REPORTED

STEEL, RADIUS, SIDE, APPROACH = rf.Material(E=200e9, nu=0.3), 0.01, 1e-3, 3e-6
FRICTION = rf.Friction(tau=200e6, beta=0.1)
MODULUS = STEEL.E / (2 * (1 - STEEL.nu**2))
AREA = math.pi * RADIUS * APPROACH
FORCE = 4 / 3 * MODULUS * math.sqrt(RADIUS) * APPROACH**1.5
HERTZ = {
    "normal_force": FORCE,
    "contact_area": AREA,
    "max_pressure": 1.5 * FORCE / AREA,
    "friction_force": FRICTION.tau * AREA + FRICTION.beta * FORCE,
    "friction_coefficient": FRICTION.tau * AREA / FORCE + FRICTION.beta,
}
PLACES = [(direction, share) for direction in (0.1, 1.2) for share in (0.1, 0.25, 0.4, 0.5)]


@cache
def pressed(
    M: int, direction: float = 0.0, share: float = 0.0, approach: float | None = APPROACH
) -> GridFeatures:
    """A ball below a flat of the same steel, beside the grid's middle by a share of an element of 32 x 32."""
    scene = rf.Scene(
        upper=rf.Body(STEEL, rf.Flat()),
        lower=rf.Body(STEEL, rf.Sphere(radius=-RADIUS)),
        friction=FRICTION,
        load=FORCE,
        side=SIDE,
        sliding_direction=direction,
        sliding_offset=share * SIDE / 32,
    )
    return rf.solve(scene, M, approach=approach, oblique=False, tolerance=1e-8).features


def test_bars_at_a_prescribed_approach_hold_against_hertz() -> None:
    """Of single grids and of ladders."""
    shares: dict[str, list[float]] = {name: [] for name in HERTZ}
    for place in PLACES:
        for grids in ((32,), (64,), (32, 64, 128)):
            results = [pressed(M, *place) for M in grids]
            for name, estimate in estimates(results).items():
                if name in HERTZ:
                    found = results[-1].numbers[name]
                    shares[name].append(abs(found - HERTZ[name]) / estimate.error_bound(found))
    for name, found in shares.items():
        assert np.mean(np.array(found) <= 1) >= 0.92, name
        assert np.median(found) > 0.2, name  # no longer than need be


def test_what_the_touch_takes_is_foretold_by_powers_of_the_approach() -> None:
    """Half an element beside along both axes, the highest elements lie h^2/4R below the summit."""
    raw = pressed(64, 0.0, 0.0)
    assert raw.first_contact.height == pytest.approx((SIDE / 64) ** 2 / (4 * RADIUS), rel=1e-6)
    found = at_first_contact(raw)
    for name in ("normal_force", "friction_force"):
        before, after = (abs(result.numbers[name] / HERTZ[name] - 1) for result in (raw, found))
        assert after < before
    assert found.numbers["normal_force"] == pytest.approx(FORCE, rel=1e-3)
    assert raw.numbers["normal_force"] > FORCE * 1.003
    assert found.dmu_dA * found.numbers["normal_force"] == pytest.approx(FRICTION.tau)
    rest = found.numbers["friction_coefficient"] - found.dmu_dA * found.numbers["contact_area"]
    assert rest == pytest.approx(FRICTION.beta, rel=1e-6)


def test_under_a_load_only_the_approach_hangs_on_the_touch() -> None:
    loaded = pressed(64, 0.0, 0.0, None)
    assert at_first_contact(loaded) is loaded
    deeper = replace(
        loaded, first_contact=replace(loaded.first_contact, height=2 * loaded.first_contact.height)
    )
    one, other = (estimates([result]) for result in (loaded, deeper))
    assert other["approach"].value - one["approach"].value == pytest.approx(loaded.first_contact.height)
    assert all(one[name] == other[name] for name in one if name != "approach")
    assert abs(one["approach"].value - APPROACH) < abs(loaded.numbers["approach"] - APPROACH)


def test_a_touch_that_nothing_is_known_of_leaves_everything_open() -> None:
    lone = replace(pressed(64), first_contact=Peak(0.0, 1e-9, 1.0))
    assert math.isinf(first_contact_error(lone))
    assert all(math.isinf(bound) for bound in first_contact_bounds(lone).values())
    assert all(math.isinf(estimate.half_width) for estimate in estimates([lone]).values())


def test_shear_that_bears_the_whole_force_leaves_everything_open() -> None:
    """On slopes the normal force may vanish, or pull."""
    for force in (0.0, -1.0):
        pulled = replace(pressed(64), numbers={**pressed(64).numbers, "normal_force": force}, dmu_dA=0.0)
        assert at_first_contact(pulled) is pulled
        assert all(math.isinf(bound) for bound in first_contact_bounds(pulled).values())


@pytest.mark.parametrize("unit", [1e-9, 1.0])
def test_powers_of_the_approach_in_any_unit_of_force(unit: float) -> None:
    """Down to a share ``s`` of the approach, and what two standard deviations of the touch take of that."""
    numbers = dict.fromkeys(REPORTED, unit) | {
        "approach": 1e-6,
        "contact_area": 3.0,
        "friction_force": 0.5 * unit,
    }
    found = replace(
        pressed(64),
        numbers=numbers,
        dmu_dA=0.1,
        peak=Peak(2 * unit, 1.0, 0.0),
        first_contact=Peak(1e-6 / 3, 5e-6, 0.0),
    )
    s = 0.75
    force, area = unit * s**1.5, 3.0 * s
    friction = 0.1 * unit * area + (0.5 - 0.3) * unit * s**1.5
    got = at_first_contact(found)
    assert got.numbers == pytest.approx(
        {
            "approach": 1e-6,
            "normal_force": force,
            "binormal_force": force,
            "contact_area": area,
            "contact_area_corrected": unit * s,
            "plastic_area": unit * s,
            "max_pressure": unit * s**0.5,
            "friction_force": friction,
            "friction_coefficient": friction / force,
        }
    )
    assert got.peak.height == pytest.approx(2 * unit * s**0.5)
    assert got.dmu_dA == pytest.approx(0.1 * unit / force)
    less = 1 / 1.2  # 2 x 0.02 x 5e-6 of 1e-6
    assert first_contact_bounds(found)["contact_area"] == pytest.approx(3.0 * (1 - less))
    assert first_contact_bounds(found)["normal_force"] == pytest.approx(unit * (1 - less**1.5))


def test_approaches_far_below_what_the_grid_knows_of_first_touch_have_bars_without_end() -> None:
    """Their share of it is so small that a force would be none."""
    scene = rf.Scene(
        upper=rf.Body(STEEL, rf.Sphere(0.14)),
        lower=rf.Body(rf.Material(E=2.5e9, nu=0.38), rf.Flat()),
        friction=FRICTION,
        load=70.0,
        side=1.61e-3,
    )
    solution = rf.solve(scene, 5, approach=1e-160)
    bar = solution.uncertainty["normal_force"]["discretisation"]
    assert bar == math.inf
