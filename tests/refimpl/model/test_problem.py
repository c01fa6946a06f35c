"""The discrete problem: slopes of surfaces, exact sums of forces, areas of contact."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest

from refimpl.grid import Grid
from refimpl.model.forces import (
    contact_area,
    facet_resultants,
    friction_coefficient,
    perimeter_corrected_area,
    resultants,
)
from refimpl.model.slopes import Slopes

OBLONG = Grid((9, 6), (2.25, 3.0))
DX = OBLONG.spacings[0]
X = OBLONG.x[:, None] * np.ones(OBLONG.shape)
Y = OBLONG.y[None, :] * np.ones(OBLONG.shape)


def test_central_differences_are_exact_on_quadratics_inside() -> None:
    slopes = Slopes.of_surface(heights=3 * X**2 + X * Y - 2 * Y, grid=OBLONG, direction=0.0)
    inside = (slice(1, -1), slice(1, -1))
    np.testing.assert_allclose(slopes.tan_x[inside], (6 * X + Y)[inside], atol=1e-13)
    np.testing.assert_allclose(slopes.tan_y[inside], (X - 2)[inside], atol=1e-13)


def test_periodic_differences_wrap() -> None:
    grid = Grid(OBLONG.shape, OBLONG.lengths, periodic=True)
    q = 2 * np.pi / grid.lengths[0]
    slopes = Slopes.of_surface(np.sin(q * X), grid, 0.0)
    np.testing.assert_allclose(slopes.tan_x, np.sin(q * DX) / DX * np.cos(q * X), atol=1e-14)
    np.testing.assert_allclose(slopes.tan_y, 0, atol=1e-15)


def test_the_mean_square_is_weighted() -> None:
    slopes = Slopes(np.array([[0.3, 0.0]]), np.array([[0.4, 0.1]]))
    assert slopes.mean_square(np.array([[3.0, 1.0]])) == pytest.approx((3 * 0.25 + 0.01) / 4, rel=1e-14)
    assert slopes.mean_square(np.zeros((1, 2))) == 0
    assert Slopes.flat((1, 2)).mean_square(np.ones((1, 2))) == 0


def test_distance_looks_only_where_asked() -> None:
    one, two = Slopes(np.zeros(3), np.zeros(3)), Slopes(np.array([0.0, 9.0, 0.2]), np.array([0.1, 9.0, 0.0]))
    assert one.distance(two, np.array([True, False, True])) == 0.2
    assert one.distance(two, np.array([False, False, False])) == 0
    assert one.distance(one, np.array([True, True, True])) == 0
    everywhere, flat = np.array([True, True, True]), Slopes.flat((3,))
    assert flat.distance(two, everywhere) == two.distance(flat, everywhere) == 9
    assert flat.distance(flat, everywhere) == 0


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


def test_the_friction_coefficient_is_the_force_over_the_load() -> None:
    assert friction_coefficient(7.0, 70.0) == pytest.approx(0.1, rel=1e-15)
    assert math.isnan(friction_coefficient(0.0, 0.0))
