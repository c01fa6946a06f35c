"""Force sums against loops in exact rational arithmetic; areas against hand counts and discs."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest

from refimpl.model.forces import (
    facet_resultants,
    perimeter_corrected_area,
    plasticity_index,
    resultants,
    smooth_friction_coefficient,
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
@pytest.mark.parametrize("seed", range(5))
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


def test_printed_and_exact_differ_at_second_order():
    """Halving the slopes quarters the difference, at most."""
    f, r, at = rational_state()
    base = slopes_of(at)

    def difference(scale):
        slopes = Slopes(scale * base.tan_x, scale * base.tan_y)
        one, two = (g(f.astype(float), r.astype(float), slopes, 1.0) for g in (resultants, facet_resultants))
        return np.abs(np.array(one) - two)

    np.testing.assert_allclose(difference(1e-3) / difference(5e-4), [4, 4, 4], rtol=0.02)


def test_perimeter_of_hand_counted_sets():
    factor = (math.pi - 1 + math.log(2)) / 24
    one = np.zeros((4, 4), dtype=bool)
    one[1, 1] = True
    assert perimeter_corrected_area(contact=one, spacing=0.5) == pytest.approx(
        0.25 * (1 - 4 * factor), rel=1e-15
    )
    one[1, 2] = True
    assert perimeter_corrected_area(one, 0.5) == pytest.approx(0.25 * (2 - 6 * factor), rel=1e-15)
    for periodic in (False, True):  # all of a square: its border is straight, and known
        assert perimeter_corrected_area(np.ones((4, 4), dtype=bool), 0.5, periodic=periodic) == 4
    edge = np.zeros((4, 4), dtype=bool)
    edge[:, 0] = True
    for turned in range(4):
        border = np.rot90(edge, turned)
        assert perimeter_corrected_area(border, 0.5, periodic=True) == pytest.approx(1 - 8 * factor * 0.25)
    assert perimeter_corrected_area(np.zeros((4, 4), dtype=bool), 0.5) == 0


def test_what_the_correction_takes_off_a_disc():
    """Whatever its position on the grid, a disc of elements has edges of 8 r in all; 1 % is the grid's."""
    radius, M = 0.37, 400
    spacing = 1 / M
    shifts = (np.arange(8) + 0.5) / 8 - 0.5
    excess = []
    for dx in shifts:
        for dy in shifts:
            x = (np.arange(M) + 0.5) * spacing - 0.5
            inside = np.hypot(x[:, None] - dx * spacing, x[None, :] - dy * spacing) < radius
            raw = inside.sum() * spacing**2
            excess.append((raw - perimeter_corrected_area(inside, spacing)) / (8 * radius * spacing))
    assert np.mean(excess) == pytest.approx((math.pi - 1 + math.log(2)) / 24, rel=0.01)


def test_smooth_estimates():
    assert smooth_friction_coefficient(15e6, 0.08, 1e8) == pytest.approx(0.23)
    assert plasticity_index(1e11, 1e9, 1e-6, 1e-4) == pytest.approx(2.2)
