"""Force sums against loops in exact rational arithmetic; areas against hand counts and discs."""

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
    plasticity_index,
    resultants,
)
from refimpl.model.slopes import Slopes

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


def test_the_plasticity_index_is_eq_12() -> None:
    assert plasticity_index(1e11, 1e9, 1e-6, 1e-4) == pytest.approx(2.2)
