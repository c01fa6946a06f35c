"""Coupled indentation, rectangular patch and full contact in Fourier space, each evaluated a second way."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import quad

from refimpl.errors import InputError
from verification.exact import coupled_indentation, fourier, kernel_reference
from verification.exact.coupled_indentation import CoupledHertz, ShearedSphere, first_order_shift
from verification.exact.hertz import Sphere
from verification.exact.patch import UNCERTAINTY, Patch
from verification.exact.textbook import normal_offsets, shear_offsets

HERTZ = Sphere(load=70.0, radius=0.14, modulus=81.6e9)
STATE = CoupledHertz(HERTZ, c0=2e-13, tau=15e6, beta=0.3)


@pytest.mark.parametrize("place", [(-0.7, 0.0), (0.9, -0.3)])
def test_coupling_displacement_by_polar_quadrature(place: tuple[float, float]) -> None:
    x, y = (share * HERTZ.contact_radius for share in place)
    expected, error = coupled_indentation.coupling_by_quadrature(STATE, x, y)
    assert error < 1e-25
    assert float(STATE.coupling_displacement(x, y)) == pytest.approx(expected, rel=1e-12)


def test_coupling_displacement_far_away_is_the_point_force() -> None:
    x = 1e3 * HERTZ.contact_radius
    assert float(STATE.coupling_displacement(x, 0)) == pytest.approx(
        2e-13 * STATE.friction_force / x, rel=1e-14
    )
    assert float(STATE.coupling_displacement(-x, 0)) < 0 == float(STATE.coupling_displacement(0, x))


def test_coupled_gap_leaves_hertz_in_contact() -> None:
    r = HERTZ.contact_radius * np.linspace(0, 0.99, 9)
    level = HERTZ.displacement(r) + STATE.coupling_displacement(r, 0) + STATE.gap(r, 0)
    np.testing.assert_allclose(level, HERTZ.approach, rtol=1e-13)


def test_sheared_sphere_shifts_and_stays_level() -> None:
    sphere = ShearedSphere(HERTZ, c0=2e-13, tau=15e6)
    assert sphere.shift < 0
    only_tau = CoupledHertz(HERTZ, 2e-13, 15e6, 0.0)
    xi = HERTZ.contact_radius * np.linspace(-0.99, 0.99, 9)
    u = HERTZ.displacement(np.abs(xi)) + only_tau.coupling_displacement(xi, 0)
    level = u + (xi + sphere.shift) ** 2 / (2 * HERTZ.radius)
    np.testing.assert_allclose(level, sphere.approach, rtol=1e-13)
    assert sphere.pressure(sphere.shift, 0) == pytest.approx(HERTZ.peak_pressure, rel=1e-14)
    assert 0 < sphere.uncertainty < 1e-5


def test_first_order_shift_of_tau_is_the_exact_one_and_of_beta_the_work_on_a_tilted_punch() -> None:
    sphere = ShearedSphere(HERTZ, c0=2e-13, tau=15e6)
    assert first_order_shift(HERTZ, 2e-13, 15e6, 0.0) == pytest.approx(sphere.shift, rel=1e-15)
    # (2 E*/pi) x (a^2 - r^2)^(-1/2) tilts the disc by one; at r = a sin(t) its edge is no singularity
    a, state = HERTZ.contact_radius, CoupledHertz(HERTZ, 2e-13, 0.0, 0.3)

    def work(t: float) -> float:
        r = a * math.sin(t)
        return r**2 * float(state.coupling_displacement(r, 0.0))

    moment = -2 * HERTZ.modulus * quad(work, 0, math.pi / 2, epsrel=1e-12)[0]
    assert first_order_shift(HERTZ, 2e-13, 0.0, 0.3) == pytest.approx(moment / HERTZ.load, rel=1e-12)


@pytest.mark.parametrize("place", [(0, 0), (1, 0.5), (1, 0.2), (3, 2)])
def test_patch_by_the_kernel_in_many_digits(place: tuple[float, float]) -> None:
    plate = Patch(1e6, 2e-3, 1e-3, 1e11)
    x, y = place[0] * 1e-3, place[1] * 1e-3
    expected = 1e6 / (math.pi * 1e11) * float(kernel_reference.normal(x, y, 2e-3, 1e-3))
    assert float(plate.displacement(x, y)) == pytest.approx(expected, rel=UNCERTAINTY)


@pytest.mark.parametrize("frequency", [(1, 0), (-2, 1)])
def test_symbol_is_the_transform_of_the_element_integrals(frequency: tuple[int, int]) -> None:
    """In real space, damped by Gaussian windows: two widths cancel the window's square."""
    M, R, slip = 32, 193, 0.3
    span = np.arange(1 - R, R)
    wave = np.exp(-2j * np.pi * np.add.outer(frequency[0] * span, frequency[1] * span) / M)
    kernel = (normal_offsets((R, R)) + slip * shear_offsets((R, R), 0.0)) / np.pi
    r2 = np.add.outer(span**2, span**2)
    sums = [np.sum(kernel * wave * np.exp(-r2 / (2 * width**2))) for width in (R / 6, R / 6 / np.sqrt(2))]
    q = 2 * np.pi * np.array(frequency) / M
    exact = complex(fourier.symbol_at(*q, 1.0, slip))
    # elements of unit edge leave -(q h)^2/24, and aliases its 3/2 power: 0.02 at 3.6 waves
    assert abs(2 * sums[0] - sums[1] - exact) < 0.02 * abs(exact)


def test_full_contact_of_one_wave() -> None:
    M, amplitude = 32, 1e-6
    x = (np.arange(M) + 0.5) / M * 1e-3
    gap = amplitude * (1 - np.cos(2 * np.pi * x / 1e-3))[:, None] * np.ones(M)
    # the pressure's crests lie at -phi lambda/(2 pi), on the trailing side of the wave's
    phi = np.arctan(0.2)
    star = np.pi * 1e9 * amplitude / 1e-3 * np.cos(phi)
    sliding = fourier.FullContact(gap, 1e-3, 1e9, mean_pressure=2 * star, coupling=0.4, beta=0.5)
    expected = 2 * star + star * np.cos(2 * np.pi * x / 1e-3 + phi)
    np.testing.assert_allclose(sliding.pressure, expected[:, None] * np.ones(M), rtol=1e-12)
    across = fourier.FullContact(gap, 1e-3, 1e9, 2 * star, 0.4, 0.5, direction=np.pi / 2)
    frictionless = fourier.FullContact(gap, 1e-3, 1e9, 2 * star)
    np.testing.assert_allclose(across.pressure, frictionless.pressure, rtol=1e-12)
    with pytest.raises(InputError, match="mean_pressure"):
        _ = fourier.FullContact(gap, 1e-3, 1e9, 0.5 * star).pressure
