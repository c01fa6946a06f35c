"""Persson's and Greenwood-Williamson's estimates: closed forms, limits, and a solved contact between them."""

from __future__ import annotations

import math

import numpy as np
import pytest

import refimpl as rf
from refimpl.grid import Grid
from refimpl.solution.rough_contact import (
    Roughness,
    estimates_of,
    greenwood_williamson_share,
    persson_share,
    summits,
)
from verification.exact import rough_plane

SURFACE = rf.SelfAffineRoughness(
    hurst=0.8, rms_gradient=0.05, roll_off=2e-4, long_cut=5e-4, short_cut=4e-5, seed=1
)
GRID = Grid((128, 128), (1e-3, 1e-3), periodic=True)
FOUND = Roughness.of(SURFACE.sample(GRID), GRID.spacings)


def test_mean_squares_of_a_wave() -> None:
    k = 2 * math.pi / 1e-3
    wave = 1e-6 * np.cos(k * GRID.x)[:, None] * np.cos(k * GRID.y)
    found = Roughness.of(wave, GRID.spacings)
    assert found.m0 == pytest.approx(1e-12 / 4, rel=1e-9)
    assert found.m2 == pytest.approx(1e-12 * k**2 / 4, rel=0.01)
    assert found.m4 == pytest.approx(1e-12 * k**4 / 4, rel=0.02)  # 126 of 128 lines, without the crests


@pytest.mark.parametrize("power", [1.0, 1.5])
def test_summits_at_the_mean_plane_are_half_a_moment_of_the_normal(power: float) -> None:
    half = 2 ** (power / 2) * math.gamma((power + 1) / 2) / math.sqrt(math.pi) / 2
    assert summits(power, 0.0) == pytest.approx(half, rel=1e-9)


def test_persson_is_the_case_s() -> None:
    for p in (1e4, 1e6, 5e7):
        expected = float(rough_plane.persson_area(p / (1e9 * FOUND.rms_gradient)))
        assert persson_share(p, FOUND, 1e9) == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("p", [1e4, 1e6, 5e6])
def test_greenwood_williamson_is_the_case_s(p: float) -> None:
    """Another integral and another root finder; summits by McCool's formulas, written out here."""
    m0, m2, m4 = FOUND.m0, FOUND.m2, FOUND.m4
    rms = math.sqrt(m0 - 0.8968 * m2**2 / m4)
    density, radius = m4 / m2 / (6 * math.pi * math.sqrt(3)), 3 / 8 * math.sqrt(math.pi / m4)
    expected = float(rough_plane.greenwood_williamson_area(p / 1e9, rms, density, radius))
    assert greenwood_williamson_share(p, FOUND, 1e9) == pytest.approx(expected, rel=1e-6)


def test_greenwood_williamson_grows_with_the_load_to_all_of_it() -> None:
    shares = [greenwood_williamson_share(p, FOUND, 1e9) for p in (1e3, 1e5, 1e7, 1e9)]
    assert shares == sorted(shares)
    assert shares[-1] == 1.0


def test_a_solved_contact_lies_near_both() -> None:
    elastic = rf.Material(E=2e9, nu=0.0)  # two of these have E* = 1 GPa
    load = 0.05 * 1e9 * FOUND.rms_gradient * 1e-6
    bodies = rf.Body(elastic, rf.Flat()), rf.Body(elastic, SURFACE)
    scene = rf.Scene(*bodies, rf.Friction(), load, 1e-3, periodic=True)
    solved = rf.solve(scene, 128, oblique=False)
    persson, summit = estimates_of(scene, solved.grid)
    assert 0.6 * solved.contact_area < persson.area < solved.contact_area_corrected * 1.1
    assert 0.6 * solved.contact_area < summit.area < 1.5 * solved.contact_area
    assert persson.mean_pressure == pytest.approx(load / persson.area)
    coarse = estimates_of(scene, scene.grid(48))  # formulas are not sampled more coarsely for a coarser grid
    assert [one.area for one in coarse] == pytest.approx([persson.area, summit.area], rel=5e-3)
    assert estimates_of(rf.read_scene("hertz"), GRID) == ()
    ball = rf.Scene(rf.Body(elastic, rf.Sphere(0.1)), bodies[1], rf.Friction(), load, 1e-3)
    assert estimates_of(ball, ball.grid(64)) == ()  # not nominally flat
