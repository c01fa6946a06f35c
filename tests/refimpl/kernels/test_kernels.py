"""Influence integrals: the accuracy cases, other points than theirs, tables, and refused input."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction

import numpy as np
import pytest

from refimpl.errors import InputError
from refimpl.kernels import normal_integral, normal_table, tables, tangential_integral, tangential_table
from refimpl.kernels.quadrature import (
    NEAR,
    ORDERS,
    TRUNCATION,
    order_for,
    reach,
    relative_error_bound,
    shells,
)
from verification.cases.kernels import kernels
from verification.exact import kernel_reference as reference
from verification.exact import textbook
from verification.exact.kernel_points import random_points

# Twice the error allowed to either; they differ in the order and the axis of quadrature.
SAME = 2 * kernels.TOLERANCE


@pytest.mark.parametrize(
    ("kernel", "exact"), [(normal_integral, reference.normal), (tangential_integral, reference.tangential)]
)
def test_other_seeds(kernel, exact):
    errors = [
        reference.relative_error(float(kernel(*p)), exact(*p)) for p in random_points(seed=7, count=300)
    ]
    assert max(errors) <= kernels.TOLERANCE


@pytest.mark.parametrize("length", [1e-12, 1e-9, 1.0, 1e12])
def test_any_unit_of_length(length):
    x, y = np.array([0.0, 0.3, 0.5, 2.0, 7.5, 1e6]), np.array([0.1, 0.5, 3.1, 0.0, 2e4, 1e6])
    for kernel in (normal_integral, tangential_integral):
        scaled = kernel(x * length, y * length, 2 * length, length)
        np.testing.assert_allclose(scaled, kernel(x, y, 2.0, 1.0) * length, rtol=SAME)


def test_textbook_form_fails_beside_the_axis_too():
    """Odd in x, so it cancels as x -> 0: eps / 1e-12 of it is wrong, and ours is not."""
    x, y = 1e-12, 0.3
    exact = reference.tangential(x, y, 1.0, 1.0)
    printed = textbook.tangential(np.array(x), np.array(y), 1.0, 1.0)
    assert reference.relative_error(float(printed), exact) > 1e-6
    assert reference.relative_error(float(tangential_integral(x, y, 1.0, 1.0)), exact) <= kernels.TOLERANCE


def test_exactly_zero_on_the_axis():
    y = np.array([0.0, 0.2, 0.5, 0.7, 2.9, 3.0, 1e3, 1e6])
    assert not tangential_integral(0.0, y, 1.0, 1.0).any()
    assert not tangential_integral(-0.0, y, 1e-3, 1.0).any()
    assert not tangential_table(5, 9, 1.0)[0].any()


def test_broadcasts_and_returns_float64():
    x, y = np.arange(3)[:, None], [0, 1]
    for kernel in (normal_integral, tangential_integral):
        assert kernel(x, y, 1, 1).shape == (3, 2)
        assert kernel(x, y, 1, 1).dtype == np.float64
        assert kernel(1, 2, 1, 1).shape == ()
        assert kernel(np.empty((0, 3)), 0.0, 1, 1).shape == (0, 3)


@pytest.mark.parametrize(
    ("n", "m"), [(1, 1), (2, 5), (3, 3), (3, 4), (40, 17), (17, 40), (99, 99), (300, 7), (7, 300)]
)
@pytest.mark.parametrize("aspect", [1.0, 0.3, 50.0])
def test_tables_are_the_integrals_on_the_grid(n, m, aspect):
    dx, dy = 0.7e-6, 0.7e-6 * aspect
    x, y = np.arange(n)[:, None] * dx, np.arange(m) * dy
    np.testing.assert_allclose(normal_table(n, m, dx, dy), normal_integral(x, y, dx, dy), rtol=SAME)
    np.testing.assert_allclose(tangential_table(n, m, dx, dy), tangential_integral(x, y, dx, dy), rtol=SAME)


def test_tables_of_square_elements():
    table = normal_table(200, 130, 0.1)
    np.testing.assert_array_equal(table, normal_table(130, 200, 0.1).T)
    np.testing.assert_array_equal(table, normal_table(200, 130, 0.1, 0.1))
    np.testing.assert_allclose(table, normal_table(200, 130, 0.1, 0.1 * (1 + 2**-52)), rtol=SAME)
    assert (tangential_table(40, 30, 0.1)[1:] > 0).all()


@pytest.mark.parametrize("order", [2, 5, 9])
@pytest.mark.parametrize("q", [6.0, 20.0, 1e4])
def test_the_bound_is_the_series_it_sums(order, q):
    """Even Chebyshev coefficients from 2n on, each at most ``2 max|f| rho^-k``, missed by ``32/15``."""
    kappa = order / (order + 1)
    rho = kappa * q + np.sqrt(kappa * q - 1) * np.sqrt(kappa * q + 1)
    largest, least = (1 + kappa) / (1 - kappa) ** 2, (1 - 1 / q) / (1 + 1 / q) ** 2
    series = sum(2 * largest * rho ** -(2.0 * (order + k)) * 32 / 15 for k in range(40))
    assert relative_error_bound(order, q) == pytest.approx(series / (2 * least), rel=1e-12)


def test_no_bound_where_the_ellipse_shrinks_to_the_segment():
    assert relative_error_bound(2, 1.5) == np.inf
    assert relative_error_bound(2, 1.6) < np.inf


@pytest.mark.parametrize("order", [order for order in ORDERS if reach(order) > NEAR])
def test_reach_is_where_the_bound_meets_the_truncation(order):
    assert relative_error_bound(order, reach(order)) <= TRUNCATION
    assert relative_error_bound(order, reach(order) * (1 - 2e-9)) > TRUNCATION


def test_orders_follow_the_bound():
    assert reach(max(ORDERS)) == NEAR
    for start, _, order in shells():
        assert relative_error_bound(order, start) <= TRUNCATION
        if order > min(ORDERS):
            assert relative_error_bound(order - 1, start) > TRUNCATION
    assert order_for(NEAR) == max(ORDERS)
    assert order_for(1e9) == min(ORDERS)


@pytest.mark.parametrize("kernel", [normal_integral, tangential_integral])
@pytest.mark.parametrize("edge", [0.0, -1.0, np.nan, np.inf, [1.0, 2.0], "a", None, 1j, [1.0]])
def test_refuses_edges(kernel, edge):
    with pytest.raises(InputError, match=r"^dx = "):
        kernel(1.0, 1.0, edge, 1.0)
    with pytest.raises(InputError, match=r"^dy = "):
        kernel(1.0, 1.0, 1.0, edge)


@pytest.mark.parametrize("kernel", [normal_integral, tangential_integral])
@pytest.mark.parametrize("offset", [np.nan, np.inf, [0.0, -np.inf], "a", 1j, None])
def test_refuses_offsets(kernel, offset):
    with pytest.raises(InputError, match=r"^x = "):
        kernel(offset, 1.0, 1.0, 1.0)
    with pytest.raises(InputError, match=r"^y = "):
        kernel(1.0, offset, 1.0, 1.0)


@pytest.mark.parametrize("table", [normal_table, tangential_table])
@pytest.mark.parametrize("count", [0, -3, 2.5, True])
def test_refuses_counts(table, count):
    with pytest.raises(InputError, match=r"^n = "):
        table(count, 4, 1.0)
    with pytest.raises(InputError, match=r"^m = "):
        table(4, count, 1.0)
    with pytest.raises(InputError, match=r"^dx = "):
        table(4, 4, -1.0)


def test_refuses_shapes_that_do_not_go_together():
    with pytest.raises(InputError, match=r"^y = \(2,\): expected a shape that goes with that of x, \(3,\)"):
        normal_integral([0.0, 1.0, 2.0], [0.0, 1.0], 1.0, 1.0)


def test_takes_edges_of_any_width():
    expected = normal_integral(1.0, 1.0, 2.0, 2.0)
    for edge in (np.array(2.0), np.float32(2.0), Fraction(2), 2):
        assert normal_integral(1.0, 1.0, edge, edge) == expected


def test_the_first_offset_that_is_refused_is_named():
    with pytest.raises(InputError) as refused:
        normal_integral([0.0, np.inf, -np.inf], 0.0, 1.0, 1.0)
    assert refused.value.value == np.inf


@pytest.mark.parametrize("known", [3, 47, 64, 107, 108])
def test_known_values_are_not_computed_again(known: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """By whole slabs: a slab that ends beyond the known part starts where it starts in any table."""
    slabs: list[tuple[int, int]] = []
    across = tables.across

    def recorded(
        inner: object, outer: np.ndarray, other: np.ndarray, edge: float, *rest: object
    ) -> np.ndarray:
        slabs.append((round(outer.min() / edge), round(outer.max() / edge)))
        return across(inner, outer, other, edge, *rest)

    monkeypatch.setattr(tables, "across", recorded)
    first = normal_table(known, known, 1.0, 1.5)
    slabs.clear()
    whole = normal_table(108, 108, 1.0, 1.5)
    every = slabs.copy()
    slabs.clear()
    assert np.array_equal(normal_table(108, 108, 1.0, 1.5, known=first), whole)
    assert slabs == [slab for slab in every if slab[1] >= known]


@pytest.mark.parametrize("table", [normal_table, tangential_table])
@pytest.mark.parametrize("steps", [(1, 40), (3, 4, 5, 9), (40, 41, 150), (7, 300)])
def test_a_grown_table_is_the_same_to_the_last_bit(
    table: Callable[..., np.ndarray], steps: tuple[int, ...]
) -> None:
    grown = None
    for n in steps:
        grown = table(n, n, 1.0, known=grown)
    assert np.array_equal(grown, table(steps[-1], steps[-1], 1.0))
