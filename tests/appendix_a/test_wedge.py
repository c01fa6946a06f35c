"""The wedge's stresses: boundary values, the reference by another path, limits, input, speed."""

from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest

from appendix_a.wedge import displacements, fast, stresses
from appendix_a.wedge.transform import remainders

GAMMAS = (0.0, 1e-6, 1.0, 1.5)


@pytest.mark.parametrize("gamma", GAMMAS)
@pytest.mark.parametrize("side", [-1, 1])
def test_faces_carry_the_pressure_and_no_shear(gamma: float, side: int) -> None:
    r = np.array([1e-4, 0.1, 0.999, 1.001, 10.0, 1e4])
    _, sigma_theta, tau = stresses(r, side * (np.pi / 2 - gamma), gamma)
    # rounding 1e-15 times (a/r)^(1/2) <= 100
    np.testing.assert_allclose(sigma_theta, np.where(r < 1, -1.0, 0.0), rtol=0, atol=1e-13)
    np.testing.assert_allclose(tau, 0, rtol=0, atol=1e-13)


def test_field_is_symmetric_and_scales() -> None:
    r, theta = np.array([0.2, 1.5, 40.0]), np.array([0.9, 0.4, 1.1])
    one, mirrored = stresses(r, theta, 0.3), stresses(r, -theta, 0.3)
    doubled = stresses(2 * r, theta, 0.3, half_width=2.0)
    single, double = displacements(1.5, 0.4, 0.2, 0.3), displacements(3.0, 0.4, 0.2, 0.3, 2.0)
    np.testing.assert_allclose(single, double, rtol=1e-14)
    for sign, a, b, c in zip((1, 1, -1), one, mirrored, doubled, strict=True):
        np.testing.assert_allclose(a, sign * b, rtol=1e-13, atol=1e-15)
        np.testing.assert_array_equal(a, c)


def test_far_and_near_extremes() -> None:
    sigma_r, sigma_theta, tau = stresses([1e-200, 1e200], 0.2, 0.8)
    # the integration line moves for such r; its weights reach exp(10) = 2e4, so rounding reaches 1e-11
    np.testing.assert_allclose([sigma_r[0], sigma_theta[0], tau[0]], [-1, -1, 0], atol=1e-10)
    radial = -4 * np.cos(0.8) * np.cos(0.2) / (np.pi - 1.6 + np.sin(1.6))
    assert sigma_r[1] * 1e200 == pytest.approx(radial, rel=1e-10)


def test_end_of_the_load_takes_the_mean() -> None:
    sigma_r, sigma_theta, tau = stresses(1.0, np.pi / 2 - 0.2, 0.2)
    assert (sigma_theta, tau) == (pytest.approx(-0.5), pytest.approx(0, abs=1e-15))
    inside, outside = stresses([1 - 1e-9, 1 + 1e-9], np.pi / 2 - 0.2, 0.2)[0]
    assert sigma_r == pytest.approx((inside + outside) / 2, abs=1e-7)


@pytest.mark.parametrize(("gamma", "nu"), [(1e-6, 0.3), (1.2, 0.0)])
def test_displacements_have_the_strains_of_the_stresses(gamma: float, nu: float) -> None:
    r, theta = np.array([0.3, 0.8, 2.0, 30.0]), np.array([0.3, -0.6, 0.9, 0.1]) * (np.pi / 2 - gamma)
    x, y, h = r * np.cos(theta), r * np.sin(theta), 1e-3

    def u(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        return np.array(displacements(np.hypot(x, y), np.arctan2(y, x), gamma, nu))

    weights = ((1, 3 / 4), (2, -3 / 20), (3, 1 / 60))
    by_x = sum(w * (u(x + k * h, y) - u(x - k * h, y)) for k, w in weights) / h
    by_y = sum(w * (u(x, y + k * h) - u(x, y - k * h)) for k, w in weights) / h
    sigma_r, sigma_theta, tau = stresses(r, theta, gamma)
    cos, sin = np.cos(theta), np.sin(theta)
    sigma_x = sigma_r * cos**2 + sigma_theta * sin**2 - 2 * tau * sin * cos
    sigma_y = sigma_r * sin**2 + sigma_theta * cos**2 + 2 * tau * sin * cos
    tau_xy = (sigma_r - sigma_theta) * sin * cos + tau * (cos**2 - sin**2)
    # sixth-order differences: h^6 of a field varying over 0.1, and rounding 1e-15 / h
    tolerance = 1e-9
    strain_x = (1 - nu**2) * sigma_x - nu * (1 + nu) * sigma_y
    strain_y = (1 - nu**2) * sigma_y - nu * (1 + nu) * sigma_x
    np.testing.assert_allclose(by_x[0], strain_x, rtol=0, atol=tolerance)
    np.testing.assert_allclose(by_y[1], strain_y, rtol=0, atol=tolerance)
    np.testing.assert_allclose(by_y[0] + by_x[1], 2 * (1 + nu) * tau_xy, rtol=0, atol=tolerance)


def test_half_plane_displacements() -> None:
    x, nu = np.array([1e-3, 0.5, 0.999, 1.0, 1.001, 3.0, 10.0]), 0.3
    logs = (x + 1) * np.log(x + 1) - np.where(x == 1, 0, (x - 1) * np.log(np.where(x == 1, 1, np.abs(x - 1))))
    for side in (1, -1):
        down, along = displacements(x, side * np.pi / 2, 0.0, nu)
        np.testing.assert_allclose(down, -2 * (1 - nu**2) / np.pi * logs, rtol=0, atol=1e-14)
        # under the strip the surface moves inwards, Johnson 1985 Eq. (2.30a)
        inwards = (1 + nu) * (1 - 2 * nu) * np.minimum(x, 1)
        np.testing.assert_allclose(side * along, -inwards, rtol=0, atol=1e-14)


@pytest.mark.parametrize("gamma", [0.0, 1e-9, 0.3, 1.5])
def test_angles_from_the_face_keep_their_digits(gamma: float) -> None:
    """In 50 digits; close to the face too, where the difference of two angles has lost all but the last."""
    near = (np.pi / 2 - gamma) - 10.0 ** np.arange(-14, 0.0)
    theta = np.concatenate([near, -near])
    delta, sine = fast.angle_from_face(theta, gamma)
    with mp.workdps(50):
        exact = [mp.pi / 2 - mp.mpf(gamma) - mp.mpf(float(t)) for t in theta]
        sines = [mp.sin(angle) for angle in exact]
    np.testing.assert_allclose(delta, np.array(exact, dtype=float), rtol=1e-15)
    np.testing.assert_allclose(sine, np.array(sines, dtype=float), rtol=1e-15)


@pytest.mark.parametrize(("gamma", "nodes"), [(1e-6, 188), (1.5, 4155)])
def test_a_map_takes_one_line_of_few_nodes(gamma: float, nodes: int) -> None:
    """However many points it has. The last node is the first whose terms are below exp(-CUTOFF)."""
    log_r = np.log(np.geomspace(1e-4, 1e4, 100))
    (points,) = fast.groups(log_r)
    line = fast.line_for(log_r[points], gamma)
    assert points.all()
    assert line.n == nodes
    reach, step = (2 * (np.pi / 2 - gamma) * line.h * n for n in (line.n, 1))
    assert fast.CUTOFF <= reach < fast.CUTOFF + step


@pytest.mark.parametrize("gamma", [1e-6, 1.5])
def test_remainders_complete_the_kernels(gamma: float) -> None:
    """R_S, R_T plus the half-planes' kernels are S, T, in 60 digits."""
    for xi in (0.0, 0.3, 2.0, 9.0):
        r_s, r_t = remainders(np.array([-0.5 + 1j * xi]), gamma)
        with mp.workdps(60):
            alpha, z = mp.pi / 2 - mp.mpf(gamma), mp.mpc(-0.5, xi)
            d = mp.sin(2 * alpha * z) + z * mp.sin(2 * alpha)
            s = mp.sin((1 - z) * alpha) / d - mp.sin(alpha * (1 + z) - mp.pi * z) / mp.sin(mp.pi * z)
            t = mp.sin((1 + z) * alpha) / d - mp.sin(alpha * (1 - z) + mp.pi * z) / mp.sin(mp.pi * z)
            # both terms of a numerator are of order gamma, and may cancel to gamma^2
            assert abs(complex(s) - r_s[0]) <= 1e-13 * abs(complex(s)) + 1e-15 * gamma
            assert abs(complex(t) - r_t[0]) <= 1e-13 * abs(complex(t)) + 1e-15 * gamma
