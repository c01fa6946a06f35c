"""The discrete problem: slopes of surfaces and areas of contact."""

from __future__ import annotations

import math

import numpy as np
import pytest

from refimpl.grid import Grid
from refimpl.model.forces import contact_area, perimeter_corrected_area
from refimpl.model.slopes import Slopes

OBLONG = Grid((9, 6), (2.25, 3.0))
X = OBLONG.x[:, None] * np.ones(OBLONG.shape)
Y = OBLONG.y[None, :] * np.ones(OBLONG.shape)


def test_central_differences_are_exact_on_quadratics_inside() -> None:
    slopes = Slopes.of_surface(heights=3 * X**2 + X * Y - 2 * Y, grid=OBLONG, direction=0.0)
    inside = (slice(1, -1), slice(1, -1))
    np.testing.assert_allclose(slopes.tan_x[inside], (6 * X + Y)[inside], atol=1e-13)
    np.testing.assert_allclose(slopes.tan_y[inside], (X - 2)[inside], atol=1e-13)


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
