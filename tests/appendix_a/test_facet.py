"""Coefficients on a tilted plane: against the closed forms, by symmetry, and their first order."""

from __future__ import annotations

import numpy as np
import pytest

from appendix_a.facet import facet_coefficient, neighbours
from appendix_a.fem3d.patch import normal_coefficient, tangential_coefficient, tilted_plane


def at(tan_x: float, tan_y: float, nu: float, offset: tuple[int, int]) -> float:
    return float(facet_coefficient(np.array([tan_x]), np.array([tan_y]), nu, offset)[0])


@pytest.mark.parametrize("offset", neighbours(2))
@pytest.mark.parametrize("degrees", [0.0, 6.5, 30.0])
def test_closed_form_of_a_plane_tilted_along_an_axis(offset: tuple[int, int], degrees: float) -> None:
    x, y = 2.0 * np.array([[offset[0]], [offset[1]]])
    slope = np.tan(np.radians(degrees))
    for nu in (0.0, 0.3, 0.5):
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


def test_first_order_is_the_facets_tangential_traction() -> None:
    """Central difference over a small tilt: its error is the third order, 1e-8 of the tilt."""
    x, y, tilt, nu = np.array([2.0]), np.array([-4.0]), 1e-4, 0.1
    rise = (at(tilt, 0.0, nu, (1, -2)) - at(-tilt, 0.0, nu, (1, -2))) / (2 * tilt)
    assert rise == pytest.approx(tangential_coefficient(x, y, nu)[0], rel=1e-6)
    assert at(0.0, 0.0, nu, (1, -2)) == pytest.approx(normal_coefficient(x, y, nu)[0], rel=1e-9)
