"""Influence integrals: accuracy, tables, refused input, and properties that hold whatever the formula."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from refimpl.errors import InputError
from refimpl.kernels import normal_integral, normal_table, tangential_integral, tangential_table
from verification.cases.kernels import kernels

# Twice the error allowed to either; they differ in the order and the axis of quadrature.
SAME = 2 * kernels.TOLERANCE


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


def test_tables_of_square_elements():
    table = normal_table(200, 130, 0.1)
    np.testing.assert_array_equal(table, normal_table(130, 200, 0.1).T)
    np.testing.assert_array_equal(table, normal_table(200, 130, 0.1, 0.1))
    np.testing.assert_allclose(table, normal_table(200, 130, 0.1, 0.1 * (1 + 2**-52)), rtol=SAME)
    assert (tangential_table(40, 30, 0.1)[1:] > 0).all()


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


KERNELS = pytest.mark.parametrize("kernel", [normal_integral, tangential_integral])
aspects = st.floats(-3, 3).map(lambda power: 10.0**power)
offsets = st.one_of(
    st.floats(0, 4).map(lambda x: x if x > 1e-200 else 0.0),  # scaled results stay normal numbers
    st.floats(0, 6).map(lambda power: 10.0**power),
    st.integers(0, 10).map(lambda k: k / 2),
)


@KERNELS
@given(offsets, offsets, aspects)
def test_parity(kernel, x, y, dy):
    """Even in y; in x even for the normal kernel, odd for the tangential one; exactly so."""
    value = kernel(x, y * dy, 1.0, dy)
    assert kernel(x, -y * dy, 1.0, dy) == value
    assert kernel(-x, y * dy, 1.0, dy) == (value if kernel is normal_integral else -value)
