"""The certificate sees each kind of wrong state, elastic or capped, from the returned arrays alone."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import refimpl as rf
from refimpl.model.certificate import (
    Certificate,
    State,
    approach_from,
    certify,
    missed_approach,
    relative_gap,
)
from refimpl.model.problem import Problem
from refimpl.model.slopes import Slopes
from refimpl.operators.influence import whole_grid_influence
from refimpl.planning.plan import Method
from refimpl.scene.discretise import discretise
from tests.refimpl.solvers.production.levels import BALL
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


def test_slopes_of_another_state_are_seen() -> None:
    wrong = Slopes(SOLVED.slopes.tan_x + 1e-4 * SOLVED.contact, SOLVED.slopes.tan_y)
    assert judged(slopes=wrong).certificate.slope == pytest.approx(1e-4, rel=1e-6)


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


@pytest.mark.parametrize("factor", [0.0, -1.0])
def test_at_an_approach_only_contact_has_a_load_error(factor: float) -> None:
    """Without a positive resultant there is no mean separation; other residuals judge such a state."""
    pressure = factor * SOLVED.pressure
    pressure.flat[0] = -0.1 * factor * SOLVED.max_pressure
    certificate = judged(pressure, 0 * pressure, approach=SOLVED.approach).certificate
    assert certificate.load_error == 0
    assert certificate.penetration > 0.1


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


def test_traction_without_contact_is_unlawful() -> None:
    traction = SOLVED.traction.copy()
    traction[tuple(np.argwhere(~SOLVED.contact)[0])] = 1.0
    assert judged(traction=traction).certificate.law_violations == 1


HARD = replace(
    BALL,
    lower=rf.Body(replace(BALL.lower.material, hardness=4e6), rf.GaussianRoughness(1e-6, 5e-4, seed=3)),
    friction=rf.Friction(),
)


def certified(s: rf.Solution, pressure: np.ndarray) -> State:
    operator = DenseInfluence(s.grid, s.details.sliding_direction)
    return certify(s.details.problem, operator, pressure, s.traction, s.slopes, s.plastic_indentation)


@pytest.fixture(scope="module")
def solution() -> rf.Solution:
    s = rf.solve(HARD, 16, method="dense", oblique=False)
    assert 0.1 < s.plastic_share < 0.9
    return s


def test_an_element_that_bears_too_little_counts_with_its_room_below_the_cap(solution: rf.Solution) -> None:
    """At d fixed, ``(H - f)(d - v)`` of the one element alone, over the energy, is less than the gap."""
    s = rf.solve(HARD, 16, method="dense", oblique=False, approach=solution.approach)
    pressure, H = s.pressure.copy(), s.details.problem.cap
    deepest = np.unravel_index(np.argmax(s.plastic_indentation), pressure.shape)
    assert pressure[deepest] == H
    pressure[deepest] = 0.5 * H
    state = certified(s, pressure)
    u = state.displacement_lower + state.displacement_upper
    energy = 0.5 * float(np.sum(pressure * u))
    missed = 0.5 * H * float(s.approach - state.v[deepest])
    assert missed > 0
    assert state.certificate.gap >= missed / energy > 1e-3


def test_an_excess_over_the_hardness_counts_as_negative_pressure_does(solution: rf.Solution) -> None:
    pressure = solution.pressure.copy()
    pressure[np.unravel_index(np.argmax(pressure), pressure.shape)] *= 1.01
    assert certified(solution, pressure).certificate.negative_pressure == pytest.approx(
        0.01 / 1.01, rel=1e-12
    )
    assert certified(solution, solution.pressure).certificate.largest < 1e-11


@pytest.mark.parametrize(
    ("pressure", "cap", "approach"),
    [
        ([3.0, 1.0, 0.0, 0.0], math.inf, (3 * 5 + 4) / 4),  # the mean weighted by pressure
        ([9.0, 1.0, 2.0, 0.0], 9.0, (4 + 2 * 6) / 3),  # of the free elements alone
        ([9.0, 9.0, 0.0, 0.0], 9.0, 5.5),  # the middle between 5, the most at the cap, and 6, the least free
        ([9.0, 9.0, 9.0, 9.0], 9.0, 8.0),  # nothing free: the most at the cap
        ([0.0, 0.0, 0.0, 0.0], 9.0, 4.0),  # no pressure: the least
    ],
)
def test_the_approach_of_a_state(pressure: list[float], cap: float, approach: float) -> None:
    v = np.array([[5.0, 4.0, 6.0, 8.0]])
    assert approach_from(np.array([pressure]), v, cap) == pytest.approx(approach, rel=1e-15)


def test_any_approach_between_capped_and_unloaded_elements_is_the_states() -> None:
    """Between 2 at H and 5 without load; beyond them the distance counts, with a free element the mean."""
    v, f = np.array([[1.0, 2.0, 5.0]]), np.array([[4.0, 4.0, 0.0]])
    assert [missed_approach(f, v, 4.0, d) for d in (1.5, 2.5, 4.5, 6.0)] == [0.5, 0.0, 0.0, 1.0]
    assert missed_approach(np.array([[4.0, 3.0, 0.0]]), v, 4.0, 2.5) == 0.5
    assert missed_approach(np.array([[0.0, 0.0, 0.0]]), v, 4.0, 0.25) == 0.75


def test_slopes_without_the_indentation_are_not_those_of_the_common_surface() -> None:
    s = rf.solve(HARD, 16, method="dense", oblique=True)
    operator = DenseInfluence(s.grid, s.details.sliding_direction)
    lower, upper = s.details.problem.displacements(operator, s.pressure, s.traction, s.slopes)
    elastic = s.details.problem.slopes(lower, upper, None)
    with_it = certified(s, s.pressure)
    without = certify(s.details.problem, operator, s.pressure, s.traction, elastic, None)
    assert with_it.certificate.slope < 1e-10
    assert without.certificate.slope > 1e-5
    # the indented surfaces touch: an element's slopes count in Eq. (6), by 1e-6 of 1 um and more here
    assert with_it.plastic.sum() > 3
    assert np.abs(with_it.gap[with_it.contact]).max() < 1e-10 * with_it.approach


@pytest.mark.parametrize("times", [1.0, 100.0])
@pytest.mark.parametrize("method", ["fft", "dense"])
def test_rounding_of_a_mean_pressure_passes_and_spoilt_pressures_do_not(times: float, method: Method) -> None:
    """Full periodic contact above the modulus: its energy does not grow with the mean pressure."""
    pair = rf.Material(200e9, 0.3), rf.Material(3e9, 0.4)
    wave = np.cos(2 * np.pi * np.arange(5) / 5)
    waves = rf.Body(pair[1], 5e-7 * np.add.outer(wave, wave))
    flat = rf.Scene(rf.Body(pair[0], rf.Flat()), waves, rf.Friction(beta=0.1), 1.0, 1e-3, periodic=True)
    pressed = replace(flat, load=times * flat.materials.reduced_modulus * 1e-6)
    found = rf.solve(pressed, 5, method=method, tolerance=1e-10)
    assert found.status is rf.Status.CONVERGED
    assert found.certificate.gap <= found.certificate.gap_rounding
    problem = found.details.problem
    spoilt = found.pressure.copy()
    spoilt[2, 3] += 1e-6 * found.max_pressure
    operator = whole_grid_influence(problem.grid, problem.direction, problem.grid.window)
    traction = problem.friction.traction(spoilt, spoilt > 0)
    judged = certify(problem, operator, spoilt, traction, found.slopes).certificate
    assert not judged.satisfies(1e-10)
