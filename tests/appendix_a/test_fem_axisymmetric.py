"""Axisymmetric asperities: the flat patch exactly, signs and sizes on slopes."""

import mpmath as mp
import numpy as np
import pytest

from appendix_a.errors import InputError
from appendix_a.fem.axisymmetric import asperity, body_on, circular_patch
from appendix_a.fem.geometry import flat

RADII = np.array([0.0, 0.5, 0.9, 1.5, 3.0, 10.0])


def test_patch_formula_against_quadrature_of_chords():
    """In polar coordinates about the field point, the integral of 1 / distance is that of chord lengths."""
    for r in (0.0, 0.5, 2.5):
        sight = mp.pi / 2 if r <= 1 else mp.asin(1 / mp.mpf(r))
        half = mp.quad(lambda angle, r=r: 2 * mp.re(mp.sqrt(1 - (r * mp.sin(angle)) ** 2)), [0, sight])
        # E = 1, nu = 0; an inverse-root derivative at the end costs tanh-sinh nothing
        assert circular_patch(np.array([r]), 0.0)[0] == pytest.approx(float(2 * half / mp.pi), rel=1e-12)


@pytest.mark.parametrize("nu", [0.0, 0.3])
def test_flat_patch(nu):
    errors = []
    for level in (0, 3):
        body = body_on(flat(), 8.0, 512.0, level)
        u = body.displacements(nu)[1] - circular_patch(body.basis.doflocs[0], nu)
        errors.append(np.max(np.abs(body.surface_values(u, RADII) / circular_patch(RADII, nu))))
    assert errors[1] < 3e-5  # measured 1.5e-5
    assert errors[1] < errors[0] / 8  # cells halved, fans finer: third order and more


def test_a_cap_is_softer_than_the_half_space_and_the_error_is_stated():
    steep = asperity("paraboloid", 20.0, 8.0, 0.3, offsets=RADII)
    more = 100 * (steep.wavy / steep.flat - 1)
    assert np.all((more[:4] > 0.6) & (more[:4] < 1.5))  # 15 degrees: 0.6 to 0.8
    assert np.max(steep.percentage_points) < 0.03


def test_bad_input_is_refused():
    with pytest.raises(InputError):
        asperity("cone", 50.0, 8.0, 0.3, offsets=RADII)
    with pytest.raises(InputError):
        asperity("cone", 5.0, 7.0, 0.3, offsets=RADII)
