"""The first-order formula against the exact plane slope, and the slopes it names."""

import numpy as np
import pytest

from appendix_a.leading_order import facet_prediction, first_order, plane_slope, slope_of_error

OFFSETS = np.array([-20.0, -2.0, -0.5, 0.3, 2.0, 6.0])


@pytest.mark.parametrize("nu", [0.0, 0.3, 0.5])
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


def test_an_incompressible_body_has_no_first_order_error():
    assert np.all(first_order(np.sin, OFFSETS, 0.5) == 0.0)


def test_slope_of_two_percent_is_where_the_antisymmetric_part_of_a_plane_slope_is_two_percent():
    for offset in (2.0, 4.0, 10.0):
        slope = slope_of_error(offset, 0.3)
        ahead, behind = plane_slope(np.array([offset, -offset]), 0.3, slope)
        flat = plane_slope(np.array([offset]), 0.3, 0.0)[0]
        # the formula's tan stands for sin: third order, below 0.011 relative at 8.4 degrees
        assert abs(ahead - behind) / 2 / abs(flat) == pytest.approx(0.02, rel=0.012)
