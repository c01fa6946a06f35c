"""The discrete problem: tractions that enter, displacements, slopes, load weights, forces, areas."""

from __future__ import annotations

import math
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

import refimpl as rf
from refimpl.grid import Grid, Window
from refimpl.model.elasticity import Elasticity
from refimpl.model.forces import (
    contact_area,
    facet_resultants,
    friction_coefficient,
    perimeter_corrected_area,
    resultants,
)
from refimpl.model.materials import Pair
from refimpl.model.problem import Problem, Terms
from refimpl.model.slopes import Slopes
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
    assert np.all(problem_with(Terms(oblique=False)).slopes(u_lower, u_upper).cosine_product == 1)


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
        assert other.terms == terms.decided
        assert (other.elasticity.coupled, other.elasticity.tilted) == enters
        assert other.gap is problem.gap


OBLONG = Grid((9, 6), (2.25, 3.0))
DX = OBLONG.spacings[0]
X = OBLONG.x[:, None] * np.ones(OBLONG.shape)
Y = OBLONG.y[None, :] * np.ones(OBLONG.shape)


def test_central_differences_are_exact_on_quadratics_inside() -> None:
    slopes = Slopes.of_surface(heights=3 * X**2 + X * Y - 2 * Y, grid=OBLONG, direction=0.0)
    inside = (slice(1, -1), slice(1, -1))
    np.testing.assert_allclose(slopes.tan_x[inside], (6 * X + Y)[inside], atol=1e-13)
    np.testing.assert_allclose(slopes.tan_y[inside], (X - 2)[inside], atol=1e-13)


@pytest.mark.parametrize("angle", [0.0, 0.7, 2.0, -3.0])
def test_directions_of_a_plane(angle: float) -> None:
    """Uphill along sliding is positive; theta_y looks 90 degrees anticlockwise."""
    slopes = Slopes.of_surface(0.3 * X - 0.2 * Y, OBLONG, angle)
    cos, sin = math.cos(angle), math.sin(angle)
    np.testing.assert_allclose(slopes.tan_x, 0.3 * cos - 0.2 * sin, atol=1e-15)
    np.testing.assert_allclose(slopes.tan_y, -0.3 * sin - 0.2 * cos, atol=1e-15)


def test_periodic_differences_wrap() -> None:
    grid = Grid(OBLONG.shape, OBLONG.lengths, periodic=True)
    q = 2 * np.pi / grid.lengths[0]
    slopes = Slopes.of_surface(np.sin(q * X), grid, 0.0)
    np.testing.assert_allclose(slopes.tan_x, np.sin(q * DX) / DX * np.cos(q * X), atol=1e-14)
    np.testing.assert_allclose(slopes.tan_y, 0, atol=1e-15)


def test_two_periodic_elements_have_no_slope() -> None:
    """Either is its neighbour's neighbour on both sides; on a free grid, one is above the other."""
    step = np.array([[0.0], [1.0]])
    periodic, free = (
        Slopes.of_surface(step, Grid((2, 1), (2.0, 1.0), periodic), 0.0).tan_x for periodic in (True, False)
    )
    assert periodic.tolist() == [[0.0], [0.0]]
    assert free.tolist() == [[1.0], [1.0]]


def test_the_mean_square_is_weighted() -> None:
    slopes = Slopes(np.array([[0.3, 0.0]]), np.array([[0.4, 0.1]]))
    assert slopes.mean_square(np.array([[3.0, 1.0]])) == pytest.approx((3 * 0.25 + 0.01) / 4, rel=1e-14)
    assert slopes.mean_square(np.zeros((1, 2))) == 0
    assert Slopes.flat((1, 2)).mean_square(np.ones((1, 2))) == 0


def test_cosines_and_sines_are_those_of_the_angles() -> None:
    slopes = Slopes(np.array([-2.0, 0.0, 0.1]), np.array([0.5, -1e-9, 3.0]))
    theta_x, theta_y = np.arctan(slopes.tan_x), np.arctan(slopes.tan_y)
    np.testing.assert_allclose(slopes.cos_x, np.cos(theta_x), rtol=1e-15)
    np.testing.assert_allclose(slopes.sin_x, np.sin(theta_x), rtol=1e-15)
    np.testing.assert_allclose(slopes.cos_y, np.cos(theta_y), rtol=1e-15)
    np.testing.assert_allclose(slopes.sin_y, np.sin(theta_y), rtol=1e-15)
    np.testing.assert_allclose(slopes.cosine_product, np.cos(theta_x) * np.cos(theta_y), rtol=1e-15)


def test_distance_looks_only_where_asked() -> None:
    one, two = Slopes(np.zeros(3), np.zeros(3)), Slopes(np.array([0.0, 9.0, 0.2]), np.array([0.1, 9.0, 0.0]))
    assert one.distance(two, np.array([True, False, True])) == 0.2
    assert one.distance(two, np.array([False, False, False])) == 0
    assert one.distance(one, np.array([True, True, True])) == 0
    everywhere, flat = np.array([True, True, True]), Slopes.flat((3,))
    assert flat.distance(two, everywhere) == two.distance(flat, everywhere) == 9
    assert flat.distance(flat, everywhere) == 0


def test_slopes_of_a_window_are_zero_elsewhere() -> None:
    tilted = Slopes(np.ones((2, 2)), np.full((2, 2), 2.0))
    whole = tilted.spread(Window(1, 3, 0, 2), Grid((4, 3), (1.0, 1.0)))
    assert whole.tan_x.sum() == 4
    assert np.all(whole.tan_y[1:3, :2] == 2)
    assert np.all(whole.cos_x[0] == 1)


TRIPLES = ((3, 4, 5), (5, 12, 13), (8, 15, 17), (7, 24, 25), (-3, 4, 5), (-20, 21, 29), (0, 1, 1))
"""Opposite, adjacent, hypotenuse: angles whose cosine, sine and tangent are rational."""


def rational_state(M=6, seed=3):
    """Pressures, tractions (integers) and slope triangles for every element."""
    random = np.random.default_rng(seed)
    f = random.integers(0, 1000, (M, M))
    r = random.integers(-500, 500, (M, M))
    at = random.integers(0, len(TRIPLES), (2, M, M))
    return f, r, at


def slopes_of(at):
    tangents = np.array([opposite / adjacent for opposite, adjacent, _ in TRIPLES])
    return Slopes(tangents[at[0]], tangents[at[1]])


def exact_sums(f, r, at, facet):
    total = [Fraction(0), Fraction(0), Fraction(0)]
    for index in np.ndindex(f.shape):
        (ox, ax, hx), (oy, ay, hy) = TRIPLES[at[0][index]], TRIPLES[at[1][index]]
        sin_x, cos_x, sin_y, cos_y = Fraction(ox, hx), Fraction(ax, hx), Fraction(oy, hy), Fraction(ay, hy)
        p, q = int(f[index]), int(r[index])
        if facet:
            terms = (p - q * sin_x / cos_x, q + p * sin_x / cos_x, p * sin_y / cos_y)
        else:
            down = p * cos_x - q * sin_x
            terms = (down * cos_y, (p * sin_x + q * cos_x) * cos_y, down * sin_y)
        total = [sum_ + term for sum_, term in zip(total, terms, strict=True)]
    return [float(t) for t in total]


@pytest.mark.parametrize("facet", [False, True])
@pytest.mark.parametrize("seed", range(2))
def test_sums_are_the_exact_rational_ones(seed, facet):
    """Eqs (2), (3), Q and the facets' own; 36 terms of a few eps each, of at most 2000."""
    f, r, at = rational_state(seed=seed)
    function = facet_resultants if facet else resultants
    found = function(f.astype(float), r.astype(float), slopes_of(at), 0.5)
    exact = 0.5 * np.array(exact_sums(f, r, at, facet))
    np.testing.assert_allclose(found, exact, rtol=0, atol=36 * 2000 * 4e-16)


def test_one_inclined_facet():
    """Pressure on a plane that rises at 3:4 along sliding: friction by geometry alone."""
    slopes = Slopes(np.array([[0.75]]), np.array([[0.0]]))
    found = resultants(np.array([[10.0]]), np.array([[0.0]]), slopes, 2.0)
    assert found == pytest.approx((16.0, 12.0, 0.0), rel=1e-15)
    # a traction uphill lifts: it takes from N
    assert resultants(np.array([[0.0]]), np.array([[10.0]]), slopes, 2.0) == pytest.approx((-12.0, 16.0, 0.0))


FACE = (math.pi - 1 + math.log(2)) / 24
"""Area over that of an element that each face of the contact's edge counts too much."""


@pytest.mark.parametrize("periodic", [False, True])
def test_areas_of_hand_counted_sets(periodic: bool) -> None:
    grid = Grid((4, 3), (2.0, 1.2), periodic)  # dA = 0.2
    contact = np.zeros((4, 3), dtype=bool)
    assert contact_area(contact, grid) == perimeter_corrected_area(contact, grid) == 0
    contact[1, 1] = True
    assert contact_area(contact, grid) == pytest.approx(0.2, rel=1e-15)
    assert perimeter_corrected_area(contact, grid) == pytest.approx(0.2 * (1 - 4 * FACE), rel=1e-15)
    contact[2, 1] = True
    assert perimeter_corrected_area(contact, grid) == pytest.approx(0.2 * (2 - 6 * FACE), rel=1e-15)
    everything = np.ones((4, 3), dtype=bool)  # its border is straight, and known
    assert perimeter_corrected_area(everything, grid) == contact_area(everything, grid)
    column = np.arange(3) == np.zeros((4, 1))
    faces = 8 if periodic else 4
    assert perimeter_corrected_area(column, grid) == pytest.approx(0.2 * (4 - faces * FACE), rel=1e-15)


@pytest.mark.parametrize(("M", "N"), [(400, 400), (300, 450)])
def test_what_the_correction_subtracts_of_a_disc(M: int, N: int) -> None:
    """Whatever its position, a disc of radius r has 4 r / dy faces along x and 4 r / dx along y; 1 % is the
    grid's."""
    radius, grid = 0.37, Grid((M, N), (1.0, 1.0))
    dx, dy = grid.spacings
    shifts = (np.arange(8) + 0.5) / 8 - 0.5
    excess = []
    for s in shifts:
        for t in shifts:
            inside = np.hypot(grid.x[:, None] - 0.5 - s * dx, grid.y[None, :] - 0.5 - t * dy) < radius
            taken = contact_area(inside, grid) - perimeter_corrected_area(inside, grid)
            excess.append(taken / (4 * radius * (dx + dy)))
    assert np.mean(excess) == pytest.approx(FACE, rel=0.01)


def test_the_friction_coefficient_is_the_force_over_the_load() -> None:
    assert friction_coefficient(7.0, 70.0) == pytest.approx(0.1, rel=1e-15)
    assert math.isnan(friction_coefficient(0.0, 0.0))
