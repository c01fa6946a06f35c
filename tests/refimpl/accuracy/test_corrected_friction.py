"""Friction without tau on the mean excess of the contact edge: against Hertz, and its own error bar."""

from __future__ import annotations

import math

import numpy as np
import pytest

import refimpl as rf

STEEL = rf.Material(E=200e9, nu=0.3)
MODULUS = STEEL.E / (2 * (1 - STEEL.nu**2))
RADIUS, LOAD, SIDE = 0.01, 40.0, 1e-3  # m, N, m
TAU, BETA = 2e8, 0.1
HERTZ_AREA = math.pi * (3 * LOAD * RADIUS / (4 * MODULUS)) ** (2 / 3)


def ball(side: float = SIDE, law: rf.Friction | None = None) -> rf.Scene:
    return rf.Scene(
        upper=rf.Body(STEEL, rf.Sphere(RADIUS)),
        lower=rf.Body(STEEL, rf.Flat()),
        friction=law or rf.Friction(TAU, BETA),
        load=LOAD,
        side=side,
    )


def test_against_hertz_errors_are_a_fifth_and_each_within_its_bar() -> None:
    """mu of a flat ball is ``tau pi a^2 / P + beta``; domains of several sizes move its edge."""
    exact = TAU * HERTZ_AREA / LOAD + BETA
    solved = [rf.solve(ball(SIDE * (1 + 0.013 * k)), 48, oblique=False) for k in range(12)]
    raw, corrected = (
        np.array([getattr(s, name) - exact for s in solved])
        for name in ("friction_coefficient", "friction_coefficient_corrected")
    )
    assert np.sqrt(np.mean(corrected**2)) < np.sqrt(np.mean(raw**2)) / 5
    assert all(
        abs(off) <= s.error("friction_coefficient_corrected")
        for s, off in zip(solved, corrected, strict=True)
    )
    assert all(s.error("friction_coefficient_corrected") < s.error("friction_coefficient") for s in solved)


def test_only_tau_acts_on_the_excess() -> None:
    s = rf.solve(ball(), 32)
    share = TAU * s.details.features.excess / LOAD
    assert s.friction_coefficient_corrected == pytest.approx(s.friction_coefficient - share, rel=1e-12)
    assert s.friction_force_corrected == pytest.approx(s.friction_coefficient_corrected * LOAD, rel=1e-9)
    without = rf.solve(ball(law=rf.Friction(0.0, BETA)), 32)
    assert without.friction_coefficient_corrected == without.friction_coefficient
    assert without.friction_force_corrected == without.friction_force


def test_an_accuracy_is_that_of_the_corrected_number_unless_another_is_requested() -> None:
    scene = ball()
    default, corrected, raw = (
        rf.solve(scene, accuracy=0.01, quantity=quantity)
        for quantity in (None, "friction_coefficient_corrected", "friction_coefficient")
    )
    assert default.grid == corrected.grid
    assert default.error("friction_coefficient_corrected") <= 0.01 * default.friction_coefficient_corrected
    assert raw.error("friction_coefficient") <= 0.01 * raw.friction_coefficient
    assert raw.grid.elements > default.grid.elements
