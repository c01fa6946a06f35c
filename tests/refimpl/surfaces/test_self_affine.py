"""Self-affine roughness: spectrum, statistics, one surface per seed, what is refused.

The spectrum is written out here anew. A wave of the torus and its opposite have ``2 |Z|^2 / a^2`` of
chi-square with two degrees of freedom, Z their coefficient and a^2 a wave's mean square, all independent.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import j0

from refimpl.errors import InputError
from refimpl.grid import Array, Grid
from refimpl.surfaces import SelfAffineRoughness, SurfaceWarning, waves
from refimpl.surfaces.noise_lattice import STREAM, white_noise
from refimpl.surfaces.waves import MAX_WAVES, PeriodicLattice

SIDE = 1e-3
PARAMETERS: dict[str, Any] = {
    "hurst": 0.8, "rms": 1e-6, "roll_off": 2e-4, "long_cut": 5e-4, "short_cut": 2e-5, "seed": 1
}  # fmt: skip


def rough(**changed: Any) -> SelfAffineRoughness:
    table = PARAMETERS | changed
    if "rms_gradient" in changed:
        del table["rms"]
    return SelfAffineRoughness(**table)


def shape(q: Array, table: dict[str, Any] = PARAMETERS) -> Array:
    """The PSD over its plateau, as the specification has it; ends included."""
    low, roll, high = (2 * math.pi / table[name] for name in ("long_cut", "roll_off", "short_cut"))
    power = np.where(q <= roll, 1.0, (np.maximum(q, roll) / roll) ** (-2 - 2 * table["hurst"]))
    return np.where((q >= low * (1 - 1e-9)) & (q <= high * (1 + 1e-9)), power, 0.0)


def integral(weight: Callable[[float], float], table: dict[str, Any] = PARAMETERS) -> float:
    """A weight under the PSD, over the plane of an isotropic surface, by 2 pi."""

    def under(q: float) -> float:
        return float(shape(np.array(q), table)) * q * weight(q)

    ends = [2 * math.pi / table[name] for name in ("long_cut", "roll_off", "short_cut")]
    return sum(quad(under, *pair, limit=400, epsabs=0, epsrel=1e-10)[0] for pair in pairwise(ends))


def test_lay_stretches_the_spectrum() -> None:
    """Periodic: waves are where C(sqrt(g^2 q_along^2 + q_across^2)) is; over 12 seeds they have its size."""
    g, lay, n = 3.0, 0.7, 160
    q = 2 * math.pi * np.fft.fftfreq(n, SIDE / n)
    along, across = (math.cos(turn) * q[:, None] + math.sin(turn) * q for turn in (lay, lay + math.pi / 2))
    power = shape(np.hypot(g * along, across))
    squares = np.zeros((n, n))
    for seed in range(1, 13):
        z = rough(rms=1.0, seed=seed, anisotropy=g, lay=lay).sample(Grid.square(SIDE, n, periodic=True))
        squares += np.abs(np.fft.fft2(z) / n**2) ** 2 / 12
    assert squares[power == 0].max() < 1e-30
    # a wave and its opposite are one: chi-square of the ratios has half as many pairs, of 24 freedoms each
    ratios = squares[power > 0] * power.sum() / power[power > 0]
    assert abs(ratios.mean() - 1) < 4 * math.sqrt(2 / (12 * ratios.size))


def test_pinned() -> None:
    """A scene file must mean the same surface in every version; other libraries may round differently."""
    z = rough().sample(Grid.square(SIDE, 16))
    np.testing.assert_allclose(
        z[3:5, 7:9],
        [[-1.0307545790051934e-06, 4.3621835582264294e-07], [-1.188467521533459e-07, -6.558486109367364e-07]],
        rtol=1e-9,
        atol=0,
    )


def test_an_unresolved_short_cut_is_warned_of() -> None:
    with pytest.warns(SurfaceWarning, match=r"2 elements per shortest wave, 2e-05 m: the grid misses"):
        rough().heights(Grid.square(SIDE, 100))
    assert rough().notes(Grid.square(SIDE, 200)) == ()
    slope, curvature = rough().missed(SIDE / 100)
    (said,) = rough().notes(Grid.square(SIDE, 100))
    assert f"misses {slope:.0%} of the rms slope and {curvature:.0%} of the rms curvature" in said


@pytest.mark.parametrize(
    ("changed", "field"),
    [
        ({"hurst": 0.0}, "hurst"),
        ({"roll_off": 6e-4}, "long_cut"),
        ({"short_cut": 2e-4}, "short_cut"),
        ({"rms": None}, "rms, rms_gradient"),
        ({"rms_gradient": -0.1}, "rms_gradient"),
        ({"anisotropy": 0.0}, "anisotropy"),
        ({"lay": math.inf}, "lay"),
        ({"seed": -1}, "seed"),
    ],
)
def test_bad_parameters_are_refused(changed: dict[str, Any], field: str) -> None:
    with pytest.raises(InputError) as refusal:
        rough(**changed)
    assert refusal.value.field == field


def test_spectra_that_a_grid_cannot_hold_are_refused() -> None:
    with pytest.raises(InputError, match="at least two elements"):
        rough().sample(Grid.square(SIDE, 3))
    with pytest.raises(InputError, match=r"short_cut = 1e-07: expected at least .* \(8192 waves an axis\)"):
        rough(short_cut=1e-7).sample(Grid.square(SIDE, 64))
    with pytest.raises(InputError, match=r"long_cut = 0\.0005: expected at most the period, 0\.0004 m"):
        rough().sample(Grid.square(4e-4, 64, periodic=True))
    narrow = rough(long_cut=0.71 * SIDE, roll_off=0.71 * SIDE, short_cut=0.7091 * SIDE)
    with pytest.raises(InputError, match="a wave of the periodic domain"):
        narrow.sample(Grid.square(SIDE, 64, periodic=True))


@pytest.mark.parametrize("hurst", [0.3, 0.8, 1.0])
@pytest.mark.parametrize("roll_off", [2e-4, 5e-4])
def test_moments_are_the_integrals_of_the_psd(hurst: float, roll_off: float) -> None:
    surface = rough(hurst=hurst, roll_off=roll_off, anisotropy=2.0, lay=0.4)
    for order in (0, 2, 4):
        exact = integral(lambda q, n=order: q**n, vars(surface))
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
    h = spacing
    seen = integral(lambda q: (1 - j0(2 * q * h)) / (2 * h**2)) / integral(lambda q: q**2 / 2)
    bends = integral(lambda q: (6 - 8 * j0(q * h) + 2 * j0(2 * q * h)) / h**4)
    bent = bends / integral(lambda q: 3 * q**4 / 8)
    assert rough().missed(spacing) == pytest.approx((1 - math.sqrt(seen), 1 - math.sqrt(bent)), rel=1e-7)


def falling(qx: Array, qy: Array) -> Array:
    q = np.hypot(qx, qy)
    return np.where((q > 0) & (q <= 70), 1 / (1 + q) ** 1.8, 0.0)


@pytest.mark.parametrize("shear", [0.0, 0.37, -2.0])
@pytest.mark.parametrize("count", [(15, 25), (70, 3), (0, 4), (64, 63)])
def test_the_field_is_the_plain_sum_of_waves(shear: float, count: tuple[int, int]) -> None:
    torus = PeriodicLattice((1.3, 2.1), count, shear)
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


def test_wave_vectors_are_the_gradients_of_the_phases() -> None:
    torus = PeriodicLattice((1.3, 2.1), (3, 3), 0.4)
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
    torus = PeriodicLattice.holding((2.0, 1.0), (0.5, 0.25), lambda *why: refused.append(why))
    assert torus.waves == (4, 4)
    assert not refused
    PeriodicLattice.holding((2.0, 1.0), (2.0 / 8191, 1.0), lambda *why: refused.append(why))
    ((factor, limit),) = refused
    assert factor == pytest.approx((2 * 8191 + 1) / MAX_WAVES)
    assert limit == "8192 waves an axis"


def test_a_lay_is_described_where_there_is_one() -> None:
    grid = Grid.square(SIDE, 256)
    (text,) = rough(anisotropy=2.0, lay=math.pi / 6).describe(grid)
    assert "seed 1: Hurst exponent 0.8" in text
    assert "stretched 2 times along a lay of 30 degrees; rms height" in text
    assert "(rms given)" in text
    assert "stretched" not in rough().describe(grid)[0]
