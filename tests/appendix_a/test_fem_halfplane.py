"""Closed forms of the half-plane against the equations they solve."""

import numpy as np
import pytest
from scipy.integrate import quad

from appendix_a.fem.halfplane import point_force, pressed_strip, sheared_strip


@pytest.mark.parametrize("nu", [0.0, 0.3, 0.5])
@pytest.mark.parametrize("force", [(1.0, 0.0), (0.0, 1.0)])
def test_point_force_is_in_equilibrium_and_carries_its_force(nu, force):
    """Divergence of stress by central differences; resultant over a half-circle."""
    lam_free = min(nu, 0.4999)  # stresses from strains need a finite lambda

    def stress(x, y, h=1e-4):
        ux = [point_force(np.array([x + s * h]), np.array([y]), force, lam_free) for s in (1, -1)]
        uy = [point_force(np.array([x]), np.array([y + s * h]), force, lam_free) for s in (1, -1)]
        exx, eyx = ((ux[0][k] - ux[1][k]) / (2 * h) for k in (0, 1))
        exy, eyy = ((uy[0][k] - uy[1][k]) / (2 * h) for k in (0, 1))
        lam = lam_free / ((1 + lam_free) * (1 - 2 * lam_free))
        two_mu = 1 / (1 + lam_free)
        shear = two_mu * (exy + eyx) / 2
        return np.array([lam * (exx + eyy) + two_mu * exx, lam * (exx + eyy) + two_mu * eyy, shear])[:, 0]

    angles, weights = np.polynomial.legendre.leggauss(12)
    angles, weights = (angles + 1) * np.pi / 2, weights * np.pi / 2
    resultant = np.zeros(2)
    for angle, weight in zip(angles, weights, strict=True):
        sxx, syy, sxy = stress(np.cos(angle), np.sin(angle))
        resultant += weight * np.array(
            [sxx * np.cos(angle) + sxy * np.sin(angle), sxy * np.cos(angle) + syy * np.sin(angle)]
        )
    # differences with h = 1e-4: h^2 truncation 1e-8 times lambda at 0.4999, 1.7e3
    assert resultant == pytest.approx(-np.array(force), abs=2e-4)
    assert stress(1.0, 1e-3)[1:] == pytest.approx([0.0, 0.0], abs=5e-3)  # free surface, to the depth's order


@pytest.mark.parametrize("nu", [0.0, 0.3, 0.5])
def test_strips_are_integrals_of_point_forces(nu):
    for x in (0.4, 2.0, -7.0):
        for force, strip in (((0.0, 1.0), pressed_strip), ((1.0, 0.0), sheared_strip)):

            def shift(t, x=x, force=force):
                here = point_force(np.array([x - t]), np.array([0.0]), force, nu)[1][0]
                return here - point_force(np.array([-t]), np.array([0.0]), force, nu)[1][0]

            value, _ = quad(shift, -1.0, 1.0, points=[0.0, min(max(x, -1.0), 1.0)], epsabs=1e-11)
            # quadrature asked for 1e-11, the logarithm's end points cost some of it
            assert strip(np.array([x]), nu)[0] == pytest.approx(value, abs=1e-8)
