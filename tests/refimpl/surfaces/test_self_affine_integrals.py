"""Self-affine roughness: integrals over its spectrum, by another quadrature or by surfaces drawn.

Moments, mean squares, and what differences over a spacing do not see of slopes and curvature.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import j0

import refimpl as rf
from refimpl.grid import Grid
from tests.refimpl.surfaces.test_self_affine import SIDE, rough, shape


@pytest.mark.parametrize("hurst", [0.3, 0.8, 1.0])
@pytest.mark.parametrize("roll_off", [2e-4, 5e-4])
def test_moments_are_the_integrals_of_the_psd(hurst: float, roll_off: float) -> None:
    surface = rough(hurst=hurst, roll_off=roll_off, anisotropy=2.0, lay=0.4)
    ends = [2 * math.pi / wave for wave in (5e-4, 2e-4, 2e-5)]
    for order in (0, 2, 4):
        exact = sum(
            quad(lambda q, n=order: q ** (n + 1) * float(shape(np.array(q), vars(surface))), a, b, epsabs=0)[
                0
            ]
            for a, b in pairwise(ends)
        )
        assert surface.moment(order) == pytest.approx(exact / (2 * math.pi), rel=1e-9)
    # over the plane of the stretched PSD, with q_along = q cos t / g and dq_along = d(...) / g
    height = surface.moment(0) / 2.0
    gradient = surface.moment(2) / 2.0 * 0.5 * (1 / 4 + 1)
    assert surface.rms_gradient == pytest.approx(1e-6 * math.sqrt(gradient / height), rel=1e-12)
    along_x = 0.5 * surface.moment(2) / 2.0 * (math.cos(0.4) ** 2 / 4 + math.sin(0.4) ** 2)
    assert surface.rms_slope == pytest.approx(1e-6 * math.sqrt(along_x / height), rel=1e-12)
    plateau = surface.psd(np.array([2 * math.pi / 5e-4]))[0]
    assert plateau * height == pytest.approx(1e-12)
    assert rough(hurst=hurst, roll_off=roll_off).nayak > 1.5


def test_either_size_gives_the_same_shape() -> None:
    grid = Grid.square(SIDE, 64, periodic=True)
    by_height = rough(anisotropy=2.0, lay=0.3)
    by_gradient = rough(anisotropy=2.0, lay=0.3, rms_gradient=by_height.rms_gradient)
    assert by_gradient.rms == pytest.approx(by_height.rms, rel=1e-14)
    assert (by_height.given, by_gradient.given) == ("rms", "rms_gradient")
    ratio = by_gradient.sample(grid) / by_height.sample(grid)
    np.testing.assert_allclose(ratio, ratio[0, 0], rtol=1e-9)
    assert ratio[0, 0] == pytest.approx(1.0, abs=0.05)  # waves there are against the integral
    double = rough(rms=2e-6).sample(grid)
    np.testing.assert_allclose(double, 2 * rough().sample(grid), rtol=1e-12)


@pytest.mark.parametrize("spacing", [2e-6, 9e-6])
def test_what_differences_miss_is_that_of_an_integral_over_wavenumbers(spacing: float) -> None:
    """``(1 - J0(2 q h)) / (2 h^2)`` for ``q^2 / 2`` and so on, under the PSD, by scipy's quadrature."""
    surface = rf.SelfAffineRoughness(
        rms=1e-6, hurst=0.7, roll_off=2e-4, long_cut=4e-4, short_cut=4e-5, seed=1
    )

    def integral(weight: Callable[[float], float]) -> float:
        def both(q: float) -> float:
            shape = min(1.0, (q * 2e-4 / (2 * math.pi)) ** -3.4)
            return shape * q * weight(q)

        ends = [2 * math.pi / wave for wave in (4e-4, 2e-4, 4e-5)]
        return sum(quad(both, *pair, limit=400, epsabs=0, epsrel=1e-10)[0] for pair in pairwise(ends))

    h = spacing
    seen = integral(lambda q: (1 - j0(2 * q * h)) / (2 * h**2)) / integral(lambda q: q**2 / 2)
    bends = integral(lambda q: (6 - 8 * j0(q * h) + 2 * j0(2 * q * h)) / h**4)
    bent = bends / integral(lambda q: 3 * q**4 / 8)
    assert surface.missed(spacing) == pytest.approx((1 - math.sqrt(seen), 1 - math.sqrt(bent)), rel=1e-7)
