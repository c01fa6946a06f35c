"""Slopes of the common surface: exact on quadratics, signs and directions."""

from __future__ import annotations

import math

import numpy as np
import pytest

from refimpl.grid import differences
from refimpl.grid.window import Window
from refimpl.model.slopes import Slopes

M, H = 9, 0.25
X = (np.arange(M) * H)[:, None] * np.ones(M)
Y = X.T


def test_central_differences_are_exact_on_quadratics_inside() -> None:
    slopes = Slopes.of_surface(heights=3 * X**2 + X * Y - 2 * Y, spacing=H, direction=0.0)
    inside = (slice(1, -1), slice(1, -1))
    np.testing.assert_allclose(slopes.tan_x[inside], (6 * X + Y)[inside], atol=1e-13)
    np.testing.assert_allclose(slopes.tan_y[inside], (X - 2)[inside], atol=1e-13)


def test_one_sided_at_the_border() -> None:
    slopes = Slopes.of_surface(X**2, H, 0.0)
    np.testing.assert_allclose(slopes.tan_x[0], H)
    np.testing.assert_allclose(slopes.tan_x[-1], (2 * M - 3) * H)


@pytest.mark.parametrize("angle", [0.0, 0.7, 2.0, -3.0])
def test_directions_of_a_plane(angle: float) -> None:
    """Uphill along sliding is positive; theta_y looks 90 degrees anticlockwise."""
    slopes = Slopes.of_surface(0.3 * X - 0.2 * Y, H, angle)
    cos, sin = math.cos(angle), math.sin(angle)
    np.testing.assert_allclose(slopes.tan_x, 0.3 * cos - 0.2 * sin, atol=1e-15)
    np.testing.assert_allclose(slopes.tan_y, -0.3 * sin - 0.2 * cos, atol=1e-15)


def test_periodic_differences_wrap() -> None:
    wave = np.sin(2 * np.pi * np.arange(M) / M)[:, None] * np.ones(M)
    slopes = Slopes.of_surface(wave, H, 0.0, periodic=True)
    q = 2 * np.pi / M
    exact = np.sin(q) / H * np.cos(q * np.arange(M))[:, None] * np.ones(M)  # symbol of central differences
    np.testing.assert_allclose(slopes.tan_x, exact, atol=1e-14)
    np.testing.assert_allclose(slopes.tan_y, 0, atol=1e-15)


def test_two_elements_that_repeat_have_no_slope() -> None:
    """Either is its neighbour's neighbour on both sides; alone, one is above the other."""
    step = np.array([[0.0], [1.0]])
    assert Slopes.of_surface(step, H, 0.0, periodic=True).tan_x.tolist() == [[0.0], [0.0]]
    assert np.all(Slopes.of_surface(step, H, 0.0).tan_x > 0)


def test_cosines_and_sines_are_those_of_the_angles() -> None:
    slopes = Slopes(np.array([-2.0, 0.0, 0.1]), np.array([0.5, -1e-9, 3.0]))
    theta_x, theta_y = np.arctan(slopes.tan_x), np.arctan(slopes.tan_y)
    np.testing.assert_allclose(slopes.cos_x, np.cos(theta_x), rtol=1e-15)
    np.testing.assert_allclose(slopes.sin_x, np.sin(theta_x), rtol=1e-15)
    np.testing.assert_allclose(slopes.cos_y, np.cos(theta_y), rtol=1e-15)
    np.testing.assert_allclose(slopes.sin_y, np.sin(theta_y), rtol=1e-15)
    np.testing.assert_allclose(slopes.obliqueness, np.cos(theta_x) * np.cos(theta_y), rtol=1e-15)


def test_flat_slopes_leave_everything_as_it_is() -> None:
    flat = Slopes.flat((2, 3))
    assert np.all(flat.obliqueness == 1)
    assert np.all(flat.sin_x == 0)


def test_a_single_element_has_no_slope() -> None:
    assert Slopes.of_surface(np.array([[5.0]]), H, 0.3).tan_x == 0


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
    for values in (flat.tan_x, flat.sin_x, flat.cos_x, flat.sin_y, flat.cos_y, flat.obliqueness):
        assert values.shape == (3, 4)
        assert not any(values.strides)
    assert np.all(flat.obliqueness == 1)
    assert np.all(flat.sin_y == 0)
    whole = flat.spread(Window(1, 4, 0, 4), 5)
    assert whole.tan_x.shape == (5, 5)
    assert not any(whole.tan_x.strides)


def test_slopes_of_a_window_are_zero_elsewhere() -> None:
    tilted = Slopes(np.ones((2, 2)), np.full((2, 2), 2.0))
    whole = tilted.spread(Window(1, 3, 0, 2), 4)
    assert whole.tan_x.sum() == 4
    assert np.all(whole.tan_y[1:3, :2] == 2)
    assert np.all(whole.cos_x[0] == 1)


def test_slopes_cannot_be_changed() -> None:
    """What follows from them is computed once."""
    slopes = Slopes(np.ones(3), np.zeros(3))
    for name in ("tan_x", "tan_y"):
        with pytest.raises(AttributeError, match="cannot assign"):
            setattr(slopes, name, np.zeros(3))


@pytest.mark.parametrize("shape", [(2, 3), (3, 2), (7, 11), (40, 1)])
@pytest.mark.parametrize("turned", [False, True])
def test_differences_are_numpys_to_the_last_bit(shape: tuple[int, int], turned: bool) -> None:
    values = np.random.default_rng(3).normal(size=shape)
    values = values.T if turned else values
    for axis in (0, 1):
        expected = np.gradient(values, axis=axis) if values.shape[axis] > 1 else np.zeros(values.shape)
        np.testing.assert_array_equal(differences(values, axis), expected)
