"""Slopes of the common surface: exact on quadratics, signs and directions."""

from __future__ import annotations

import math

import numpy as np
import pytest

from refimpl.grid import Grid, Window
from refimpl.model.slopes import Slopes

GRID = Grid((9, 6), (2.25, 3.0))
DX = GRID.spacings[0]
X = GRID.x[:, None] * np.ones(GRID.shape)
Y = GRID.y[None, :] * np.ones(GRID.shape)


def test_central_differences_are_exact_on_quadratics_inside() -> None:
    slopes = Slopes.of_surface(heights=3 * X**2 + X * Y - 2 * Y, grid=GRID, direction=0.0)
    inside = (slice(1, -1), slice(1, -1))
    np.testing.assert_allclose(slopes.tan_x[inside], (6 * X + Y)[inside], atol=1e-13)
    np.testing.assert_allclose(slopes.tan_y[inside], (X - 2)[inside], atol=1e-13)


@pytest.mark.parametrize("angle", [0.0, 0.7, 2.0, -3.0])
def test_directions_of_a_plane(angle: float) -> None:
    """Uphill along sliding is positive; theta_y looks 90 degrees anticlockwise."""
    slopes = Slopes.of_surface(0.3 * X - 0.2 * Y, GRID, angle)
    cos, sin = math.cos(angle), math.sin(angle)
    np.testing.assert_allclose(slopes.tan_x, 0.3 * cos - 0.2 * sin, atol=1e-15)
    np.testing.assert_allclose(slopes.tan_y, -0.3 * sin - 0.2 * cos, atol=1e-15)


def test_periodic_differences_wrap() -> None:
    grid = Grid(GRID.shape, GRID.lengths, periodic=True)
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


def test_a_flat_holds_no_array_and_stays_flat_on_the_whole_grid() -> None:
    flat = Slopes.flat((3, 4))
    for values in (flat.tan_x, flat.sin_x, flat.cos_x, flat.sin_y, flat.cos_y, flat.cosine_product):
        assert values.shape == (3, 4)
        assert not any(values.strides)
    assert np.all(flat.cosine_product == 1)
    assert np.all(flat.sin_y == 0)
    assert np.all(flat.sin_x == 0)
    whole = flat.spread(Window(1, 4, 0, 4), Grid((5, 7), (1.0, 1.0)))
    assert whole.tan_x.shape == (5, 7)
    assert not any(whole.tan_x.strides)


def test_slopes_of_a_window_are_zero_elsewhere() -> None:
    tilted = Slopes(np.ones((2, 2)), np.full((2, 2), 2.0))
    whole = tilted.spread(Window(1, 3, 0, 2), Grid((4, 3), (1.0, 1.0)))
    assert whole.tan_x.sum() == 4
    assert np.all(whole.tan_y[1:3, :2] == 2)
    assert np.all(whole.cos_x[0] == 1)
