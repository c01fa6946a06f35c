"""Problems that scene files do not pose: another friction law."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import refimpl as rf
from refimpl.driver.reference import solve_reference
from refimpl.grid import Grid
from refimpl.model.certificate import State, certify
from refimpl.model.friction import FrictionLaw
from refimpl.model.problem import Problem, Terms
from refimpl.operators.fft import Counter
from refimpl.scene.discretise import discretise
from refimpl.solvers.paper import solve_paper
from refimpl.solvers.production.nested_solver import solve_fft
from tests.refimpl.scene.test_own_parts import Limited
from verification.exact.dense_influence import DenseInfluence

TOLERANCE = 1e-12
SAME = 1e-11
"""Of the largest pressure; measured: 2e-12 at most."""


SOFT, HARD = rf.Material(E=2.5e9, nu=0.2), rf.Material(E=200e9, nu=0.3)
SMOOTH = rf.Scene(
    upper=rf.Body(HARD, rf.Sphere(radius=0.02)),
    lower=rf.Body(SOFT, rf.Flat()),
    friction=rf.Friction(tau=5e5, beta=0.3),
    load=5.0,
    side=1.6e-3,
    sliding_direction=0.7,
)
ROUGH = replace(SMOOTH, lower=rf.Body(SOFT, rf.GaussianRoughness(rms=4e-7, correlation_length=3e-4, seed=4)))
WAVY = replace(ROUGH, upper=rf.Body(HARD, rf.Flat()), periodic=True, load=3.0)
SQUARE, OBLONG = Grid.square(1.6e-3, 20), Grid((24, 15), (1.6e-3, 1.6e-3))

CASES = {
    "level": (SMOOTH, SQUARE, Terms(oblique=False), None),
    "rough, level": (ROUGH, OBLONG, Terms(oblique=False), None),
    "rough, at an approach": (ROUGH, SQUARE, Terms(), 5e-6),
    "facet tractions": (ROUGH, SQUARE, Terms(slope_correction=True), None),
    "periodic": (WAVY, replace(OBLONG, periodic=True), Terms(), None),
}
on_cases = pytest.mark.parametrize("case", CASES)


def problem_with(case: str, law: FrictionLaw) -> Problem:
    scene, grid, terms, approach = CASES[case]
    return replace(discretise(scene, grid, terms, approach), friction=law)


def limited(tau: float = SMOOTH.friction.tau) -> Limited:
    """The scenes' law, limited where the pressure is 8 MPa: a third of the largest pressures."""
    beta = SMOOTH.friction.beta
    return Limited(tau, beta, limit=tau + beta * 8e6)


def by_fft(problem: Problem) -> State:
    return solve_fft(problem, TOLERANCE, Counter())


def agree(found: State, expected: State) -> None:
    assert found.status is expected.status
    assert np.array_equal(found.excluded, expected.excluded)
    assert np.abs(found.pressure - expected.pressure).max() <= SAME * expected.pressure.max()
    assert np.abs(found.traction - expected.traction).max() <= SAME * np.abs(expected.traction).max()


@on_cases
def test_the_law_holds_in_the_solution(case: str) -> None:
    """To the last bit, with shear at its limit on a part of the contact; judged by matrices."""
    law = limited()
    problem = problem_with(case, law)
    fft = by_fft(problem)
    operator = DenseInfluence(problem.grid, problem.direction)
    state = certify(problem, operator, fft.pressure, fft.traction, fft.slopes)
    assert state.certificate.satisfies(1.1 * TOLERANCE)  # of the other operator, too, to rounding
    at_limit = fft.traction == law.limit
    assert 0 < np.count_nonzero(at_limit & state.contact) < np.count_nonzero(state.contact)
    if fft.status is rf.Status.CONVERGED:
        assert state.certificate.law_violations == 0
        assert np.array_equal(fft.traction > 0, state.contact)
        assert fft.traction.max() == law.limit


@on_cases
def test_without_a_limit_it_is_the_papers_law(case: str) -> None:
    friction = SMOOTH.friction
    unlimited = Limited(friction.tau, friction.beta, np.inf)
    expected = solve_reference(problem_with(case, friction))
    found = by_fft(problem_with(case, unlimited))
    agree(found, expected)
    assert found.certificate.satisfies(TOLERANCE)


def test_a_limit_of_tau_is_shear_of_tau_whatever_beta_is() -> None:
    """``min(tau + beta f, tau) = tau``: the part ``beta f`` that solvers invert must cancel."""
    tau = SMOOTH.friction.tau
    constant = rf.Friction(tau=tau, beta=0.0)
    expected = solve_reference(problem_with("rough, level", constant))
    found = by_fft(problem_with("rough, level", Limited(tau, 0.3, tau)))
    assert np.abs(found.pressure - expected.pressure).max() <= SAME * expected.pressure.max()
    assert found.certificate.law_violations == 0


def test_the_papers_scheme_solves_it_too() -> None:
    problem = problem_with("rough, level", limited())
    fft = by_fft(problem)
    paper, _ = solve_paper(problem, 1e-9, Counter())
    # pressure steps end at 1e-10 of the pressure; 100 of them for what steepest descent still had to go
    assert np.abs(paper.pressure - fft.pressure).max() <= 1e-8 * fft.pressure.max()
    assert np.array_equal(paper.excluded, fft.excluded)
