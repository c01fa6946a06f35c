"""Statistics of heights against closed forms."""

from __future__ import annotations

import math

import numpy as np
import pytest

from refimpl.surfaces import statistics as stats

N = 64
X = (np.arange(N) + 0.5) / N
WAVE = np.sin(2 * np.pi * 4 * X)[:, None] * np.ones(N)


def test_moments_of_a_wave() -> None:
    # mean of sin^2 is 1/2, of sin^4 3/8; equidistant points sum them exactly
    assert abs(stats.rms_height(3 + WAVE) - math.sqrt(0.5)) < 1e-15 * N
    assert abs(stats.skewness(WAVE)) < 1e-14
    assert abs(stats.kurtosis(5 - WAVE) - 1.5) < 1e-13
    assert abs(stats.skewness(np.array([[0.0, 0.0, 0.0, 1.0]])) - 2 / math.sqrt(3)) < 1e-15


def test_slopes_are_exact_for_bilinear_heights_and_know_their_axis() -> None:
    z = 0.3 * X[:, None] - 2.0 * X[None, :]
    dz_dx, dz_dy = stats.slopes(z, 1 / N)
    np.testing.assert_allclose(dz_dx, 0.3, rtol=1e-12)
    np.testing.assert_allclose(dz_dy, -2.0, rtol=1e-12)
    angle_x, angle_y = stats.slope_angles(z, 1 / N)
    np.testing.assert_allclose(angle_x, math.atan(0.3), rtol=1e-12)
    np.testing.assert_allclose(angle_y, -math.atan(2.0), rtol=1e-12)
    np.testing.assert_allclose(stats.rms_slopes(z, 1 / N), (0.3, 2.0), rtol=1e-12)


def test_autocorrelation_is_the_plain_sum_over_pairs() -> None:
    z = np.random.default_rng(1).normal(size=(9, 6))
    d = z - z.mean()
    for axis in (0, 1):
        rows = np.moveaxis(d, axis, 0)
        expected = [np.mean(rows[: len(rows) - k] * rows[k:]) / np.mean(d**2) for k in range(len(rows))]
        np.testing.assert_allclose(stats.autocorrelation(z, axis), expected, rtol=0, atol=1e-13)


def test_flat_heights_have_no_correlation_length() -> None:
    assert np.isnan(stats.autocorrelation(np.zeros((4, 4)), 0)).all()
    assert stats.correlation_length(np.zeros((4, 4)), 1.0) is None


def test_correlation_length_of_a_step_by_hand() -> None:
    """Heights 1, 1, -1, -1 along y: correlations 1, 1/3, -1, -1 there, and 1, 1, 1, 1 along x."""
    z = np.tile([1.0, 1.0, -1.0, -1.0], (4, 1))
    np.testing.assert_allclose(stats.autocorrelation(z, 0), [1, 1, 1, 1], rtol=0, atol=1e-15)
    np.testing.assert_allclose(stats.autocorrelation(z, 1), [1, 1 / 3, -1, -1], rtol=0, atol=1e-15)
    # their mean is 1, 2/3, 0, 0 at lags of 0, 0.5, 1 and 1.5 m
    for level, expected in ((0.9, 0.15), (0.5, 0.625), (0.1, 0.925)):
        assert stats.correlation_length(z, 0.5, level) == pytest.approx(expected, rel=1e-14)
    assert stats.correlation_length(z, 0.5) == stats.correlation_length(z, 0.5, 0.1)
    assert stats.correlation_length(z, 0.5, -0.1) is None
