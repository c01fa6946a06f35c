"""Multipoles of square elements: exact moments, bounds, and the same integrals as in closed form."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

from refimpl.kernels import multipole, normal_integral, tangential_integral
from refimpl.kernels.quadrature import TRUNCATION

SERIES = {"normal": multipole.LOVE, "tangential": multipole.CERRUTI}
INTEGRAL = {"normal": normal_integral, "tangential": tangential_integral}


@pytest.mark.parametrize(("n", "m"), [(0, 0), (2, 0), (4, 0), (4, 4), (6, 4), (8, 8), (12, 4), (14, 12)])
def test_moments_are_means_over_the_square(n, m):
    nodes, weights = np.polynomial.legendre.leggauss(12)
    zeta = nodes[:, None] / 2 + 0.5j * nodes
    mean = np.sum(weights[:, None] * weights * np.abs(zeta) ** (n - m) * (zeta**m).real) / 4
    assert float(multipole.moment(n, m)) == pytest.approx(mean, rel=1e-13)


@pytest.mark.parametrize(("n", "m"), [(2, 2), (6, 2), (6, 6), (10, 6)])
def test_a_square_has_no_other_moments(n, m):
    assert multipole.moment(n, m) == 0


@pytest.mark.parametrize("n", range(0, 16, 2))
def test_moments_fall_by_the_half_diagonal_squared(n):
    assert 0 < multipole.moment(n + 2) <= Fraction(1, 2) * multipole.moment(n)
    assert all(abs(multipole.moment(n, m)) <= multipole.moment(n) for m in range(0, n + 1, 4))


@pytest.mark.parametrize("kernel", SERIES)
@pytest.mark.parametrize("distance", [multipole.FAR, 13, 50, 1000, 100_000])
def test_as_few_terms_as_suffice(kernel, distance):
    terms = multipole.terms_from(SERIES[kernel], distance)
    assert SERIES[kernel].remainder(terms, distance) <= TRUNCATION
    assert terms == 1 or SERIES[kernel].remainder(terms - 1, distance) > TRUNCATION


def test_a_remainder_is_relative_to_the_least_that_the_whole_can_be():
    """Of a first term 1 that lacks up to a half, the whole is at least a half; what two terms lack is 0.1."""
    expansion = multipole.Expansion(sum=None, lacking=lambda terms, u: {1: 0.5, 2: 0.1}[terms])
    assert expansion.remainder(2, 10.0) == 0.2


@pytest.mark.parametrize("terms", range(1, multipole.MOST + 1))
def test_bounds_are_tails_of_their_terms_bounds(terms):
    """At u = 0.1 they close the geometric series that is above the tail by a few per cent."""
    n, u = range(terms, terms + 12), 0.1
    love = sum(float(multipole.moment(2 * k)) * u**k for k in n)
    cerruti = sum((4 * k + 1) * float(multipole.moment(4 * k)) * u ** (2 * k) for k in n)
    assert love <= multipole.LOVE.lacking(terms, u) <= 1.03 * love
    assert cerruti <= multipole.CERRUTI.lacking(terms, u) <= 1.005 * cerruti


@pytest.mark.parametrize("terms", range(1, multipole.MOST + 1))
def test_bounds_are_as_tight_as_their_terms(terms):
    """From afar one term counts: ``|P_n| <= 1``, and ``|cos((4j + 1) phi)| <= (4j + 1) |cos(phi)|``."""
    u = 1e-6
    love, cerruti = float(multipole.moment(2 * terms)), float(multipole.moment(4 * terms))
    assert multipole.LOVE.lacking(terms, u) == pytest.approx(love * u**terms, rel=1e-5, abs=0)
    assert multipole.CERRUTI.lacking(terms, u) == pytest.approx(
        (4 * terms + 1) * cerruti * u ** (2 * terms), rel=1e-5, abs=0
    )


@pytest.mark.parametrize("kernel", SERIES)
@pytest.mark.parametrize("distance", [multipole.FAR, 31, 400])
def test_the_same_integrals(kernel, distance):
    """Either side may round a few times: 16 eps."""
    near = np.arange(3.0 * distance)
    x, y = np.arange(distance, 2.0 * distance)[:, None], near
    found = SERIES[kernel].across(x, y, 0.25, distance)
    np.testing.assert_allclose(found, INTEGRAL[kernel](x / 4, y / 4, 0.25, 0.25), rtol=4e-15)
    x, y = near[:, None], x.ravel()
    turned = SERIES[kernel].across(x, y, 0.25, distance)
    np.testing.assert_allclose(turned, INTEGRAL[kernel](x / 4, y / 4, 0.25, 0.25), rtol=4e-15)


@pytest.mark.parametrize("terms", range(1, multipole.MOST))
@pytest.mark.parametrize("u", [1e-4, 0.02, 0.5])
def test_the_bound_is_over_the_series_it_sums_and_not_far(terms, u):
    following = range(terms, terms + 30)
    love = sum(float(multipole.moment(2 * k)) * u**k for k in following)
    cerruti = sum((4 * j + 1) * float(multipole.moment(4 * j)) * u ** (2 * j) for j in following)
    for series, rest in ((multipole.LOVE, love), (multipole.CERRUTI, cerruti)):
        assert rest * (1 - 1e-12) <= series.lacking(terms, u) <= 1.4 * rest
