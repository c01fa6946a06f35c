"""Preparation of measured maps: forms, outliers, Gaussian filters."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from refimpl.errors import InputError
from refimpl.grid import Grid
from refimpl.measured import MeasuredSurface
from refimpl.measured.detrending import fit_form
from refimpl.measured.preparation import gaussian_filter, prepare
from refimpl.measured.reading import RawHeights
from refimpl.measured.roughness_fit import _drawn, _gaussian_psd
from tests.refimpl.surfaces.measured import quietly

PIXEL = (1e-6, 1.5e-6)
X, Y = np.arange(96.0), np.arange(64.0)
AT_X, AT_Y = X[:, None] * PIXEL[0], Y[None, :] * PIXEL[1]


def ball(radius: float, tilt: tuple[float, float] = (0.0, 0.0)) -> np.ndarray:
    """A spherical cap over the map, its top displaced by ``tilt`` times the radius; negative: hollow."""
    x, y = AT_X - AT_X.mean() + tilt[0] * radius, AT_Y - AT_Y.mean() + tilt[1] * radius
    return np.asarray(math.copysign(1.0, radius) * np.sqrt(radius**2 - x**2 - y**2))


def roller(radius: float, degrees: float) -> np.ndarray:
    """A cylinder whose axis lies at that angle to x."""
    turn = math.radians(degrees)
    across = math.cos(turn) * (AT_Y - AT_Y.mean()) - math.sin(turn) * (AT_X - AT_X.mean())
    return np.asarray(math.copysign(1.0, radius) * np.sqrt(radius**2 - across**2))


def holes(z: np.ndarray) -> np.ndarray:
    holed = z.copy()
    holed[:20, :15] = holed[50:60, 30:40] = np.nan
    return holed


# --- form ---


@pytest.mark.parametrize(
    ("level", "radius", "z"),
    [
        *(("sphere", R, ball(R, tilt)) for R in (3e-4, -3e-4, 5e-2) for tilt in ((0.0, 0.0), (0.05, -0.08))),
        *(("cylinder", R, roller(R, angle)) for R in (4e-4, -4e-4) for angle in (0, 20, 90, 135)),
    ],
)
def test_a_ball_or_roller_is_found_and_subtracted(level: str, radius: float, z: np.ndarray) -> None:
    form = fit_form(X, Y, holes(z), level, PIXEL)
    assert form.radius == pytest.approx(radius, rel=1e-6)
    np.testing.assert_allclose(form(X, Y), z, rtol=0, atol=1e-9 * np.ptp(z))


@pytest.mark.parametrize("degree", [3, 4, 7])
def test_polynomials_of_higher_degree(degree: int) -> None:
    """What is of that degree goes to rounding, with points missing as well; one power more stays."""
    u, v = X[:, None] / 48 - 1, Y[None, :] / 32 - 1
    z = (u + 0.5 * v) ** degree - u * v
    for part in (z, holes(z)):
        form = fit_form(X, Y, part, degree)
        np.testing.assert_allclose(form(X, Y), z, rtol=0, atol=1e-9)
    more = (u + 0.5 * v) ** (degree + 1)
    assert np.std(more - fit_form(X, Y, more, degree)(X, Y)) > 1e-3


# --- outliers ---


def reading_of(z: np.ndarray, pixel: tuple[float, float] = PIXEL) -> RawHeights:
    return RawHeights(z, pixel, "map", "by hand")


def test_outliers_become_missing_and_nothing_else() -> None:
    rng = np.random.default_rng(4)
    z = 1e-8 * rng.normal(size=(80, 70)) + 1e-6 * np.sin(np.arange(80) / 12)[:, None]
    spikes = [(5, 5), (40, 33), (78, 1), (30, 60), (30, 61)]
    for k, place in enumerate(spikes):
        z[place] += (-1) ** k * 5e-7
    z[10, 10] = np.nan
    found = prepare(reading_of(z), outliers=8)
    assert [tuple(at) for at in np.argwhere(np.isnan(found.heights))] == sorted([*spikes, (10, 10)])
    assert found.notes[-1].startswith("5 outliers, more than 8 spreads ")


@pytest.mark.parametrize("length", [3e-6, 10e-6, 60e-6])
def test_peaks_and_noise_are_no_outliers(length: float) -> None:
    spectrum = _gaussian_psd({"lx": length, "ly": length})
    z = _drawn((150, 120), PIXEL, spectrum, 1e-6, np.random.default_rng(0))
    noise = np.random.default_rng(0).normal(size=(150, 120))
    for clean in (z, noise, np.zeros((9, 9)), np.add.outer(np.arange(9.0), np.arange(9.0))):
        assert np.isfinite(prepare(reading_of(clean), outliers=6).heights).all()


def test_a_rough_border_goes_on_at_the_other_end_of_a_map_that_repeats() -> None:
    """Rows 38 and 37 are forty times as rough: beside them a spike of 20 deviations is no outlier."""
    z = np.random.default_rng(6).normal(size=(40, 30))
    z[37:39] *= 40.0
    z[[0, 20], 12] += 20.0
    found = prepare(reading_of(z), outliers=6, repeats=True).heights
    assert np.isnan(found[[0, 20], 12]).tolist() == [False, True]


# --- filters ---


@pytest.mark.parametrize(("wavelength", "passed"), [(16.0, 2**-4.0), (32.0, 0.5), (64.0, 2**-0.25)])
def test_a_wave_passes_as_iso_16610_says(wavelength: float, passed: float) -> None:
    """Transmission 2^-(cut-off / wavelength)^2: a half at the cut-off, here of 32 points; periodic."""
    wave = np.cos(2 * np.pi * np.arange(128) / wavelength)[:, None] * np.ones(32)
    np.testing.assert_allclose(
        gaussian_filter(wave, (1.0, 1.0), 32.0, repeats=True), passed * wave, rtol=0, atol=1e-14
    )
    found = gaussian_filter(wave, (1.0, 1.0), 32.0)
    np.testing.assert_allclose(found[33:-33], passed * wave[33:-33], rtol=0, atol=2e-6)


def test_the_filter_is_the_mean_with_gaussian_weights_within_the_border() -> None:
    """ISO 16610-21's weight exp(-pi (x / (alpha lambda))^2), alpha^2 = ln 2 / pi, scaled to a sum of one."""
    z = np.random.default_rng(1).normal(size=(40, 30))
    found = gaussian_filter(z, PIXEL, 24e-6)
    weights = []
    for n, edge in zip(z.shape, PIXEL, strict=True):
        away = (np.arange(n)[:, None] - np.arange(n)) * edge
        weight = np.exp(-np.pi * (away / 24e-6) ** 2 / (math.log(2) / math.pi))
        weights.append(weight / weight.sum(axis=1, keepdims=True))
    np.testing.assert_allclose(found, weights[0] @ z @ weights[1].T, rtol=0, atol=1e-12)


def test_low_and_high_pass_add_up_and_leave_a_plane_alone(tmp_path: Path) -> None:
    rng = np.random.default_rng(2)
    z = rng.normal(size=(60, 50)) + 3.0 * np.arange(60)[:, None] - 2.0 * np.arange(50)
    z[20:25, 30:36] = np.nan
    low, high = (prepare(reading_of(z), **{name: 9e-6}) for name in ("low_pass", "high_pass"))
    np.testing.assert_allclose(low.heights + high.heights, z, rtol=0, atol=1e-12 * np.nanmax(np.abs(z)))
    plane = 3.0 * np.arange(60)[:, None] - 2.0 * np.arange(50)
    np.testing.assert_allclose(
        prepare(reading_of(plane), low_pass=9e-6).heights, plane, rtol=0, atol=1e-12 * 200
    )
    np.testing.assert_allclose(
        prepare(reading_of(plane), high_pass=9e-6).heights, 0, rtol=0, atol=1e-12 * 200
    )
    assert "wavelengths below 9e-06 m were damped" in low.notes[-1]
    assert "wavelengths above 9e-06 m were damped" in high.notes[-1]


def test_a_scene_takes_the_filtered_map(tmp_path: Path) -> None:
    z = np.random.default_rng(3).normal(size=(96, 64)) * 1e-8
    np.save(tmp_path / "a.npy", z)
    keys = {"unit": "m", "pixel_size": PIXEL, "level": "none"}
    surface = MeasuredSurface(tmp_path / "a.npy", low_pass=6e-6, high_pass=40e-6, outliers=9, **keys)  # type: ignore[arg-type]
    grid = Grid((96, 64), (96e-6, 96e-6))
    expected = prepare(reading_of(z), 9, 6e-6, 40e-6).heights
    np.testing.assert_allclose(quietly(surface, grid), expected, rtol=0, atol=1e-18)
    told = "\n".join(surface.describe(grid))
    assert all(word in told for word in ("outliers", "below 6e-06", "above 4e-05"))
    table = surface.to_dict()
    solved = "\n".join(surface.notes(grid))  # among a solution's warnings
    assert all(word in solved for word in ("0 outliers", "below 6e-06", "within half of it, 2e-05 m,"))
    assert (table["low_pass"], table["high_pass"], table["outliers"]) == (6e-6, 40e-6, 9)


@pytest.mark.parametrize(
    ("keys", "refusal"),
    [
        *(({"level": level}, "level") for level in (11, -1, True, "cone", 2.5)),
        ({"outliers": 0}, "outliers"),
        ({"low_pass": -1e-6}, "low_pass"),
        ({"high_pass": "1 mm"}, "high_pass"),
        ({"low_pass": 2e-6, "high_pass": 1e-6}, "low_pass"),
        ({"low_pass": 2.9e-6}, r"low_pass = 2\.9e-06: expected at least two pixels of a.npy, each 1.5e-06 m"),
        ({"high_pass": 14e-6}, r"high_pass = 1\.4e-05: expected .* at most its longer side, 1\.35e-05 m"),
        ({"channel": True}, "channel"),
        ({"max_missing": -0.001}, r"max_missing = -0\.001: expected a fraction, 0 <= max_missing"),
    ],
)
def test_keys_out_of_range(tmp_path: Path, keys: dict[str, Any], refusal: str) -> None:
    np.save(tmp_path / "a.npy", np.zeros((9, 9)))
    with pytest.raises(InputError, match=refusal):
        MeasuredSurface(tmp_path / "a.npy", unit="m", pixel_size=PIXEL, **keys).heights(Grid.square(4e-6, 4))
