"""Self-affine roughness: spectrum, statistics, one surface per seed, what is refused.

The spectrum is written out here anew. A wave of the torus and its opposite have ``2 |Z|^2 / a^2`` of
chi-square with two degrees of freedom, Z their coefficient and a^2 a wave's mean square, all independent.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

import refimpl as rf
from refimpl.errors import InputError
from refimpl.grid import Array, Grid
from refimpl.surfaces import SelfAffineRoughness, SurfaceWarning, surface_from_dict

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


class Modes:
    """Coefficients of periodic heights of unit rms, and the mean squares a^2 that they should have."""

    def __init__(self, z: Array, lengths: tuple[float, float], power: Any) -> None:
        M, N = z.shape
        qx, qy = (2 * math.pi * np.fft.fftfreq(n, L / n) for n, L in zip(z.shape, lengths, strict=True))
        self.qx, self.qy = np.broadcast_arrays(qx[:, None], qy[None, :])
        self.coefficients = np.fft.fft2(z) / (M * N)
        self.expected = power(self.qx, self.qy)
        half = (qx[:, None] > 0) | ((qx[:, None] == 0) & (qy[None, :] > 0))
        self.half = half & (self.expected > 0)

    def chi_square(self, where: Array) -> tuple[float, int]:
        """Sum over the waves of a band, and its degrees of freedom."""
        band = self.half & where
        return float((2 * np.abs(self.coefficients[band]) ** 2 / self.expected[band]).sum()), 2 * int(
            band.sum()
        )


def isotropic(qx: Array, qy: Array) -> Array:
    power = shape(np.hypot(qx, qy))
    return power / power.sum()


def periodic_modes(seed: int, **changed: Any) -> Modes:
    grid = Grid((160, 144), (SIDE, 0.9 * SIDE), periodic=True)
    return Modes(rough(rms=1.0, seed=seed, **changed).sample(grid), grid.lengths, isotropic)


def free_torus(seed: int) -> Modes:
    """The whole period of a free surface, 8 long cuts, put together from 16 slides of one domain."""
    grid = Grid.square(SIDE, 128)
    surface = rough(rms=1.0, seed=seed)
    tiles = [[surface.sample(grid, (i * SIDE, j * SIDE)) for j in range(4)] for i in range(4)]
    return Modes(np.block(tiles), (4 * SIDE, 4 * SIDE), isotropic)


@pytest.fixture(scope="module")
def ensembles() -> dict[str, list[Modes]]:
    """Seeds 1 to 12 periodic, 1 to 3 free: fixed before anything was looked at."""
    return {
        "periodic": [periodic_modes(seed) for seed in range(1, 13)],
        "free": [free_torus(seed) for seed in range(1, 4)],
    }


@pytest.mark.parametrize("kind", ["periodic", "free"])
def test_psd_is_within_chi_square_bounds_in_every_band(kind: str, ensembles: dict[str, list[Modes]]) -> None:
    """Thirds of octaves from the long cut to the short one; four standard errors, sqrt(2 / freedoms)."""
    edges = 2 * math.pi / PARAMETERS["long_cut"] * 2.0 ** (np.arange(15) / 3 - 1e-6)
    bands = 0
    for low, high in pairwise(edges):
        total, freedoms = 0.0, 0
        for modes in ensembles[kind]:
            q = np.hypot(modes.qx, modes.qy)
            part, n = modes.chi_square((q >= low) & (q < high))
            total, freedoms = total + part, freedoms + n
        assert freedoms > 50
        assert abs(total / freedoms - 1) < 4 * math.sqrt(2 / freedoms)
        bands += 1
    assert bands == 14


@pytest.mark.parametrize("kind", ["periodic", "free"])
def test_spectrum_is_zero_beyond_its_cuts(kind: str, ensembles: dict[str, list[Modes]]) -> None:
    for modes in ensembles[kind][:2]:
        outside = np.abs(modes.coefficients[modes.expected == 0]).max()
        assert outside < 1e-15  # of heights of unit rms; the smallest inside are 1e-4


@pytest.mark.parametrize("kind", ["periodic", "free"])
def test_rms_height_and_gradient(kind: str, ensembles: dict[str, list[Modes]]) -> None:
    """Mean squares over the period: sums of a^2 w^2, of variance 2 sum a^4. The gradient's expectation is
    that of the waves there are; the integral's is near to it."""
    for power in (0, 2):
        found, expected, variance = 0.0, 0.0, 0.0
        for modes in ensembles[kind]:
            weight = np.hypot(modes.qx, modes.qy) ** power
            found += float((weight * np.abs(modes.coefficients) ** 2).sum())
            expected += float((weight * modes.expected).sum())
            variance += 2 * float((weight**2 * modes.expected**2).sum())
        assert abs(found - expected) < 4 * math.sqrt(variance)
        of_one = expected / len(ensembles[kind])
        integral = 1.0 if power == 0 else rough(rms=1.0).rms_gradient ** 2
        assert of_one == pytest.approx(integral, rel=1e-12 if power == 0 else 0.05)


def test_lay_stretches_the_spectrum() -> None:
    """Periodic: chi-square of each wave by C(sqrt(g^2 q_along^2 + q_across^2)), in bands and in sectors."""
    g, lay = 3.0, 0.7

    def stretched(qx: Array, qy: Array) -> Array:
        along, across = qx * math.cos(lay) + qy * math.sin(lay), qy * math.cos(lay) - qx * math.sin(lay)
        power = shape(np.sqrt(g**2 * along**2 + across**2))
        return power / power.sum()

    grid = Grid.square(SIDE, 160, periodic=True)
    totals = dict.fromkeys(range(6), (0.0, 0))
    for seed in range(1, 13):
        z = rough(rms=1.0, seed=seed, anisotropy=g, lay=lay).sample(grid)
        modes = Modes(z, grid.lengths, stretched)
        assert np.abs(modes.coefficients[modes.expected == 0]).max() < 1e-15
        angle = np.mod(np.arctan2(modes.qy, modes.qx), math.pi)
        for sector, (total, freedoms) in totals.items():
            part, n = modes.chi_square((angle >= sector * math.pi / 6) & (angle < (sector + 1) * math.pi / 6))
            totals[sector] = total + part, freedoms + n
    for total, freedoms in totals.values():
        assert freedoms > 200
        assert abs(total / freedoms - 1) < 4 * math.sqrt(2 / freedoms)


def test_lay_of_a_free_surface() -> None:
    """Covariance at lags in the lay's frame is the isotropic one at (along / g, across): products averaged
    over 40 seeds and a grid of points, against the sum over the isotropic torus' waves. Spread between seeds
    gives the standard error: four of them with Student's t of 39 freedoms, 3e-4."""
    g, lay = 2.5, 0.6
    isotropic_torus = rough(rms=1.0, short_cut=8e-5)._torus(Grid.square(SIDE, 16))
    k, across = (np.arange(-n, n + 1.0) for n in isotropic_torus.waves)
    qx, qy = isotropic_torus.wave_vectors(k, across)
    power = shape(np.hypot(qx, qy), PARAMETERS | {"short_cut": 8e-5})
    # along, across
    lags = [(0.0, 0.0), (6e-5, 0.0), (0.0, 6e-5), (1.5e-4, 0.0), (0.0, 1.2e-4), (6e-5, -6e-5)]
    products = []
    grid = Grid.square(2 * SIDE, 12)
    for seed in range(40):
        surface = rough(rms=1.0, short_cut=8e-5, seed=seed, anisotropy=g, lay=lay)
        z = surface.sample(grid)
        offsets = [
            (a * math.cos(lay) - c * math.sin(lay), a * math.sin(lay) + c * math.cos(lay)) for a, c in lags
        ]
        products.append([np.mean(z * surface.sample(grid, offset)) for offset in offsets])
    error = np.std(products, axis=0, ddof=1) / math.sqrt(len(products))
    for found, spread, (a, c) in zip(np.mean(products, axis=0), error, lags, strict=True):
        exact = float((power * np.cos(qx * a / g + qy * c)).sum() / power.sum())
        assert abs(found - exact) < 4 * spread
    assert error.max() < 0.1


@pytest.mark.parametrize(
    "changed", [{}, {"anisotropy": 3.0, "lay": 0.7}, {"rms_gradient": 0.1, "hurst": 1.0}]
)
@pytest.mark.parametrize("periodic", [False, True])
def test_one_surface_on_every_grid_and_at_every_offset(changed: dict[str, float], periodic: bool) -> None:
    surface, lengths = rough(**changed), (SIDE, 0.8 * SIDE)
    rms = surface.rms
    coarse, middle, fine = (surface.sample(Grid((M, M), lengths, periodic)) for M in (63, 189, 567))
    np.testing.assert_allclose(middle[1::3, 1::3], coarse, rtol=0, atol=1e-12 * rms)
    np.testing.assert_allclose(fine[4::9, 4::9], coarse, rtol=0, atol=1e-12 * rms)
    grid = Grid((63, 63), lengths, periodic)
    slid = surface.sample(grid, (5 * grid.spacings[0], -9 * grid.spacings[1]))
    np.testing.assert_allclose(slid[:-5, 9:], coarse[5:, :-9], rtol=0, atol=1e-12 * rms)
    if periodic:
        again = surface.sample(grid, (3 * lengths[0], -lengths[1]))
        np.testing.assert_allclose(again, coarse, rtol=0, atol=1e-12 * rms)
        rolled = surface.sample(grid, (5 * grid.spacings[0], -70 * grid.spacings[1]))
        np.testing.assert_allclose(rolled, np.roll(coarse, (-5, 70), (0, 1)), rtol=0, atol=1e-12 * rms)
    else:  # a domain of nearly the same size: the same plane, the same corner
        smaller = surface.sample(Grid((45, 42), (45 / 63 * lengths[0], 42 / 63 * lengths[1])))
        np.testing.assert_allclose(smaller, coarse[:45, :42], rtol=0, atol=1e-12 * rms)


def test_a_free_surface_repeats_far_from_its_domain_only() -> None:
    surface, grid = rough(), Grid.square(SIDE, 32)
    z = surface.sample(grid)
    period = 8 * 5e-4
    np.testing.assert_allclose(surface.sample(grid, (period, -2 * period)), z, rtol=0, atol=1e-17)
    for shift in (SIDE, 2 * SIDE, 3 * SIDE):
        assert abs(np.corrcoef(surface.sample(grid, (shift, 0.0)).ravel(), z.ravel())[0, 1]) < 0.5


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
    assert rough().cautions(Grid.square(SIDE, 200)) == ()
    slope, curvature = rough().missed(SIDE / 100)
    (said,) = rough().cautions(Grid.square(SIDE, 100))
    assert f"misses {slope:.0%} of the rms slope and {curvature:.0%} of the rms curvature" in said


def test_a_solution_warns_of_the_short_cut() -> None:
    steel = rf.Material(E=200e9, nu=0.3)
    scene = rf.Scene(
        upper=rf.Body(steel, rf.Flat()),
        lower=rf.Body(steel, rough()),
        friction=rf.Friction(),
        load=5.0,
        side=SIDE,
    )
    coarse = rf.solve(scene, 64, oblique=False)
    named = [warning for warning in coarse.warnings if warning.limit == "shortest wave"]
    assert len(named) == 1
    assert named[0].number == pytest.approx(1.28)
    assert "of the rms curvature" in named[0]
    fine = rf.solve(scene, 200, oblique=False)
    assert not [warning for warning in fine.warnings if warning.limit == "shortest wave"]


def test_what_it_is_is_said() -> None:
    (said,) = rough(anisotropy=2.0, lay=math.pi / 6).describe(Grid.square(SIDE, 256))
    parts = (
        "seed 1",
        "Hurst exponent 0.8",
        "0.0005 m",
        "2e-05 m",
        "stretched 2 times",
        "30 degrees",
        "(rms given)",
    )
    assert all(part in said for part in parts)
    assert "stretched" not in rough().describe(Grid.square(SIDE, 256))[0]


@pytest.mark.parametrize(
    ("changed", "field"),
    [
        ({"hurst": 0.0}, "hurst"),
        ({"hurst": 1.01}, "hurst"),
        ({"roll_off": 6e-4}, "long_cut"),
        ({"short_cut": 2e-4}, "short_cut"),
        ({"long_cut": -1.0}, "long_cut"),
        ({"rms": None}, "rms, rms_gradient"),
        ({"rms": 0.0}, "rms"),
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


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"hurst": None}, "surface.hurst"),
        ({"colour": 1}, "surface.colour"),
        ({"given": "rms"}, "surface.given"),
        ({"rms_gradient": 0.1}, "surface.rms, rms_gradient = 'both'"),
        ({"rms": None}, "surface.rms, rms_gradient = 'neither'"),
        ({"hurst": 1.5}, "surface.hurst = 1.5"),
    ],
)
def test_tables_are_checked(change: dict[str, Any], said: str) -> None:
    table = {key: v for key, v in ({"kind": "self_affine"} | PARAMETERS | change).items() if v is not None}
    with pytest.raises(InputError) as refusal:
        surface_from_dict(table)
    assert said in str(refusal.value)


def test_tables_hold_the_given_size_alone() -> None:
    for surface in (rough(anisotropy=2.0), rough(rms_gradient=0.1, lay=0.3)):
        table = surface.to_dict()
        assert len({"rms", "rms_gradient"} & table.keys()) == 1
        assert surface_from_dict(table) == surface
