"""Roughness parameters and statistics against analytic values and surfalize; fits of random roughness."""

from __future__ import annotations

import math
import re
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import refimpl as rf
from refimpl.measured.areal_parameters import (
    Autocorrelation,
    core_parameters,
    developed_area,
    mean_square_slopes,
    nayak,
)
from refimpl.measured.inspection import PARAMETERS
from refimpl.measured.roughness_fit import _drawn, _gaussian_psd, _self_affine_psd, fit_roughness
from refimpl.measured.spectrum import Spectrum
from refimpl.surfaces import statistics as stats

SHAPE, PIXEL = (256, 200), (1e-6, 1.5e-6)
GAUSSIAN = {"rms": 1e-6, "lx": 20e-6, "ly": 20e-6}
WITH_LAY = {"rms": 1e-6, "lx": 45e-6, "ly": 15e-6, "lay": 0.5}
FRACTAL = {"hurst": 0.8, "rms": 1e-6, "roll_off": 60e-6, "long_cut": 300e-6, "short_cut": 4e-6}


def gaussian(values: dict[str, float] = GAUSSIAN, seed: int = 0) -> np.ndarray:
    rng = np.random.default_rng(seed)
    return _drawn(SHAPE, PIXEL, _gaussian_psd(values), values["rms"], rng)


def inspected(folder: Path, z: np.ndarray, **keys: Any) -> rf.Inspection:
    """The inspection of a file with that map, in m unless stated."""
    np.save(folder / "a.npy", z)
    return rf.inspect_surface(folder / "a.npy", **{"unit": "m", "pixel_size": PIXEL} | keys)


# --- analytic values ---


def test_a_sine() -> None:
    """Amplitude a, 8 waves of 64 points along x.

    The difference of neighbours is the slope times sinc(1/64); Nayak's parameter of a profile of one wave is
    1, here the mean over x and y of m4 doubles: m0 m4 / m2^2 = (m4/2) / (m2/2)^2 = 2.
    """
    a, n = 3e-7, 64
    z = a * np.sin(2 * np.pi * (np.arange(8 * n) + 0.5) / n)[:, None] * np.ones(40)
    slope_x, slope_y = mean_square_slopes(z, (1e-6, 1e-6))
    exact = (a * 2 * math.pi / (n * 1e-6) * np.sinc(1 / n)) ** 2 / 2
    assert slope_x == pytest.approx(exact, rel=2e-2)  # 8 waves less one point
    assert slope_y == 0
    assert nayak(z, (1e-6, 1e-6)) == pytest.approx(2, rel=2e-2)
    acf = Autocorrelation.of(z, (1e-6, 1e-6))
    expected = np.cos(2 * np.pi * acf.lags[0] / (n * 1e-6))
    # of the 256 points left at the longest lag the mean of cos(2 k x) is below 1 / (256 sin(2 pi / 64))
    np.testing.assert_allclose(acf.values[:, acf.values.shape[1] // 2], expected, rtol=0, atol=0.04)


def test_a_sphere_cap(tmp_path: Path) -> None:
    """On a square of side s a paraboloid of radius R has Sq^2 = s^4 / (360 R^2), Sz = s^2 / (4 R),
    Sdq^2 = s^2 / (6 R^2); the sphere is one up to (s / R)^2."""
    n, edge, radius = 120, 1e-6, 1e-2
    x = (np.arange(n) - (n - 1) / 2) * edge
    cap = np.sqrt(radius**2 - x[:, None] ** 2 - x[None, :] ** 2)
    found = inspected(tmp_path, cap, pixel_size=edge, level="mean").parameters
    s = n * edge
    assert found["Sq"] == pytest.approx(s**2 / (math.sqrt(360) * radius), rel=2e-4)
    assert found["Sz"] == pytest.approx(s**2 / (4 * radius), rel=2e-2)  # of points, not up to the corners
    assert found["Sdq"] == pytest.approx(s / (math.sqrt(6) * radius), rel=1e-2)
    sphere = inspected(tmp_path, cap, pixel_size=edge, level="sphere")
    assert sphere.radius == pytest.approx(radius, rel=1e-6)
    assert sphere.parameters["Sq"] < 1e-6 * found["Sq"]


# --- another program ---


@pytest.mark.parametrize(
    ("values", "stated"),
    [
        (GAUSSIAN, {"Sq": 1.0418817762834056e-06, "Sa": 8.231806315161034e-07, "Sz": 7.305411914321235e-06,
                    "Ssk": 0.08408424239727362, "Sku": 3.0588493884491617, "Sdq": 0.15086545103148152,
                    "Sal": 16.6256256e-06, "Str": 0.9046110459, "Sdr": 0.01125088298685073,
                    "Sk": 2.5266070116e-06, "Spk": 1.1083438924e-06, "Svk": 0.9723462009e-06,
                    "Sp": 3.6103738703226136e-06, "Sv": 3.695038043998621e-06}),
        (WITH_LAY | {"lx": 40e-6, "ly": 12e-6},
         {"Sq": 1.0457382149859178e-06, "Sa": 8.273905973891109e-07, "Sz": 7.030523906113201e-06,
          "Ssk": 0.005422502325881285, "Sku": 3.0151346364602905, "Sdq": 0.19106831813132177,
          "Sal": 10.2528363e-06, "Str": 0.3300421174, "Sdr": 0.017834153121179197,
          "Sk": 2.5526311466e-06, "Spk": 1.0132914552e-06, "Svk": 1.0105785630e-06}),
    ],
    ids=["isotropic", "lay"],
)  # fmt: skip
def test_parameters_agree_with_surfalize(
    tmp_path: Path, values: dict[str, float], stated: dict[str, float]
) -> None:
    """Numbers of surfalize 0.19.2 on these maps, levelled by a plane; Sal to Svk are of sampled curves."""
    rng = np.random.default_rng(2)
    drawn = _drawn((256, 256), (1e-6, 1e-6), _gaussian_psd(values), 1e-6, rng)
    found = inspected(tmp_path, drawn, pixel_size=1e-6).parameters
    for name, value in stated.items():
        sampled = {"Sal": 1e-3, "Str": 1e-3, "Sk": 1e-3, "Spk": 5e-3, "Svk": 5e-3}
        assert found[name] == pytest.approx(value, rel=sampled.get(name, 1e-9)), name


# --- missing points, lay, what a map does not tell ---


def test_curves_are_numbers_with_their_normalisation(tmp_path: Path) -> None:
    """The sum of C over the lattice of q is (2 pi)^2 Sq^2 per cell, but for the window: 8 draws to 10 %."""
    cell = 1.0 / (math.prod(SHAPE) * math.prod(PIXEL))  # d^2q / (2 pi)^2
    spectra = [Spectrum.of(gaussian(seed=k), PIXEL) for k in range(8)]
    assert np.mean([s.count @ s.C * cell for s in spectra]) == pytest.approx(1e-12, rel=0.1)
    found = inspected(tmp_path, gaussian(seed=3))
    curves = found.document()["curves"]
    assert "(2 pi)^-2 int C d^2q" in curves["spectrum"]["normalisation"]
    assert len(curves["spectrum"]["q"]) == len(curves["spectrum"]["C"])
    correlation = curves["autocorrelation"]
    assert (correlation["lag_x"][0], correlation["x"][0], correlation["y"][0]) == (0, 1, 1)
    assert correlation["lag_y"][-1] == pytest.approx(100 * 1.5e-6)
    bearing = curves["bearing_curve"]
    assert (bearing["height"][0], -bearing["height"][-1]) == pytest.approx(
        (found.parameters["Sp"], found.parameters["Sv"])
    )
    assert core_parameters(np.arange(4e4)) == pytest.approx({"Sk": 4e4 - 1, "Spk": 0, "Svk": 0}, abs=1e-6)
    # Sdr of a plane is sqrt(1 + slope^2) - 1
    plane = 0.3 * np.arange(9.0)[:, None] + 0.2 * np.arange(7.0)
    assert developed_area(plane, (1.0, 1.0)) == pytest.approx(math.sqrt(1.13) - 1, rel=1e-12)


@pytest.mark.parametrize(("hurst", "roll_off", "short_cut"), [(0.3, 256, 2), (0.8, 64, 8)])
def test_the_hurst_exponent_is_within_its_deviation(
    tmp_path: Path, hurst: float, roll_off: float, short_cut: float
) -> None:
    """Of four draws each at least three are within two deviations, whatever roll-off and finest wave."""
    cuts = {"roll_off": roll_off * 1e-6, "long_cut": 256e-6, "short_cut": short_cut * 1e-6}
    values = {"hurst": hurst, "rms": 1e-6, **cuts}
    within = 0
    for seed in range(4):
        drawn = _drawn((256, 256), (1e-6, 1e-6), _self_affine_psd(values), 1e-6, np.random.default_rng(seed))
        found = inspected(tmp_path, drawn, pixel_size=1e-6)
        assert found.deviations["hurst"] < 0.1
        within += abs(found.parameters["hurst"] - hurst) <= 2 * found.deviations["hurst"]
    assert within >= 3


@pytest.mark.parametrize("degrees", [0, 135])
def test_a_lay_of_grooves_and_of_the_transposed_map(tmp_path: Path, degrees: int) -> None:
    """Their autocorrelation does not fall along them; those of the transposed map lie at 90 deg less."""
    turn, rng = math.radians(degrees), np.random.default_rng(5)
    x, y = np.arange(120.0)[:, None], np.arange(120.0)[None, :]
    across = math.cos(turn) * y - math.sin(turn) * x
    z = np.sin(across / 3.0) + 0.6 * np.sin(across / 4.3 + 1.0) + 0.05 * rng.normal(size=(120, 120))
    for heights, lay in ((z, degrees), (z.T, 90 - degrees)):
        found = inspected(tmp_path, heights, pixel_size=1e-6).parameters["lay_deg"]
        assert abs((found - lay + 90) % 180 - 90) < 2
    assert math.isnan(inspected(tmp_path, gaussian(seed=4)).parameters["lay_deg"])


@pytest.mark.parametrize("holes", ["scattered", "one"])
def test_a_slope_of_the_spectrum_that_holes_decide_is_no_number(tmp_path: Path, holes: str) -> None:
    """A slope that is stated is within three deviations of that of the map without holes."""
    z, rng = gaussian(seed=6), np.random.default_rng(6)
    whole = inspected(tmp_path, z)
    if holes == "scattered":
        z[rng.random(z.shape) < 0.01] = np.nan
    else:
        z[100:140, 90:130] = np.nan
    found = inspected(tmp_path, z)
    if holes != "one":
        away = abs(found.parameters["hurst"] - whole.parameters["hurst"])
        assert away <= 3 * found.deviations["hurst"]
        assert found.document()["deviations"]["psd_slope"] == 2 * found.deviations["hurst"]
    else:
        assert math.isnan(found.parameters["hurst"])
        assert math.isnan(found.deviations["psd_slope"])


def test_the_misfit_is_less_for_the_kind_that_the_map_is_of() -> None:
    """With a hole, which drawn maps have as well."""
    draws = {
        "gaussian": gaussian(seed=7),
        "self-affine": _drawn(SHAPE, PIXEL, _self_affine_psd(FRACTAL), 1e-6, np.random.default_rng(7)),
    }
    for own, z in draws.items():
        z[60:64, 70:75] = np.nan
        fits = {kind: fit_roughness(z, PIXEL, kind, 8) for kind in draws}
        assert min(fits, key=lambda kind: fits[kind].misfit[0]) == own
        assert fits[own].misfit[0] < 1.0
        assert f"# misfit {fits[own].misfit[0]:.2g}, drawn maps" in fits[own].toml()
        assert [kind for kind in draws if "warning: the map is not" in fits[kind].toml()] == (
            ["gaussian"] if own == "self-affine" else []
        )


def test_what_the_map_does_not_tell_is_no_number(tmp_path: Path) -> None:
    ridge = np.sin(np.arange(60) / 20)[:, None] * np.ones(50)
    found = inspected(tmp_path, ridge, unit="um", pixel_size=1e-6).parameters
    assert set(found) == set(PARAMETERS)
    assert math.isnan(found["Str"])
    assert math.isnan(found["le_along"])
    board = np.where(np.indices((8, 8)).sum(axis=0) % 2, np.nan, np.arange(64.0).reshape(8, 8))
    assert all(map(math.isnan, mean_square_slopes(board, (1.0, 1.0))))  # no two neighbours


def test_an_inspection_says_what_the_file_holds(tmp_path: Path) -> None:
    z = gaussian()
    z[0, 0] = np.nan
    document = inspected(tmp_path, z * 1e6, unit="um", size=(100e-6, 60e-6)).document()
    assert document["points"] == [256, 200]
    assert document["missing"] == 1
    assert document["window"] == {"points": [100, 40], "missing": 0}
    assert document["unit"] == "um"
    assert document["size"] == pytest.approx([256e-6, 300e-6])
    surface = rf.MeasuredSurface(tmp_path / "a.npy", unit="um", pixel_size=PIXEL, max_missing=0.1)
    assert rf.inspect_surface(surface).parameters["Sq"] == pytest.approx(np.nanstd(z), rel=0.05)


def test_a_text_without_a_header_is_named_as_such_and_turned_by_the_angle_of_the_note(tmp_path: Path) -> None:
    z = gaussian()[:60, :40] * 1e6
    np.savetxt(tmp_path / "image.txt", z.T[::-1])  # lines along x, the first at the top
    edges: dict[str, Any] = {"unit": "um", "pixel_size": 1e-6}
    found = rf.inspect_surface(tmp_path / "image.txt", **edges)
    (note,) = (note for note in found.document()["notes"] if "no header" in note)
    degrees = float(re.findall(r"rotate_deg = (-?\d+)", note)[0])
    turned = rf.inspect_surface(tmp_path / "image.txt", rotate_deg=degrees, **edges)
    assert not [note for note in turned.document()["notes"] if "no header" in note]
    array = inspected(tmp_path, z, **edges)
    assert not [note for note in array.document()["notes"] if "no header" in note]
    np.testing.assert_allclose(turned.z, array.z, atol=1e-12)


# --- fits ---


@pytest.mark.parametrize("values", [GAUSSIAN, WITH_LAY], ids=["isotropic", "lay"])
def test_a_gaussian_surface_comes_back_within_its_deviations(values: dict[str, float]) -> None:
    fit = fit_roughness(gaussian(values, 1), PIXEL, "gaussian")
    for name, value in values.items():
        assert abs(fit.values[name] - value) < 4 * fit.deviations[name], name
        assert fit.deviations[name] < 0.15 * value
    assert ("lay" in fit.values) == ("lay" in values)


def test_fits_of_a_lay_and_of_self_affine_maps_are_surfaces_too() -> None:
    """Drawn by the surfaces themselves, fitted, and read back from TOML with those values."""
    grid = rf.Grid(SHAPE, (256e-6, 300e-6))
    lay = rf.GaussianRoughness(1e-6, (45e-6, 15e-6), seed=3, lay=0.5)
    fractal = rf.SelfAffineRoughness(
        hurst=0.8, rms=1e-6, roll_off=60e-6, long_cut=250e-6, short_cut=6e-6, seed=2, anisotropy=3.0, lay=2.0
    )
    for surface, kind in ((lay, "gaussian"), (fractal, "self-affine")):
        fit = fit_roughness(surface.sample(grid), PIXEL, kind, 8)
        text = fit.toml(seed=9)
        assert f'kind = "{kind.replace("-", "_")}"' in text
        assert "  # +- " in text or "  # m +- " in text
        back = rf.surfaces.surface_from_dict(tomllib.loads(text))
        assert isinstance(back, type(surface))
        assert abs(fit.values["lay"] - surface.lay) < 4 * fit.deviations["lay"]
        if kind == "gaussian":
            assert back.correlation_length == pytest.approx((fit.values["lx"], fit.values["ly"]), rel=1e-5)
        assert getattr(back, "rms", 0) == pytest.approx(1e-6, rel=0.3)


@pytest.mark.parametrize(("kind", "z"), [("fractal", gaussian()), ("gaussian", np.zeros((40, 40)))])
def test_fits_that_cannot_be(kind: str, z: np.ndarray) -> None:
    with pytest.raises(rf.InputError, match="fit"):
        fit_roughness(z, PIXEL, kind)


N = 64
X = (np.arange(N) + 0.5) / N


def test_slopes_are_exact_for_bilinear_heights_and_know_their_axis() -> None:
    z = 0.3 * X[:, None] - 2.0 * X[None, :]
    dz_dx, dz_dy = stats.slopes(z, 1 / N)
    np.testing.assert_allclose(dz_dx, 0.3, rtol=1e-12)
    np.testing.assert_allclose(dz_dy, -2.0, rtol=1e-12)
    np.testing.assert_allclose(stats.rms_slopes(z, 1 / N), (0.3, 2.0), rtol=1e-12)


def test_autocorrelation_is_the_plain_sum_over_pairs() -> None:
    z = np.random.default_rng(1).normal(size=(9, 6))
    d = z - z.mean()
    for axis in (0, 1):
        rows = np.moveaxis(d, axis, 0)
        expected = [np.mean(rows[: len(rows) - k] * rows[k:]) / np.mean(d**2) for k in range(len(rows))]
        np.testing.assert_allclose(stats.autocorrelation(z, axis), expected, rtol=0, atol=1e-13)


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
