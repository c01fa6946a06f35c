"""Fields on a grid: sums, differences and interpolation, on rectangles of any shape."""

from __future__ import annotations

import numpy as np
import pytest

from refimpl.grid import differences, inner, resampled, second_differences

SHAPES = [(2, 3), (3, 2), (7, 11), (40, 1)]


def test_short_products_are_blas_and_long_ones_are_summed_by_row() -> None:
    """To the last bit: the sum of a long product in BLAS depends on its number of threads.

    Both sums of a single product may round alike, which depends on the processor: 20 products are compared.
    """
    draw = np.random.default_rng(2)
    for n, one in ((100, True), (150, False)):
        fields = draw.standard_normal((20, 2, n, n))
        whole = [float(np.vdot(a, b)) for a, b in fields]
        by_row = [float(np.vecdot(a, b).sum()) for a, b in fields]
        assert whole != by_row
        assert [inner(a, b) for a, b in fields] == (whole if one else by_row)


@pytest.mark.parametrize("shape", [(1, 10_001), (10_001, 1), (3, 20_000)])
def test_products_of_long_strips(shape: tuple[int, int]) -> None:
    a, b = np.random.default_rng(3).standard_normal((2, *shape))
    assert inner(a, b) == pytest.approx(float(np.sum(a * b)), abs=1e-12 * float(np.sum(np.abs(a * b))))


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("turned", [False, True])
def test_differences_are_numpys_to_the_last_bit(shape: tuple[int, int], turned: bool) -> None:
    values = np.random.default_rng(3).normal(size=shape)
    values = values.T if turned else values
    for axis in (0, 1):
        expected = np.gradient(values, axis=axis) if values.shape[axis] > 1 else np.zeros(values.shape)
        np.testing.assert_array_equal(differences(values, axis), expected)


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("axis", [0, 1])
def test_periodic_differences_take_neighbours_around_the_circle(shape: tuple[int, int], axis: int) -> None:
    z = np.random.default_rng(4).normal(size=shape)
    expected = 0.5 * (np.roll(z, -1, axis) - np.roll(z, 1, axis))
    np.testing.assert_array_equal(differences(z, axis, periodic=True), expected)


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("axis", [0, 1])
def test_second_differences(shape: tuple[int, int], axis: int) -> None:
    """Around the circle on a periodic grid; at a free border those of the neighbour inside."""
    z = np.random.default_rng(5).normal(size=shape)
    wrapped = np.roll(z, 1, axis) - 2 * z + np.roll(z, -1, axis)
    n = shape[axis]
    free, periodic = second_differences(z, axis), second_differences(z, axis, periodic=True)
    if n < 3:
        assert not free.any()
        assert not periodic.any()
        return
    inside = wrapped.take(np.clip(np.arange(n), 1, n - 2), axis)
    np.testing.assert_allclose(periodic, wrapped, rtol=0, atol=1e-14)
    np.testing.assert_allclose(free, inside, rtol=0, atol=1e-14)


RESAMPLINGS = [
    ((12, 12), (6, 6)),
    ((12, 10), (6, 20)),
    ((12, 7), (5, 16)),
    ((5, 8), (12, 3)),
    ((2, 9), (1, 9)),
    ((1, 4), (3, 2)),
    ((60, 5), (30, 9)),
]
"""Old and new shapes: halved (by means of pairs), finer, coarser, kept, and of one element."""


@pytest.mark.parametrize(("old", "new"), RESAMPLINGS)
def test_resampling_is_linear_interpolation_along_either_axis(
    old: tuple[int, int], new: tuple[int, int]
) -> None:
    """`np.interp` is constant beyond the outermost centres as well."""
    values = np.random.default_rng(8).normal(size=old)
    (x, y), (at_x, at_y) = (tuple((np.arange(n) + 0.5) / n for n in shape) for shape in (old, new))
    along_y = np.array([np.interp(at_y, y, row) for row in values])
    expected = np.array([np.interp(at_x, x, column) for column in along_y.T]).T
    found = resampled(values, new)
    assert found.shape == new
    assert found.flags.c_contiguous
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-14)
