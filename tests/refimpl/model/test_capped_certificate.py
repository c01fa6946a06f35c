"""The certificate of capped states: what breaks the second bound is seen, by hand or from below."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import refimpl as rf
from refimpl.model.certificate import State, approach_from, certify, missed_approach
from refimpl.planning.plan import Method
from tests.refimpl.solvers.production.levels import BALL
from verification.exact.dense_influence import DenseInfluence

HARD = replace(
    BALL,
    lower=rf.Body(replace(BALL.lower.material, hardness=4e6), rf.GaussianRoughness(1e-6, 5e-4, seed=3)),
    friction=rf.Friction(),
)


def certified(s: rf.Solution, pressure: np.ndarray) -> State:
    operator = DenseInfluence(s.grid, s.sliding_direction)
    return certify(s.problem, operator, pressure, s.traction, s.slopes, s.plastic_indentation)


@pytest.fixture(scope="module")
def solution() -> rf.Solution:
    s = rf.solve(HARD, 16, method="dense", oblique=False)
    assert 0.1 < s.plastic_share < 0.9
    return s


def test_an_element_that_bears_too_little_counts_with_its_room_below_the_cap(solution: rf.Solution) -> None:
    """At d fixed, ``(H - f)(d - v)`` of the one element alone, over the energy, is less than the gap."""
    s = rf.solve(HARD, 16, method="dense", oblique=False, approach=solution.approach)
    pressure, H = s.pressure.copy(), s.problem.cap
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


@pytest.mark.parametrize("method", ["dense", "fft"])
@pytest.mark.parametrize("periodic", [False, True])
def test_a_punch_that_yields_everywhere_is_solved_at_an_approach(method: Method, periodic: bool) -> None:
    gap = np.full((4, 4), 3e-6)
    gap[1:3, 1:3] = 0.0
    soft = rf.Material(1e9, 0.3, hardness=1e6)
    flat = rf.Body(rf.Material(1e9, 0.3), rf.ArraySurface(gap))
    scene = rf.Scene(flat, rf.Body(soft, rf.Flat()), rf.Friction(), load=1.0, side=4e-6, periodic=periodic)
    touch = 1e-7 - (float(gap.mean()) if periodic else 0.0)
    s = rf.solve(scene, 4, method=method, approach=touch, oblique=False)
    assert s.status is rf.Status.CONVERGED
    np.testing.assert_array_equal(s.pressure, np.where(gap == 0, 1e6, 0.0))


def test_slopes_without_the_indentation_are_not_those_of_the_common_surface() -> None:
    s = rf.solve(HARD, 16, method="dense", oblique=True)
    operator = DenseInfluence(s.grid, s.sliding_direction)
    lower, upper = s.problem.displacements(operator, s.pressure, s.traction, s.slopes)
    elastic = s.problem.slopes(lower, upper, None)
    with_it = certify(s.problem, operator, s.pressure, s.traction, s.slopes, s.plastic_indentation)
    without = certify(s.problem, operator, s.pressure, s.traction, elastic, None)
    assert with_it.certificate.slope < 1e-10
    assert without.certificate.slope > 1e-5
    # the indented surfaces touch: an element's slopes count in Eq. (6), by 1e-6 of 1 um and more here
    assert with_it.plastic.sum() > 3
    assert np.abs(with_it.gap[with_it.contact]).max() < 1e-10 * with_it.approach
