"""Westergaard's wave, the sliding cylinder and the sliding wave against their own integral equations."""

from __future__ import annotations

import dataclasses

import mpmath as mp
import numpy as np
import pytest
from scipy.integrate import quad

from refimpl.errors import InputError
from verification.exact import westergaard
from verification.exact.sliding_plane import SlidingCylinder, dundurs
from verification.exact.sliding_wave import SlidingWave

UNIT = 1 / np.pi  # amplitude that makes p* = 1 with unit modulus and wavelength


def equation_residual(contact: SlidingCylinder, x: float) -> float:
    """The integral equation's misfit at ``x`` (m) in the contact, over its largest term, by mpmath
    quadrature.

    The principal value is taken by pairing x + s with x - s up to the nearer edge; p is written anew from the
    exponents.
    """
    with mp.workdps(25):
        g = mp.mpf(1) / 2 - mp.atan(mp.mpf(contact.coupling) * contact.beta) / mp.pi
        a = mp.sqrt(mp.mpf(contact.line_load) * contact.radius / (mp.pi * contact.modulus * g * (1 - g)))
        shift = -2 * mp.mpf(contact.radius) * contact.coupling * contact.tau / contact.modulus
        low, high = shift - 2 * a * (1 - g), shift + 2 * a * g

        def p(s: mp.mpf) -> mp.mpf:
            height = mp.mpf(contact.modulus) / (2 * contact.radius) * mp.sin(mp.pi * g)
            return height * max(mp.mpf(0), s - low) ** g * max(mp.mpf(0), high - s) ** (1 - g)

        at = mp.mpf(x)
        near = min(at - low, high - at)
        paired = mp.quad(lambda s: (p(at - s) - p(at + s)) / s, [0, near / 2, near])
        rest = [low, at - near] if at - low > near else [at + near, high]
        principal = paired + mp.quad(lambda s: p(s) / (at - s), rest)
        shear = mp.pi * contact.coupling * (contact.tau + contact.beta * p(at))
        wanted = mp.pi * contact.modulus * at / (2 * contact.radius)
        return float(abs(principal - shear - wanted) / max(abs(principal), abs(shear), abs(wanted)))


def principal_value_residual(contact: SlidingWave, x: float) -> float:
    """The integral equation's misfit at ``x`` (m) in the contact over its largest term, by quadrature."""
    with mp.workdps(20):
        at = mp.pi * mp.mpf(x) / contact.wavelength
        low, high = (mp.mpf(angle) for angle in contact._angles)
        g = mp.mpf(1) / 2 - mp.atan(mp.mpf(contact.coupling) * contact.beta) / mp.pi
        m, star = -g * low - (1 - g) * high, mp.mpf(contact.full_contact_pressure)

        def p(psi: mp.mpf) -> mp.mpf:
            if not low < psi < high:
                return mp.mpf(0)
            edges = mp.sin(psi - low) ** g * mp.sin(high - psi) ** (1 - g)
            return 2 * star * mp.sin(mp.pi * g) * edges * mp.cos(psi - m)

        near = min(at - low, high - at)
        paired = mp.quad(lambda s: (p(at - s) - p(at + s)) * mp.cot(s), [0, near / 2, near])
        rest = [low, at - near] if at - low > near else [at + near, high]
        principal = paired + mp.quad(lambda psi: p(psi) * mp.cot(at - psi), rest)
        mean = contact.beta * mp.mpf(contact.mean_pressure) + contact.tau * (high - low) / mp.pi
        shear = mp.pi * contact.coupling * (contact.tau + contact.beta * p(at) - mean)
        wanted = mp.pi * star * mp.sin(2 * at)
        return float(abs(principal - shear - wanted) / max(abs(principal), abs(shear), abs(wanted)))


@pytest.mark.parametrize("share", [0.5, 0.95])
def test_wave_is_flat_where_it_touches_and_open_beyond(share: float) -> None:
    wave = westergaard.Wave(share, UNIT, 1.0, 1.0)
    a = wave.contact_fraction / 2

    def level(x: float) -> float:
        u, error = westergaard.displacement_by_quadrature(wave, x)
        assert error < 1e-12
        return u + UNIT * (1 - np.cos(2 * np.pi * x))

    for x in (0.0, 0.5 * a, 0.95 * a):
        assert level(x) == pytest.approx(wave.approach, rel=1e-12)
    assert level((a + 0.5) / 2) > wave.approach


def test_wave_carries_its_mean_and_reaches_full_contact() -> None:
    wave = westergaard.Wave(0.4, UNIT, 1.0, 1.0)
    a = wave.contact_fraction / 2
    assert quad(wave.pressure, -a, a)[0] == pytest.approx(0.4, rel=1e-9)
    almost, full = westergaard.Wave(1 - 1e-14, UNIT, 1.0, 1.0), westergaard.Wave(1.0, UNIT, 1.0, 1.0)
    x = np.linspace(0, 1, 11)
    np.testing.assert_allclose(almost.pressure(x), full.pressure(x), atol=1e-6)


HARD_ON_SOFT = dundurs(lower=(1e9, 0.2), upper=(1e15, 0.3))


def cylinder(tau: float = 2e6, beta: float = 0.9) -> SlidingCylinder:
    return SlidingCylinder(1e5, 0.1, HARD_ON_SOFT[0], HARD_ON_SOFT[1], tau, beta)


@pytest.mark.parametrize("place", [-0.97, 0.6, 0.97])
def test_sliding_cylinder_satisfies_its_integral_equation(place: float) -> None:
    contact = cylinder()
    x = contact.centre + place * contact.half_width
    # x itself is a double: its rounding is the residual's size
    assert equation_residual(contact, x) < 1e-14


def test_sliding_cylinder_shifts_to_the_trailing_side_of_a_softer_flat() -> None:
    hard, still = cylinder(tau=0.0), cylinder(tau=0.0, beta=0.0)
    assert HARD_ON_SOFT[1] > 0
    assert hard.centre < 0 == still.centre
    assert hard.pressure_centroid < 0
    mirrored = dataclasses.replace(hard, coupling=-hard.coupling)
    assert mirrored.centre == pytest.approx(-hard.centre, rel=1e-14)
    assert mirrored.pressure(1e-3) == pytest.approx(hard.pressure(-1e-3), rel=1e-13)


def wave(tau: float = 0.0, beta: float = 0.8, coupling: float = 0.4, mean: float = 0.3) -> SlidingWave:
    return SlidingWave(mean, UNIT, 1.0, 1.0, coupling, tau, beta)


@pytest.mark.parametrize("tau", [0.0, 0.05])
def test_sliding_wave_satisfies_its_integral_equation(tau: float) -> None:
    contact = wave(tau)
    low, high = contact.edges
    for share in (0.03, 0.4):
        assert principal_value_residual(contact, low + share * (high - low)) < 1e-14
    assert quad(contact.pressure, low, high)[0] == pytest.approx(0.3, rel=1e-7)


def test_sliding_wave_without_coupling_is_westergaard() -> None:
    contact, still = wave(coupling=0.0), westergaard.Wave(0.3, UNIT, 1.0, 1.0)
    assert contact.contact_fraction == pytest.approx(still.contact_fraction, rel=1e-12)
    x = np.linspace(-0.45, 0.45, 13)
    np.testing.assert_allclose(contact.pressure(x), still.pressure(x), rtol=1e-11, atol=1e-12)


def test_a_wave_that_is_not_in_partial_contact_is_refused() -> None:
    for mean in (0.99, -1.0):
        with pytest.raises(InputError):
            wave(mean=mean)
    with pytest.raises(InputError):
        westergaard.Wave(0.0, UNIT, 1.0, 1.0)
