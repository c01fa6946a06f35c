"""The discrete problem: gap, tractions that enter, displacements, slopes, load weights, windows."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import refimpl as rf
from refimpl.grid import Grid, Window
from refimpl.model.elasticity import Elasticity
from refimpl.model.forces import resultants
from refimpl.model.materials import Pair
from refimpl.model.problem import Problem, Terms
from refimpl.model.slopes import Slopes
from refimpl.operators.fft import Counter, FFTInfluence
from refimpl.scene.discretise import discretise
from verification.exact.dense_influence import DenseInfluence

SOFT, HARD = rf.Material(2e9, 0.1), rf.Material(50e9, 0.4)
SIDE = 1e-3
GRID = Grid((6, 8), (SIDE, SIDE))
PIXEL = GRID.spacings
RANDOM = np.random.default_rng(5)
SCENE = rf.Scene(
    upper=rf.Body(HARD, rf.ArraySurface(RANDOM.uniform(0, 1e-6, GRID.shape), PIXEL)),
    lower=rf.Body(SOFT, rf.ArraySurface(RANDOM.uniform(0, 1e-6, GRID.shape), PIXEL)),
    friction=rf.Friction(tau=3e5, beta=0.2),
    load=1.0,
    side=SIDE,
    sliding_direction=0.7,
)
F = RANDOM.uniform(0, 5e6, GRID.shape) * (RANDOM.random(GRID.shape) < 0.5)
SLOPES = Slopes(RANDOM.uniform(-0.1, 0.1, GRID.shape), RANDOM.uniform(-0.1, 0.1, GRID.shape))
CORRECTED = Terms(slope_correction=True)


def problem_with(terms: Terms | None = None, approach: float | None = None) -> Problem:
    return discretise(SCENE, GRID, terms, approach)


def operator() -> DenseInfluence:
    return DenseInfluence(GRID, SCENE.sliding_direction)


def test_displacements_are_of_pressure_and_shear() -> None:
    """Of the tractions as printed, and of facet tractions along and across the sliding direction."""
    A = operator()
    for terms in (Terms(), CORRECTED):
        problem = problem_with(terms)
        down, along, across = problem.tractions(F, 0.2 * F, SLOPES)
        shear = A.shear(along) + (0 if across is None else A.shear_across(across))
        expected = problem.elasticity.body_displacements(problem.elasticity.normal(A, down), down, shear)
        np.testing.assert_array_equal(problem.displacements(A, F, 0.2 * F, SLOPES), expected)
        assert np.abs(problem.elasticity.gap_by_shear(shear)).max() > 1e-3 * np.abs(expected).max()


def test_known_normal_displacements_are_not_those_of_facets() -> None:
    """With the slope correction what presses down is not the pressure."""
    problem, A = problem_with(CORRECTED), operator()
    plain = problem.displacements(A, F, 0.2 * F, SLOPES)
    again = problem.displacements(A, F, 0.2 * F, SLOPES, normal=problem.elasticity.normal(A, F))
    np.testing.assert_array_equal(again, plain)


@pytest.mark.parametrize(
    "terms",
    [Terms(coupled=False, oblique=False), Terms(coupled=False, tilted=False)],
    ids=["level", "oblique"],
)
def test_shear_that_moves_nothing_that_enters_is_not_computed(terms: Terms) -> None:
    counter = Counter()
    lower, upper = problem_with(terms).displacements(
        FFTInfluence(GRID, 0.7, counter=counter), pressure=F, traction=0.2 * F, slopes=SLOPES
    )
    normal = operator().normal(F)
    np.testing.assert_allclose(lower, SOFT.normal_compliance * normal, rtol=1e-12)
    np.testing.assert_allclose(upper, HARD.normal_compliance * normal, rtol=1e-12)
    assert counter.tally == {"normal": 1, "normal kernel": 1}


def test_facet_tractions_enter_with_the_slope_correction() -> None:
    problem, A = problem_with(CORRECTED), operator()
    r = 0.2 * F
    down, along, across = problem.tractions(F, r, SLOPES)
    np.testing.assert_array_equal(down, F - r * SLOPES.tan_x)
    np.testing.assert_array_equal(along, r + F * SLOPES.tan_x)
    np.testing.assert_array_equal(across, F * SLOPES.tan_y)
    lower, _ = problem.displacements(A, F, r, SLOPES)
    shear = A.shear(along) + A.shear_across(across)
    np.testing.assert_allclose(lower, SOFT.normal_compliance * A.normal(down) + SOFT.shear_compliance * shear)


def test_slopes_are_of_the_mean_of_both_deformed_surfaces() -> None:
    problem = problem_with()
    u_lower, u_upper = RANDOM.uniform(0, 1e-6, (2, *GRID.shape))
    z_lower, z_upper = problem.heights
    mean = ((z_lower - u_lower) + (z_upper + u_upper)) / 2
    expected = Slopes.of_surface(mean, GRID, 0.7)
    found = problem.slopes(u_lower, u_upper)
    np.testing.assert_allclose(found.tan_x, expected.tan_x, atol=1e-17)
    np.testing.assert_allclose(found.tan_y, expected.tan_y, atol=1e-17)
    assert np.all(problem_with(Terms(oblique=False)).slopes(u_lower, u_upper).obliqueness == 1)


@pytest.mark.parametrize(("lower", "upper", "sign"), [(1e6, None, -0.5), (2e6, 1e6, 0.5)])
def test_the_softer_surface_yields_into_itself(lower: float, upper: float | None, sign: float) -> None:
    pair = Pair(replace(SOFT, hardness=lower), replace(HARD, hardness=upper))
    flat = replace(problem_with(), mean_surface=GRID.zeros, elasticity=Elasticity(pair))
    found = flat.slopes(GRID.zeros, GRID.zeros, F)
    np.testing.assert_allclose(found.tan_y, Slopes.of_surface(sign * F, GRID, 0.7).tan_y, rtol=1e-12)


@pytest.mark.parametrize("terms", [Terms(), Terms(oblique=False)], ids=["oblique", "level"])
def test_load_weights_are_eq_2(terms: Terms) -> None:
    """N is an affine map of f, with the weights and the offset that tau contributes."""
    problem, active = problem_with(terms), F > 1e6
    slopes = SLOPES if terms.oblique else Slopes.flat(GRID.shape)
    weights, offset = problem.load_weights(slopes, SCENE.friction.held_traction(F, active))
    r = SCENE.friction.traction(F, active)
    normal = resultants(F, r, slopes, GRID.element_area).normal
    mapped = float(np.sum(weights * F)) * GRID.element_area - offset
    assert mapped == pytest.approx(normal, rel=1e-13)


def test_a_window_is_the_same_problem() -> None:
    problem = problem_with()
    small = problem.windowed(Window(1, 4, 2, 6))
    assert small.gap.shape == small.mean_surface.shape == (3, 4)
    np.testing.assert_array_equal(small.gap, problem.gap[1:4, 2:6])
    assert small.grid == problem.grid


def test_other_terms_are_those_of_the_elasticity_too() -> None:
    """Without slope terms nothing feels the common surface: both bodies move by their own compliances."""
    problem = problem_with()
    for terms, enters in (
        (Terms(), (True, True)),
        (Terms(coupled=False), (False, True)),
        (Terms(tilted=False), (True, False)),
        (Terms(oblique=False, tilted=False), (True, True)),
        (Terms(coupled=False, oblique=False), (False, False)),
    ):
        other = problem.with_terms(terms)
        assert other.terms == terms
        assert (other.elasticity.coupled, other.elasticity.tilted) == enters
        assert other.gap is problem.gap
