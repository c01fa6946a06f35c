"""Hertz, power-law indenters, cone and punches against mpmath's ring integral and their resultants."""

from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest
from scipy.integrate import quad

from verification.exact import hertz, power_law, punch
from verification.exact.axisymmetric import displacement

LOAD, MODULUS = 70.0, 81.6e9


def hertz_in_mpmath(contact: hertz.Sphere, r: float) -> float:
    """The ring integral of Hertz' pressure, the formula typed a second time from load and radius."""
    with mp.workdps(25):
        a = mp.cbrt(mp.mpf(3) * contact.load * contact.radius / (4 * contact.modulus))
        p0 = mp.mpf(3) / 2 * contact.load / (mp.pi * a**2)
        u, error = displacement(lambda s: p0 * mp.sqrt(max(0, 1 - (s / a) ** 2)), a, r, contact.modulus)
    assert error < 1e-12 * abs(u)
    return u


@pytest.mark.parametrize("rho", [0.4, 1.3])
def test_hertz_pressure_bends_the_surface_as_stated(rho: float) -> None:
    contact = hertz.Sphere(LOAD, 0.14, MODULUS)
    r = rho * contact.contact_radius
    # closed form against quadrature: both are good to rounding of a double
    assert float(contact.displacement(r)) == pytest.approx(hertz_in_mpmath(contact, r), rel=1e-13)
    if rho < 1:
        assert float(contact.displacement(r)) + r**2 / 0.28 == pytest.approx(contact.approach, rel=1e-13)


def test_an_ellipse_flattens_its_paraboloid() -> None:
    contact = hertz.Ellipse(LOAD, 3.0, 11.0, MODULUS)
    a, b = contact.semi_axes
    angle = np.linspace(0, 2 * np.pi, 16)
    x, y = 0.8 * a * np.cos(angle), 0.8 * b * np.sin(angle)
    level = contact.displacement(x, y) + 1.5 * x**2 + 5.5 * y**2
    np.testing.assert_allclose(level, contact.approach, rtol=1e-13)
    swapped = hertz.Ellipse(LOAD, 11.0, 3.0, MODULUS)
    assert swapped.semi_axes == pytest.approx((b, a), rel=1e-13)
    beside = float(swapped.displacement(2e-4, 1e-3))
    assert float(contact.displacement(1e-3, 2e-4)) == pytest.approx(beside, rel=1e-13)


@pytest.mark.parametrize("point", [(0.2, 0.1), (-0.7, 2.0)])
def test_displacement_beside_an_ellipse_by_chords(point: tuple[float, float]) -> None:
    """Rays from the field point: the pressure along a chord of half length c integrates to (pi/2) p0 k c."""
    contact = hertz.Ellipse(LOAD, 3.0, 11.0, MODULUS)
    a, b = contact.semi_axes
    x, y = point[0] * a, point[1] * b

    def ray(w: float) -> float:
        c, s = np.cos(w), np.sin(w)
        # 1 - |point + rho direction|^2 = -(A rho^2 + 2 B rho + C) in the ellipse's metric
        A, B = (c / a) ** 2 + (s / b) ** 2, x * c / a**2 + y * s / b**2
        C = (x / a) ** 2 + (y / b) ** 2 - 1
        peak2 = B**2 / A - C
        if peak2 <= 0 or (C > 0 and B > 0):
            return 0.0
        if C > 0:
            return np.pi / 2 * peak2 / np.sqrt(A)
        start = B / np.sqrt(A * peak2)
        segment = (np.pi / 2 - start * np.sqrt(1 - start**2) - np.arcsin(start)) / 2
        return float(peak2 / np.sqrt(A) * segment)

    breaks = [] if point[0] ** 2 + point[1] ** 2 < 1 else list(tangents(point, a, b))
    total = sum(
        quad(ray, low, high, epsrel=1e-11, limit=200)[0]
        for low, high in zip([-np.pi, *breaks], [*breaks, np.pi], strict=True)
    )
    expected = contact.peak_pressure / (np.pi * MODULUS) * total
    assert float(contact.displacement(x, y)) == pytest.approx(expected, rel=1e-10)


def tangents(point: tuple[float, float], a: float, b: float) -> list[float]:
    """Directions from ``point`` (in semi-axes) that touch the ellipse."""
    away, r = np.arctan2(-point[1], -point[0]), np.hypot(*point)
    unit = [away + sign * np.arcsin(1 / r) for sign in (-1, 1)]
    return sorted(float(np.arctan2(b * np.sin(w), a * np.cos(w))) for w in unit)


@pytest.mark.parametrize("n", [1.5, 4.0])
def test_power_law_indenter_is_flattened(n: float) -> None:
    indenter = power_law.PowerLaw(LOAD, 0.3, n, MODULUS)
    a = indenter.contact_radius

    def pressure(s: mp.mpf) -> mp.mpf:
        """g'(x)/sqrt(x^2 - s^2) integrated in closed form with mpmath's own 2F1."""
        # kept off 1, where a cone's pressure is infinite
        z = min(max(mp.mpf(0), 1 - (s / a) ** 2), 1 - mp.mpf("1e-24"))
        kappa = mp.sqrt(mp.pi) * mp.gamma(1 + mp.mpf(n) / 2) / mp.gamma((mp.mpf(n) + 1) / 2)
        return (
            MODULUS
            / mp.pi
            * kappa
            * 0.3
            * n
            * mp.mpf(a) ** (n - 1)
            * mp.sqrt(z)
            * mp.hyp2f1(1 - n / 2, 1, 1.5, z)
        )

    r = 0.6 * a
    u, _ = displacement(pressure, a, r, MODULUS)
    assert u + 0.3 * r**n == pytest.approx(indenter.approach, rel=1e-12)
    assert float(indenter.pressure(r)) == pytest.approx(float(pressure(mp.mpf(r))), rel=power_law.UNCERTAINTY)
    load = quad(lambda s: 2 * np.pi * s * indenter.pressure(s), 0, a, epsrel=1e-11)[0]
    assert load == pytest.approx(LOAD, rel=1e-10)


def test_cone_and_paraboloid_are_power_laws() -> None:
    cone, same = power_law.Cone(LOAD, 0.1, MODULUS), power_law.PowerLaw(LOAD, 0.1, 1.0, MODULUS)
    r = np.linspace(0.05, 0.95, 7) * cone.contact_radius
    np.testing.assert_allclose(cone.pressure(r), same.pressure(r), rtol=1e-13)
    assert cone.approach == pytest.approx(same.approach, rel=1e-14)
    sphere, other = hertz.Sphere(LOAD, 0.14, MODULUS), power_law.PowerLaw(LOAD, 1 / 0.28, 2.0, MODULUS)
    np.testing.assert_allclose(sphere.pressure(r), other.pressure(r), rtol=1e-13)


def test_circular_punch_is_flat_inside_and_carries_the_load() -> None:
    flat = punch.CircularPunch(LOAD, 1e-3, MODULUS)
    inner = quad(lambda s: 2 * np.pi * s * flat.pressure(s), 0, 0.9e-3)[0]
    assert inner == pytest.approx(LOAD * (1 - np.sqrt(1 - 0.9**2)), rel=1e-12)
    assert np.isinf(flat.pressure(1e-3))
    assert float(flat.pressure(1.01e-3)) == 0.0

    def pressure(s: mp.mpf) -> mp.mpf:
        return LOAD / (
            2 * mp.pi * mp.mpf(1e-3) ** 2 * mp.sqrt(max(mp.mpf("1e-40"), 1 - (s / mp.mpf(1e-3)) ** 2))
        )

    u, _ = displacement(pressure, 1e-3, 0.7e-3, MODULUS)
    # tanh-sinh with 25 digits keeps half of them at an inverse-root edge
    assert flat.approach == pytest.approx(u, rel=1e-11)
