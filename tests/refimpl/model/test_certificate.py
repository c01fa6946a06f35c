"""The certificate sees each kind of wrong state, from the returned arrays alone."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import refimpl as rf
from refimpl.model.certificate import Certificate, State, certify, relative_gap
from refimpl.model.problem import Problem, Terms
from refimpl.model.slopes import Slopes
from refimpl.operators.fft import Counter, FFTInfluence
from refimpl.scene.discretise import discretise
from verification.exact.dense_influence import DenseInfluence

M = 10
SCENE = rf.Scene(
    upper=rf.Body(rf.Material(50e9, 0.4), rf.Sphere(0.05)),
    lower=rf.Body(rf.Material(2e9, 0.1), rf.GaussianRoughness(3e-7, 4e-4, seed=3)),
    friction=rf.Friction(tau=3e5, beta=0.2),
    load=2.0,
    side=1e-3,
    sliding_direction=0.7,
)
GRID = rf.Grid.square(SCENE.side, M)
SOLVED = rf.solve(SCENE, M, method="dense", tolerance=1e-12)


def problem(approach: float | None = None) -> Problem:
    return discretise(SCENE, GRID, approach=approach)


def judged(
    pressure: np.ndarray = SOLVED.pressure,
    traction: np.ndarray = SOLVED.traction,
    slopes: Slopes = SOLVED.slopes,
    approach: float | None = None,
) -> State:
    operator = DenseInfluence(GRID, SCENE.sliding_direction)
    return certify(problem(approach), operator, pressure, traction, slopes)


def energy_density(pressure: np.ndarray) -> float:
    """Elastic energy over an element's area (J/m^2)."""
    displaced = DenseInfluence(GRID, SCENE.sliding_direction).normal(pressure)
    return float(0.5 * SCENE.materials.normal_compliance * np.sum(pressure * displaced))


def lawful(pressure: np.ndarray) -> np.ndarray:
    return np.where(pressure > 0, SCENE.friction.tau + SCENE.friction.beta * pressure, 0.0)


def test_the_solved_state_is_certified() -> None:
    assert SOLVED.status is rf.Status.CONVERGED
    certificate = judged().certificate
    assert certificate.largest < 1e-13
    assert certificate.law_violations == 0
    assert certificate.satisfies(1e-12)
    assert judged(approach=SOLVED.approach).certificate.largest < 1e-13


@pytest.mark.parametrize("least", [0.1, 1e-300])
def test_any_pressure_is_contact(least: float) -> None:
    """Contact is f > 0, however small in pascals: friction there is lawful."""
    pressure = SOLVED.pressure.copy()
    pressure.flat[0] = least
    assert judged(pressure, lawful(pressure)).certificate.law_violations == 0


def test_the_numbers_are_spec_1s() -> None:
    """Gap over energy, penetration, load error: written out once more."""
    pressure = 1.01 * SOLVED.pressure
    state = judged(pressure, lawful(pressure))
    dA = (SCENE.side / M) ** 2
    K = np.cos(np.arctan(state.slopes.tan_x)) * np.cos(np.arctan(state.slopes.tan_y))
    v = (state.displacement_lower + state.displacement_upper) / K + problem().gap
    a = (1 - 0.4**2) / (np.pi * 50e9) + (1 - 0.1**2) / (np.pi * 2e9)
    af = a * DenseInfluence(GRID, 0.7).normal(pressure)
    energy = (pressure * af).sum() / 2 * dA
    assert state.certificate.gap == pytest.approx((pressure * (v - v.min())).sum() * dA / energy, rel=1e-9)
    mean = (pressure * v).sum() / pressure.sum()
    assert state.approach == pytest.approx(mean, rel=1e-13)
    assert state.certificate.penetration == pytest.approx((mean - v.min()) / mean, rel=1e-9)
    assert state.certificate.load_error == pytest.approx(abs(state.forces.normal / SCENE.load - 1), rel=1e-9)
    assert state.certificate.load_error == pytest.approx(0.01, rel=0.01)


def test_a_negative_pressure_is_seen() -> None:
    pressure = SOLVED.pressure.copy()
    pressure[0, 0] = -1e-5 * SOLVED.max_pressure
    assert judged(pressure).certificate.negative_pressure == pytest.approx(1e-5)


def test_a_wrong_load_or_approach_is_seen() -> None:
    assert judged((1 + 1e-6) * SOLVED.pressure).certificate.load_error == pytest.approx(1e-6, rel=0.1)
    missed = judged(approach=1.001 * SOLVED.approach).certificate
    work = 1e-3 * SOLVED.approach * SOLVED.pressure.sum()
    assert missed.load_error == pytest.approx(work / energy_density(SOLVED.pressure), rel=1e-9)
    assert missed.penetration == pytest.approx(1e-3, rel=0.01)


def test_faint_pressures_are_judged_like_others_until_displacements_vanish() -> None:
    """At the least approach nothing is known of the mean separation: the load error is infinite."""
    smooth = rf.read_scene("table1-smooth")
    pressed = [
        rf.solve(smooth, 16, approach=a, oblique=False, coupled=False, method="dense") for a in (1e-9, 1e-300)
    ]
    assert all(s.status is rf.Status.CONVERGED for s in pressed)
    assert pressed[1].contact_area == pressed[0].contact_area
    for grid in (3, 16):  # the mean separation of a single element is that least number, or of many none
        lost = rf.solve(smooth, grid, approach=5e-324, oblique=False, coupled=False)
        assert lost.max_pressure > 0
        assert lost.certificate.load_error == np.inf


def test_slopes_of_another_state_are_seen() -> None:
    wrong = Slopes(SOLVED.slopes.tan_x + 1e-4 * SOLVED.contact, SOLVED.slopes.tan_y)
    assert judged(slopes=wrong).certificate.slope == pytest.approx(1e-4, rel=1e-6)


def test_unlawful_friction_in_contact_is_counted() -> None:
    traction = np.where(SOLVED.pressure == SOLVED.max_pressure, 0.0, SOLVED.traction)
    assert judged(traction=traction).certificate.law_violations == 1


def test_a_gap_is_relative_to_the_energy() -> None:
    """Zero in an exact state without energy; infinite beside an energy that is not positive."""
    assert relative_gap(0.0, 0.0) == 0
    assert relative_gap(1.0, 2.0) == 0.5
    assert relative_gap(-1.0, 2.0) == -0.5
    assert relative_gap(1.0, 0.0) == relative_gap(1.0, -1.0) == np.inf


@pytest.mark.parametrize("field", ["gap", "penetration", "negative_pressure", "load_error", "slope"])
def test_each_residual_counts_and_nan_never_passes(field: str) -> None:
    clean = Certificate(0.0, 0.0, 0.0, 0.0, 0.0, 0)
    assert clean.satisfies(0.0)
    assert not replace(clean, **{field: 1e-3}).satisfies(1e-4)
    assert replace(clean, **{field: np.nan}).largest == np.inf
    assert not replace(clean, **{field: np.nan}).satisfies(1.0)


def test_the_clearance_is_zero_in_contact_and_positive_outside() -> None:
    state = judged()
    assert np.abs(state.clearance[SOLVED.contact]).max() <= 1e-13 * state.approach
    assert state.clearance[~SOLVED.contact].min() > 1e-6 * state.approach


@pytest.mark.parametrize("factor", [0.0, -1.0])
def test_at_an_approach_only_contact_has_a_load_error(factor: float) -> None:
    """Without a positive resultant there is no mean separation; other residuals judge such a state."""
    pressure = factor * SOLVED.pressure
    pressure.flat[0] = -0.1 * factor * SOLVED.max_pressure
    certificate = judged(pressure, 0 * pressure, approach=SOLVED.approach).certificate
    assert certificate.load_error == 0
    assert certificate.penetration > 0.1


@pytest.mark.parametrize("slope_correction", [False, True])
def test_displacements_are_of_the_tractions_that_enter_and_not_applied_twice(slope_correction: bool) -> None:
    given = problem().with_terms(Terms(slope_correction=slope_correction))
    counter = Counter()
    operator = FFTInfluence(GRID, SCENE.sliding_direction, counter=counter)
    steep = Slopes(SOLVED.slopes.tan_x + 0.1, SOLVED.slopes.tan_y)
    state = certify(given, operator, SOLVED.pressure, SOLVED.traction, steep)
    dense = DenseInfluence(GRID, SCENE.sliding_direction)
    expected = given.displacements(dense, SOLVED.pressure, SOLVED.traction, steep)
    for found, exact in zip((state.displacement_lower, state.displacement_upper), expected, strict=True):
        np.testing.assert_allclose(found, exact, rtol=0, atol=1e-13 * np.abs(exact).max())
    assert counter.tally["normal"] == (2 if slope_correction else 1)


def test_an_element_that_pulls_is_no_contact() -> None:
    """There is no tau on it, and its slopes do not count."""
    pressure, traction = SOLVED.pressure.copy(), SOLVED.traction.copy()
    i, j = np.argwhere(~SOLVED.contact)[0]
    pressure[i, j] = -1e-3 * SOLVED.max_pressure
    traction[i, j] = SCENE.friction.beta * pressure[i, j]
    state = judged(pressure, traction)
    bent = state.slopes.tan_x.copy()
    bent[i, j] += 1.0
    certificate = judged(pressure, traction, Slopes(bent, state.slopes.tan_y)).certificate
    assert certificate.law_violations == 0
    assert certificate.slope < 1e-12


@pytest.mark.parametrize("scale", [1e-9, -1e-9])
def test_the_approach_is_the_mean_separation_of_any_pressure_and_the_lowest_of_none(scale: float) -> None:
    """However small in pascals; a resultant that pulls has no mean."""
    pressure = scale * SOLVED.pressure
    pressure.flat[0] = 1e-3 * np.abs(pressure).max()
    state = judged(pressure, 0 * pressure)
    v = state.v
    expected = (pressure * v).sum() / pressure.sum() if scale > 0 else v.min()
    assert state.approach == pytest.approx(expected, rel=1e-12, abs=1e-30)
    assert v.max() > expected
    at = judged(pressure, 0 * pressure, approach=1e-7)
    work = abs(expected - 1e-7) * pressure.sum() if scale > 0 else 0.0
    load_error = work / energy_density(pressure)
    assert at.certificate.load_error == pytest.approx(load_error, rel=1e-9)


def test_at_first_touch_penetration_is_in_metres() -> None:
    """There is no approach to relate it to; shear alone, which no law allows, moves the surfaces together."""
    zero, traction = np.zeros((M, M)), np.zeros((M, M))
    traction[5, 5] = 1e8
    state = judged(zero, traction, approach=0.0)
    assert state.v.min() < 0
    assert state.certificate.penetration == -state.v.min()


def test_surfaces_apart_leave_no_residual() -> None:
    zero = np.zeros((M, M))
    undeformed = Slopes.of_surface(problem().mean_surface, GRID, SCENE.sliding_direction)
    state = judged(zero, zero, undeformed, -1e-7)
    assert set(vars(state.certificate).values()) == {0}
    assert state.approach == -1e-7


def test_no_pressure_carries_no_load() -> None:
    zero = np.zeros((M, M))
    certificate = judged(zero, zero).certificate
    assert certificate.load_error == 1
    assert not certificate.satisfies(0.5)


def test_traction_without_contact_is_unlawful() -> None:
    outside = np.argwhere(~SOLVED.contact)[0]
    traction = SOLVED.traction.copy()
    traction[tuple(outside)] = 1.0
    operator = DenseInfluence(GRID, SCENE.sliding_direction)
    lawful, unlawful = (
        certify(problem(), operator, SOLVED.pressure, r, SOLVED.slopes) for r in (SOLVED.traction, traction)
    )
    assert lawful.certificate.law_violations == 0
    assert unlawful.certificate.law_violations == 1
