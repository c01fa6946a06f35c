"""First order in the slope: facet tractions on planes along an axis and askew, and the slopes it states."""

from __future__ import annotations

import math

import numpy as np
import pytest

from appendix_a.facet import facet_coefficient, neighbours
from appendix_a.fem3d.patch import tilted_plane
from appendix_a.leading_order import facet_prediction, first_order, plane_slope, slope_of_error

OFFSETS = np.array([-20.0, -2.0, -0.5, 0.3, 2.0, 6.0])


@pytest.mark.parametrize("nu", [0.0, 0.3])
def test_facet_tractions_are_exact_on_a_plane_slope(nu):
    for slope in (1.0, 10.0, 40.0):
        # two closed forms of a dozen operations on numbers below 10
        exact = plane_slope(OFFSETS, nu, slope)
        assert facet_prediction(OFFSETS, nu, slope) == pytest.approx(exact, abs=1e-13)


def test_first_order_is_the_plane_slope_s_derivative():
    nu, step = 0.3, 1e-4
    slope = np.degrees(np.arctan(step))
    slopes = [plane_slope(OFFSETS, nu, s) for s in (slope, -slope)]
    derivative = (slopes[0] - slopes[1]) / (2 * step)
    # central difference: error of the order step^2 = 1e-8
    assert first_order(lambda x: x, OFFSETS, nu) == pytest.approx(derivative, abs=1e-7)


def at(tan_x: float, tan_y: float, nu: float, offset: tuple[int, int]) -> float:
    return float(facet_coefficient(np.array([tan_x]), np.array([tan_y]), nu, offset)[0])


@pytest.mark.parametrize("offset", neighbours(1))
@pytest.mark.parametrize("degrees", [6.5, 30.0])
def test_closed_form_of_a_plane_tilted_along_an_axis(offset: tuple[int, int], degrees: float) -> None:
    x, y = 2.0 * np.array([[offset[0]], [offset[1]]])
    slope = np.tan(np.radians(degrees))
    for nu in (0.0, 0.3):
        downhill_x = tilted_plane(x, y, nu, degrees, projected=True)[0]
        downhill_y = tilted_plane(y, x, nu, degrees, projected=True)[0]
        # 2e-7: the quadrature at the next element
        assert at(-slope, 0.0, nu, offset) == pytest.approx(downhill_x, rel=2e-7)
        assert at(0.0, -slope, nu, offset) == pytest.approx(downhill_y, rel=2e-7)


def test_tilted_askew_it_turns_with_the_axes() -> None:
    value = at(0.3, -0.2, 0.2, (1, 2))
    assert at(0.2, 0.3, 0.2, (-2, 1)) == pytest.approx(value, rel=1e-12)
    assert at(-0.3, 0.2, 0.2, (-1, -2)) == pytest.approx(value, rel=1e-12)
    assert at(-0.3, 0.2, 0.2, (1, 2)) != pytest.approx(value, rel=1e-2)


@pytest.mark.parametrize("offset", [0.5, 2.0])
def test_the_slope_of_two_per_cent_is_where_the_first_order_is(offset: float) -> None:
    """First order of a facet at that slope over the flat coefficient: 2 %."""
    slope = math.tan(math.radians(slope_of_error(offset, 0.3)))
    change = first_order(lambda x: slope * x, np.array([offset]), 0.3)[0]
    # the flat strip's displacement in closed form
    x = offset
    profile = (x + 1) * math.log(abs(x + 1)) - (x - 1) * math.log(abs(x - 1))
    flat = -2 * (1 - 0.3**2) / math.pi * profile
    assert abs(change / flat) == pytest.approx(0.02, rel=1e-9)
