"""Strip on a wavy boundary: flat, to first order, by the paper's superposition."""

from __future__ import annotations

from typing import Any

import mpmath as mp
import numpy as np
import pytest

from appendix_a.fem.halfplane import pressed_strip
from appendix_a.strip import Theta, first_order, printed, superposition
from appendix_a.strip.field import flat_displacement
from appendix_a.strip.profile import Sinusoid


@pytest.mark.parametrize("sign", [1, -1])
def test_flat_displacement_is_accurate_at_any_distance(sign: int) -> None:
    """Against hundreds of digits: the two logarithms cancel both near the centre and far away."""
    sizes = [1e-150, 1e-9, 0.49, 0.5, 1 - 1e-15, 1.0, 1 + 1e-15, 2.0, 2.01, 1e4, 1e15, 1e16, 1e307]
    with mp.workdps(700):
        exact = [float(logs(mp.mpf(x)) * -2 / mp.pi) for x in sizes]
    np.testing.assert_allclose(flat_displacement(sign * np.array(sizes), 0.0), exact, rtol=2e-15)
    wide = pressed_strip(sign * 3 * np.array(sizes), 0.0, 3.0)
    np.testing.assert_allclose(wide, 3 * np.array(exact), rtol=3e-15)
    assert flat_displacement(0.0, 0.0) == 0


def logs(x: Any) -> Any:
    return (x + 1) * mp.log(x + 1) - ((x - 1) * mp.log(abs(x - 1)) if x != 1 else 0)


def test_profile() -> None:
    crest = Sinusoid(6.5, 100.0, 0.0)
    x = np.linspace(-70, 70, 29)
    np.testing.assert_allclose(crest.depth(x), 2 * crest.amplitude * np.sin(np.pi * x / 100) ** 2, atol=1e-14)
    assert crest.depth(50.0) == pytest.approx(2 * crest.amplitude)
    flank = Sinusoid(6.5, 100.0, 0.25)
    assert np.degrees(flank.slope(0.0)) == pytest.approx(6.5, rel=1e-14)
    assert flank.depth(1.0) > 0 > flank.depth(-1.0)  # +x is downhill


def test_first_order_by_hand() -> None:
    wavy, flat = first_order(2.0, 1e6, 0.25, 0.0, offsets=[-5.0, -0.5, 0.0, 0.5, 5.0])
    slope = np.tan(np.radians(2.0))
    np.testing.assert_allclose(wavy - flat, slope * np.array([1, 0.5, 0, -0.5, -1]), rtol=1e-9, atol=1e-15)


def test_flamant_superposition_of_a_uniform_strip() -> None:
    nu, x = 0.3, 2.5
    s, weights = superposition.graded_nodes([-1.0, 1.0, x, 0.0], 20.0)
    weights = np.where(np.abs(s) < 1, weights, 0)
    down = [superposition.flamant(at, s, 0 * s, weights, nu) for at in (x, 0.0)]
    assert down[0] - down[1] == pytest.approx(flat_displacement(x, nu), rel=1e-9)
    # a traction along +x on |s| < 1 pushes the boundary in ahead of it: Johnson 1985, Eq. (2.22)
    along = [superposition.flamant(at, s, weights, 0 * s, nu) for at in (x, 0.0)]
    assert along[0] - along[1] == pytest.approx((1 + nu) * (1 - 2 * nu), rel=1e-9)


def test_slope_as_theta_moves_even_a_flat_boundary() -> None:
    """Literally, (A3) asks for a shear traction p under the strip, worth (1+nu)(1-2nu) p a/E beside it."""
    literal, flat = printed(0.0, 100.0, 0.3, offsets=[-3.0, 3.0], theta=Theta.SLOPE)
    antisymmetric = (literal - flat)[1] - (literal - flat)[0]
    assert antisymmetric == pytest.approx(2 * 1.3 * 0.4, rel=1e-9)
