"""Greenwood-Tripp, two-dimensional waviness, area-load laws: residuals, limits, tables regenerated."""

from __future__ import annotations

import dataclasses

import mpmath as mp
import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import ellipk

from refimpl.errors import InputError
from verification.exact import greenwood_tripp, jgh
from verification.exact.greenwood_tripp import RoughSphere, gaussian_summits, overlap_integral, solve


def sphere(rms: float = 0.511e-6) -> RoughSphere:
    return RoughSphere(70.0, 0.14, 81.6e9, *gaussian_summits(rms, 104e-6))


def test_summits_without_height_are_refused() -> None:
    with pytest.raises(InputError, match="summit_rms"):
        dataclasses.replace(sphere(), summit_rms=0.0)


@pytest.mark.parametrize(("z", "power"), [(-12.0, 1.5), (0.3, 1.5), (6.0, 0.5)])
def test_overlap_integral_by_parabolic_cylinder_function(z: float, power: float) -> None:
    """DLMF 12.5.1: Gamma(k + 1)/sqrt(2 pi) exp(-z^2/4) U(k + 1/2, z)."""
    expected = mp.gamma(power + 1) / mp.sqrt(2 * mp.pi) * mp.exp(-(z**2) / 4) * mp.pcfu(power + 0.5, z)
    assert float(overlap_integral(np.array([z]), power)[0]) == pytest.approx(float(expected), rel=1e-12)


@pytest.mark.parametrize("rms", [0.068e-6, 2.69e-6])
def test_rough_sphere_is_converged_and_balanced(rms: float) -> None:
    coarse, fine = solve(sphere(rms)), solve(sphere(rms), panels=36)
    r = np.linspace(0, 1.2e-3, 60)
    change = np.max(np.abs(coarse.at(r) - fine.at(r))) / np.max(fine.p)
    assert change < greenwood_tripp.UNCERTAINTY
    assert coarse.load == pytest.approx(70.0, rel=1e-12)
    assert coarse.residual < 1e-11
    assert coarse.p[-1] < 1e-14 * coarse.p[0]


def test_rough_sphere_by_adaptive_quadrature() -> None:
    """The separation equation at free points, with scipy's adaptive rule on K itself in place of panels."""
    rough, state = sphere(), solve(sphere())
    end = float(np.sum(state.weights))

    def bulk(r: float) -> float:
        def ring(s: float) -> float:
            return float(state.at(s)) * s / (s + r) * float(ellipk(4 * s * r / (s + r) ** 2))

        total = sum(
            quad(ring, *ends, epsrel=1e-9, limit=200)[0] for ends in ((0, r), (r, 2 * r), (2 * r, end))
        )
        return 4 / (np.pi * rough.modulus) * total

    separations = [bulk(r) + r**2 / (2 * rough.radius) for r in (1e-4, 4e-4)]
    pressures = [float(state.at(r)) for r in (1e-4, 4e-4)]
    # F is inverted for the separation that these pressures need; the rigid d0 drops out of the difference
    z = np.linspace(-3, 6, 20001)
    needed = np.interp(np.log(pressures), np.log(rough.stiffness * overlap_integral(z[::-1], 1.5)), z[::-1])
    difference = (needed[1] - needed[0]) * rough.summit_rms
    # the table's interpolation leaves (9/20000)^2/8 of a sigma
    assert difference == pytest.approx(separations[1] - separations[0], rel=1e-6)


def test_rough_sphere_tends_to_hertz() -> None:
    """Many stiff summits of vanishing height are a smooth sphere."""
    rough = RoughSphere(70.0, 0.14, 81.6e9, summit_rms=1e-9, summit_density=1e13, summit_radius=1e-4)
    state = solve(rough, panels=48)
    # a layer of a few sigma is added to an approach of 1.3 um: parts in a thousand
    assert float(state.at(0.0)) == pytest.approx(rough.smooth.peak_pressure, rel=3e-3)
    assert state.effective_radius == pytest.approx(rough.smooth.contact_radius, rel=3e-3)


def test_waviness_table_is_regenerated() -> None:
    """Fewer and smaller grids than the table's: three of the fit's standard errors cover the difference."""
    area, error, approach = jgh.extrapolated(0.7, (48, 54, 60, 64, 72, 80, 90, 96, 100, 108))
    tabulated, uncertainty = jgh.AREA_FRACTION[0.7]
    assert abs(area - tabulated) < 3 * error + uncertainty
    assert error < 2e-3
    assert approach == pytest.approx(jgh.APPROACH[0.7], abs=1e-4)


def test_waviness_table_between_its_asymptotes() -> None:
    ratios = sorted(jgh.AREA_FRACTION)
    areas = [jgh.AREA_FRACTION[ratio][0] for ratio in ratios]
    assert areas == sorted(areas)
    assert all(a > float(jgh.light_area(ratio)) for ratio, a in zip(ratios, areas, strict=True))
    # neighbours widen the contact by 3 % at 0.01; the openings' next order is below 0.2 % at 0.9
    assert areas[0] == pytest.approx(float(jgh.light_area(ratios[0])), rel=0.04)
    assert areas[-1] == pytest.approx(float(jgh.nearly_full_area(ratios[-1])), rel=2e-3)


def test_waviness_pressure_is_complementary_and_becomes_full() -> None:
    p = jgh.relax(0.3, 32)
    assert p.min() == 0.0
    assert p.mean() == pytest.approx(0.3, rel=1e-13)
    x = (np.arange(16) + 0.5) / 32
    full = 1.2 + np.outer(np.cos(2 * np.pi * x), np.cos(2 * np.pi * x))  # over p*: the mean, and p* cos cos
    np.testing.assert_allclose(jgh.relax(1.2, 16), full, atol=1e-6)
