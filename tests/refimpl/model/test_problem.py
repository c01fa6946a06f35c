"""The discrete problem: gap, signs of both bodies' displacements, facet tractions, load weights."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import refimpl as rf
from refimpl.grid.window import Window
from refimpl.model import problem as module
from refimpl.model.forces import resultants
from refimpl.model.friction import local_friction
from refimpl.model.problem import Problem, Terms, pose, visit
from refimpl.model.slopes import Slopes
from refimpl.operators.dense import DenseInfluence
from refimpl.operators.fft import Counter, FFTInfluence

SOFT, HARD = rf.Material(2e9, 0.1), rf.Material(50e9, 0.4)
M, SIDE = 6, 1e-3
RANDOM = np.random.default_rng(5)
SCENE = rf.Scene(
    upper=rf.Body(HARD, RANDOM.uniform(0, 1e-6, (M, M))),
    lower=rf.Body(SOFT, RANDOM.uniform(0, 1e-6, (M, M))),
    friction=rf.Friction(tau=3e5, beta=0.2),
    load=1.0,
    side=SIDE,
    sliding_direction=0.7,
)
ALL = Terms(coupled=True, oblique=True, slope_correction=False)
F = RANDOM.uniform(0, 5e6, (M, M)) * (RANDOM.random((M, M)) < 0.5)
SLOPES = Slopes(RANDOM.uniform(-0.1, 0.1, (M, M)), RANDOM.uniform(-0.1, 0.1, (M, M)))


def posed(terms: Terms = ALL, **changes: object) -> Problem:
    return replace(pose(SCENE, rf.Grid(SIDE, M), terms, None), **changes)


def operator() -> DenseInfluence:
    return DenseInfluence(rf.Grid(SIDE, M), SCENE.sliding_direction)


def test_the_gap_touches_and_heights_come_back() -> None:
    problem = posed()
    lower, upper = SCENE.heights(problem.grid)
    assert problem.gap.min() == 0
    np.testing.assert_allclose(problem.gap, upper - lower - (upper - lower).min(), atol=1e-21)
    z_lower, z_upper = problem.heights
    np.testing.assert_allclose(z_lower, lower, atol=1e-21)
    np.testing.assert_allclose(z_upper - z_lower, problem.gap, atol=1e-21)


def test_load_or_approach_not_both() -> None:
    by_load = pose(SCENE, rf.Grid(SIDE, M), ALL, None)
    by_approach = pose(SCENE, rf.Grid(SIDE, M), ALL, 1e-7)
    assert (by_load.load, by_load.approach) == (1.0, None)
    assert (by_approach.load, by_approach.approach) == (None, 1e-7)
    periodic = pose(replace(SCENE, periodic=True), rf.Grid(SIDE, M), ALL, -1e-7)
    assert periodic.approach == pytest.approx(periodic.gap.mean() - 1e-7, rel=1e-14)


def test_displacements_of_each_body() -> None:
    """Pressure goes into both; friction along +s pushes the lower surface in ahead, the upper one behind."""
    problem, A = posed(), operator()
    r = local_friction(SCENE.friction, F, F > 0)
    lower, upper = problem.displacements(A, F, r, Slopes.flat(F.shape))
    normal, shear = A.normal(F), A.shear(r)
    np.testing.assert_allclose(lower, SOFT.normal_compliance * normal + SOFT.shear_compliance * shear)
    np.testing.assert_allclose(upper, HARD.normal_compliance * normal - HARD.shear_compliance * shear)
    combined = problem.pair.normal_compliance * normal + problem.pair.shear_compliance * shear
    np.testing.assert_allclose(lower + upper, combined, rtol=1e-14)


def test_a_known_product_is_used() -> None:
    problem, A = posed(), operator()
    r, flat = 0.2 * F, Slopes.flat(F.shape)
    plain = problem.displacements(A, F, r, flat)
    again = problem.displacements(A, F, r, flat, product=A.normal(F))
    np.testing.assert_array_equal(again, plain)


@pytest.mark.parametrize(
    ("coupled", "oblique", "tilted"), [(False, False, True), (False, True, False), (False, False, False)]
)
def test_shear_that_moves_nothing_that_enters_is_not_computed(
    coupled: bool, oblique: bool, tilted: bool
) -> None:
    terms = Terms(coupled=coupled, oblique=oblique, slope_correction=False, tilted=tilted)
    assert not terms.shear_moves()
    counter = Counter()
    lower, upper = posed(terms).displacements(
        operator=FFTInfluence(rf.Grid(SIDE, M), 0.7, counter=counter),
        pressure=F,
        traction=0.2 * F,
        slopes=SLOPES,
    )
    normal = operator().normal(F)
    np.testing.assert_allclose(lower, SOFT.normal_compliance * normal, rtol=1e-12)
    np.testing.assert_allclose(upper, HARD.normal_compliance * normal, rtol=1e-12)
    assert counter.tally == {"normal": 1, "normal kernel": 1}


@pytest.mark.parametrize("slope_correction", [False, True])
def test_only_tractions_that_are_not_zero_are_applied(slope_correction: bool) -> None:
    """Without friction nothing shears flat elements; on facets the pressure itself does."""
    counter = Counter()
    problem = posed(replace(ALL, slope_correction=slope_correction))
    problem.displacements(FFTInfluence(problem.grid, 0.7, counter=counter), F, 0 * F, SLOPES)
    assert counter.tally.get("shear", 0) == (2 if slope_correction else 0)


def test_what_a_report_keeps_of_a_state() -> None:
    """Friction over the prescribed load, or over the force at an approach; the area of what is pressed."""
    forces = resultants(F, 0.2 * F, SLOPES, (SIDE / M) ** 2)
    at_load = visit(posed(), F, 0.2 * F, SLOPES)
    at_approach = visit(posed(load=None, approach=1e-7), F, 0.2 * F, SLOPES)
    assert at_load.friction_coefficient == pytest.approx(forces.friction / 1.0, rel=1e-15)
    assert at_approach.friction_coefficient == pytest.approx(forces.friction / forces.normal, rel=1e-15)
    assert forces.normal != pytest.approx(1.0, rel=0.1)
    for found in (at_load, at_approach):
        assert found.contact_area == pytest.approx((F > 0).sum() * SIDE**2 / M**2, rel=1e-14)
    apart = visit(posed(load=None, approach=-1e-7), 0 * F, 0 * F, SLOPES)
    assert np.isnan(apart.friction_coefficient)
    assert apart.contact_area == 0


def test_memory_is_kept_for_the_grids_elements(monkeypatch: pytest.MonkeyPatch) -> None:
    kept: list[int] = []
    monkeypatch.setattr(module, "keep_memory", kept.append)
    posed()
    assert kept == [M * M]


def test_facet_tractions_enter_with_the_slope_correction() -> None:
    problem, A = posed(replace(ALL, slope_correction=True)), operator()
    r = 0.2 * F
    down, along, across = problem.tractions(F, r, SLOPES)
    np.testing.assert_array_equal(down, F - r * SLOPES.tan_x)
    np.testing.assert_array_equal(along, r + F * SLOPES.tan_x)
    np.testing.assert_array_equal(across, F * SLOPES.tan_y)
    lower, _ = problem.displacements(A, F, r, SLOPES)
    shear = A.shear(along) + A.shear_across(across)
    np.testing.assert_allclose(lower, SOFT.normal_compliance * A.normal(down) + SOFT.shear_compliance * shear)


def test_as_printed_tractions_are_f_and_r() -> None:
    down, along, across = posed().tractions(F, 0.2 * F, SLOPES)
    assert down is F
    assert across is None
    np.testing.assert_array_equal(along, 0.2 * F)


def test_slopes_are_of_the_mean_of_both_deformed_surfaces() -> None:
    problem = posed()
    u_lower, u_upper = RANDOM.uniform(0, 1e-6, (2, M, M))
    z_lower, z_upper = problem.heights
    mean = ((z_lower - u_lower) + (z_upper + u_upper)) / 2
    expected = Slopes.of_surface(mean, SIDE / M, 0.7)
    found = problem.slopes(u_lower, u_upper)
    np.testing.assert_allclose(found.tan_x, expected.tan_x, atol=1e-17)
    np.testing.assert_allclose(found.tan_y, expected.tan_y, atol=1e-17)
    assert np.all(posed(replace(ALL, oblique=False)).slopes(u_lower, u_upper).obliqueness == 1)


def test_load_weights_are_eq_2() -> None:
    """N is an affine map of f, with the weights and the offset that tau contributes."""
    problem = posed()
    support = F > 1e6
    weights, offset = problem.load_weights(SLOPES, support)
    r = local_friction(SCENE.friction, F, support)
    normal = resultants(F, r, SLOPES, problem.grid.element_area).normal
    mapped = float(np.vdot(weights, F)) * problem.grid.element_area - offset
    assert mapped == pytest.approx(normal, rel=1e-13)


def test_a_window_is_the_same_problem() -> None:
    problem = posed()
    small = problem.windowed(Window(1, 4, 2, 6))
    assert small.gap.shape == small.mean_surface.shape == (3, 4)
    np.testing.assert_array_equal(small.gap, problem.gap[1:4, 2:6])
    assert small.grid == problem.grid


def test_shear_couples_by_the_difference_and_tilts_by_the_sum() -> None:
    """Of what shear does to two bodies, either part may be left out; both together are each body's own."""
    shear = operator().shear(F)
    c_lower, c_upper = SCENE.materials.lower.shear_compliance, SCENE.materials.upper.shear_compliance
    parts = {}
    for coupled, tilted in ((True, True), (True, False), (False, True)):
        terms = Terms(coupled=coupled, oblique=True, slope_correction=False, tilted=tilted)
        lower, upper = posed(terms).displacements(operator(), 0 * F, F, SLOPES)
        parts[coupled, tilted] = np.array([lower, upper])
    tolerance = 1e-14 * np.abs(c_lower * shear).max()
    both = np.array([c_lower * shear, -c_upper * shear])
    couples = np.array([shear, shear]) * (c_lower - c_upper) / 2
    tilts = np.array([shear, -shear]) * (c_lower + c_upper) / 2
    for found, expected in zip(parts.values(), (both, couples, tilts), strict=True):
        np.testing.assert_allclose(found, expected, rtol=0, atol=tolerance)


def test_a_problem_and_its_terms_cannot_be_changed_and_a_problem_is_itself_only() -> None:
    problem = posed()
    for fixed in (problem, problem.terms):
        for name in vars(fixed):
            with pytest.raises(AttributeError, match="cannot assign"):
                setattr(fixed, name, 0)
    assert problem != posed()
    assert {problem: 1}[problem] == 1
