"""The grid of a rectangle, its windows, and fields on it: differences, sums, interpolation."""

from __future__ import annotations

import math

import numpy as np
import pytest

from refimpl.errors import InputError
from refimpl.grid import Grid, Window, differences, inner, resampled, second_differences

FREE, PERIODIC = Grid((7, 4), (1.4, 2.0)), Grid((7, 4), (1.4, 2.0), periodic=True)


def test_sizes_of_a_rectangle() -> None:
    assert FREE.spacings == pytest.approx((0.2, 0.5), rel=1e-15)
    assert FREE.element_size == pytest.approx(math.sqrt(0.1), rel=1e-15)
    assert FREE.size == pytest.approx(math.sqrt(2.8), rel=1e-15)
    assert FREE.nominal_area == pytest.approx(2.8, rel=1e-15)
    assert FREE.aspect == pytest.approx(2.5, rel=1e-15)


@pytest.mark.parametrize("shape", [(0, 3), (3, -1), (3, 2.0), (True, 3), ("3", 3)])
def test_counts_must_be_whole_and_positive(shape: tuple[int, int]) -> None:
    with pytest.raises(InputError, match=r"^grid = "):
        Grid(shape, (1.0, 1.0))


@pytest.mark.parametrize("lengths", [(0.0, 1.0), (1.0, -1.0), (1.0, math.inf), (math.nan, 1.0)])
def test_lengths_must_be_positive(lengths: tuple[float, float]) -> None:
    with pytest.raises(InputError, match=r"^side = "):
        Grid((3, 3), lengths)


# Lengths and counts whose quotients differ by rounding: 0.3 / 3 is not 0.1.
@pytest.mark.parametrize(
    ("shape", "lengths"), [((3, 2), (0.3, 0.2)), ((7, 49), (0.1, 0.7)), ((5, 5), (0.1, 0.1))]
)
def test_elements_that_are_square_to_rounding_have_the_aspect_one(
    shape: tuple[int, int], lengths: tuple[float, float]
) -> None:
    assert Grid(shape, lengths).aspect == 1.0


@pytest.mark.parametrize("grid", [FREE, PERIODIC, Grid((60, 5), (1.0, 3.0)), Grid((7, 1), (2.0, 0.1))])
def test_the_gradient_of_a_plane(grid: Grid) -> None:
    """Exact on a free grid; a periodic one sees the jump at its border, and only there."""
    along_x, along_y = grid.gradient(0.3 * grid.x[:, None] - 0.2 * grid.y[None, :])
    inside = np.s_[1:-1, 1:-1] if grid.periodic else np.s_[:, :]
    np.testing.assert_allclose(along_x[inside], 0.3, rtol=1e-12)
    # one element has no neighbour: no slope along that axis
    np.testing.assert_allclose(along_y[inside], -0.2 if grid.shape[1] > 1 else 0.0, rtol=1e-12)


def marked(*elements: tuple[int, int]) -> np.ndarray:
    found = np.zeros(FREE.shape, dtype=bool)
    for element in elements:
        found[element] = True
    return found


@pytest.mark.parametrize(
    ("contact", "free", "periodic"),
    [
        (marked(), 0, 0),
        (marked((3, 1)), 4, 4),
        (marked((3, 1), (3, 2)), 6, 6),
        (marked((3, 1), (4, 2)), 8, 8),  # corners share no face
        (marked((0, 1)), 3, 4),
        (marked((0, 0)), 2, 4),
        (marked((0, 1), (6, 1)), 6, 6),  # opposite elements touch where the grid repeats
        (marked(*((i, 0) for i in range(7))), 7, 14),  # a full column
        (marked(*((0, j) for j in range(4))), 4, 8),  # a full row
        (np.ones((7, 4), dtype=bool), 0, 0),
    ],
)
def test_faces_by_hand(contact: np.ndarray, free: int, periodic: int) -> None:
    assert (FREE.faces(contact), PERIODIC.faces(contact)) == (free, periodic)


def test_elements_on_the_border() -> None:
    everything = np.ones((7, 4), dtype=bool)
    assert FREE.on_border(everything) == 28 - 5 * 2
    assert FREE.on_border(marked((0, 0), (3, 1), (6, 2), (3, 3))) == 3
    assert PERIODIC.on_border(everything) == FREE.on_border(marked()) == 0
    assert Grid((7, 1), (7.0, 1.0)).on_border(np.ones((7, 1), dtype=bool)) == 7


def test_windows_around_a_contact() -> None:
    contact = marked((2, 1), (4, 2))
    assert FREE.window_around(contact, 0) == Window(2, 5, 1, 3)
    assert FREE.window_around(contact, 2) == Window(0, 7, 0, 4)
    assert FREE.window_around(marked(), 2) == FREE.window
    assert PERIODIC.window_around(contact, 0) == PERIODIC.window == Window(0, 7, 0, 4)


def test_weights_heights_and_frames_where_a_grid_ends_and_where_it_repeats() -> None:
    """Bells sin^2(pi k / (n + 1)): of two elements 3/4 and 3/4, of three 1/2, 1 and 1/2."""
    free, periodic = (Grid((3, 2), (3.0, 1.0), repeats) for repeats in (False, True))
    np.testing.assert_allclose(free.taper, 0.75 * np.array([[0.5, 0.5], [1, 1], [0.5, 0.5]]), rtol=1e-14)
    assert (periodic.taper == 1).all()
    z, weights = np.arange(6.0).reshape(3, 2), np.array([[0.0, 0], [0, 1], [0, 3]])  # (3 + 3 * 5) / 4
    assert (free.about_datum(z, weights)[0, 0], periodic.about_datum(z, weights)[0, 0]) == (-4.5, -2.5)
    assert free.about_datum(z, 0 * weights)[0, 0] == -2.5
    assert (free.padded(z, 1)[0].tolist(), periodic.padded(z, 1)[0].tolist()) == ([0, 0, 1, 1], [5, 4, 5, 4])
    assert (free.transform_shape, periodic.transform_shape) == ((6, 4), (3, 2))


def test_values_on_the_grid() -> None:
    window = Window(2, 4, 1, 3)
    assert window.shape == (2, 2)
    spread = window.spread(np.array([[1.0, 2.0], [3.0, 4.0]]), (5, 3))
    np.testing.assert_array_equal(spread[window.slices], [[1, 2], [3, 4]])
    assert spread.sum() == 10
    assert np.argwhere(window.mask((5, 3))).tolist() == [[2, 1], [2, 2], [3, 1], [3, 2]]


def test_a_window_is_filled_as_far_as_its_transform_costs_no_more() -> None:
    """Of n elements 2 n - 1 offsets are padded to a fast even length."""
    assert Window(2, 4, 1, 5).filling((6, 6)) == Window(2, 4, 1, 5)  # 3 and 7 are padded to 4 and 8
    assert Window(20, 37, 60, 64).filling((64, 64)) == Window(20, 38, 60, 64)  # 33 to 36: room for 18
    # eleven elements are padded to 24 points, which hold twelve; the twelfth lies on the inner side
    assert Window(13, 24, 0, 11).filling((24, 24)) == Window(12, 24, 0, 12)
    assert Window(6, 17, 6, 17).filling((24, 24)).shape == (12, 12)
    assert Window(0, 11, 2, 13).filling((11, 24)) == Window(0, 11, 2, 14)  # no further than the grid


def test_the_interior_is_without_edges_that_are_not_the_grids() -> None:
    assert Window(2, 5, 0, 6).interior((6, 6)) == Window(3, 4, 0, 6)
    assert Window(0, 6, 2, 5).interior((6, 6)) == Window(0, 6, 3, 4)
    assert Window.full((6, 4)).interior((6, 4)) == Window.full((6, 4))


@pytest.mark.parametrize(
    ("window", "inside"),
    [
        (Window(2, 5, 1, 5), np.s_[1:2, 1:3]),
        (Window(0, 3, 1, 5), np.s_[0:2, 1:3]),  # the grid's edge is no edge of the window
        (Window(3, 6, 2, 7), np.s_[1:3, 1:5]),
        (Window.full((6, 7)), np.s_[0:6, 0:7]),
    ],
)
def test_elements_on_a_windows_edge(window: Window, inside: tuple[slice, slice]) -> None:
    edge = np.ones(window.shape, dtype=bool)
    edge[inside] = False
    for element in np.ndindex(window.shape):
        alone = np.zeros(window.shape, dtype=bool)
        alone[element] = True
        assert window.on_edge(alone, (6, 7)) is bool(edge[element])
        assert alone.sum() == 1  # the argument is not changed


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
