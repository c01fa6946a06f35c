"""Sums of waves on a torus against their plain sums."""

from __future__ import annotations

import math

import numpy as np
import pytest

from refimpl.grid import Array
from refimpl.surfaces import waves
from refimpl.surfaces.waves import MAX_WAVES, Torus
from refimpl.surfaces.white_noise import STREAM, white_noise


def falling(qx: Array, qy: Array) -> Array:
    q = np.hypot(qx, qy)
    return np.where((q > 0) & (q <= 70), 1 / (1 + q) ** 1.8, 0.0)


@pytest.mark.parametrize("shear", [0.0, 0.37, -2.0])
@pytest.mark.parametrize("count", [(15, 25), (70, 3), (0, 4), (64, 63)])
def test_the_field_is_the_plain_sum_of_waves(shear: float, count: tuple[int, int]) -> None:
    torus = Torus((1.3, 2.1), count, shear)
    x, y = np.random.default_rng(3).uniform(-3, 5, (2, 12))
    k, across = (np.arange(-n, n + 1.0) for n in count)
    qx, qy = torus.wave_vectors(k, across)
    rows, columns = (range(-n, n + 1) for n in count)
    weighted = falling(qx, qy) * white_noise(5, rows, columns, waves.STREAM)
    phase = qx * x[:, None, None, None] + qy * y[:, None, None]
    plain = (weighted * (np.cos(phase) + np.sin(phase))).sum(axis=(2, 3))
    size = math.sqrt(torus.mean_squares(falling)[0])
    # phases of up to 1e3 rad round by 1e-13 in the plain sum as well; waves add up as their squares do
    np.testing.assert_allclose(torus.field(falling, 5, x, y), plain, rtol=0, atol=3e-13 * size)


def test_mean_squares_are_the_sums_over_all_waves() -> None:
    torus = Torus((1.3, 2.1), (15, 25), 0.4)
    qx, qy = torus.wave_vectors(np.arange(-15, 16.0), np.arange(-25, 26.0))
    power = falling(qx, qy) ** 2
    expected = power.sum(), (power * (qx**2 + qy**2)).sum()
    np.testing.assert_allclose(torus.mean_squares(falling), expected, rtol=1e-13)


def test_wave_vectors_are_the_gradients_of_the_phases() -> None:
    torus = Torus((1.3, 2.1), (3, 3), 0.4)
    qx, qy = torus.wave_vectors(np.array([2.0]), np.array([-1.0]))

    def phase(x: float, y: float) -> float:
        return 2 * math.pi * (2 * (x + 0.4 * y) / 1.3 - y / 2.1)

    assert (qx[0, 0], qy[0, 0]) == pytest.approx((phase(1, 0), phase(0, 1)), rel=1e-14)


def test_noise_of_waves_is_not_the_noise_of_lattices() -> None:
    assert waves.STREAM != STREAM
    ours, other = (white_noise(1, range(64), range(64), stream) for stream in (waves.STREAM, STREAM))
    assert abs(np.mean(ours * other)) < 4 / 64
    # the stream is part of the interface: a scene file must mean the same surface in every version
    pinned = white_noise(1, range(-1, 1), range(-1, 1), waves.STREAM)
    np.testing.assert_allclose(
        pinned,
        [[1.2651752615565814, 0.1806311149445415], [-0.5235801101785472, -0.9963684118560471]],
        rtol=1e-12,
        atol=0,
    )


def test_a_torus_holds_so_many_waves_and_no_more() -> None:
    refused = []
    torus = Torus.holding((2.0, 1.0), (0.5, 0.25), lambda *why: refused.append(why))
    assert torus.waves == (4, 4)
    assert not refused
    Torus.holding((2.0, 1.0), (2.0 / 8191, 1.0), lambda *why: refused.append(why))
    ((factor, limit),) = refused
    assert factor == pytest.approx((2 * 8191 + 1) / MAX_WAVES)
    assert limit == "8192 waves an axis"
