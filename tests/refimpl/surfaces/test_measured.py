"""Measured surfaces' heights: window, gaps, level, values by hand. All files are written here."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.interpolate import RectBivariateSpline

from refimpl.errors import InputError
from refimpl.grid import Grid
from refimpl.measured import MeasuredSurface
from refimpl.measured.detrending import DEGREES, fit
from refimpl.measured.missing_points import MAX_ELIMINATED, fill
from refimpl.measured.readers import read
from refimpl.measured.spectrum import Spectrum
from refimpl.surfaces import SurfaceWarning
from tests.refimpl.surfaces.measured import (
    DX,
    DY,
    NX,
    NY,
    RNG,
    ROUGH,
    SIDE,
    elements,
    points,
    quietly,
    write_npy,
)

# --- window and resampling ---


RECTANGLES = [
    Grid.square(SIDE, 7),
    Grid.square(SIDE, 24),
    Grid((12, 20), (8e-6, 4e-6)),  # longer along x
    Grid((9, 30), (3e-6, 8e-6)),
]


@pytest.mark.parametrize("offset", [(0.0, 0.0), (4e-7, -3.3e-6), (-5e-7, 3.5e-6)])
@pytest.mark.parametrize("grid", RECTANGLES, ids=str)
def test_heights_are_those_of_one_spline_through_all_points(
    tmp_path: Path, offset: tuple[float, float], grid: Grid
) -> None:
    """FITPACK's interpolating bicubic (not-a-knot as well) of the whole file, not of a window."""
    surface = write_npy(tmp_path / "a.npy", ROUGH)
    (x, y), (at_x, at_y) = points(), elements(grid, offset)
    whole = RectBivariateSpline(x.ravel(), y.ravel(), ROUGH)(at_x.ravel(), at_y.ravel())
    np.testing.assert_allclose(quietly(surface, grid, offset), whole, rtol=0, atol=1e-12 * np.ptp(whole))


MEASURED = r"side = {:g}: expected at most the measured 9e-06 x 1\.55e-05 m"
LEAST = r"side = {:g}: expected at least 4 pixels of a\.npy, each 1\.5e-07 x 3\.1e-07 m"


@pytest.mark.parametrize(
    ("grid", "offset", "refusal"),
    [
        (Grid.square(9.1e-6, 16), (0.0, 0.0), MEASURED.format(9.1e-6)),
        (Grid((16, 16), (9.1e-6, 1.5e-5)), (0.0, 0.0), MEASURED.format(9.1e-6)),
        (Grid((16, 16), (8e-6, 1.56e-5)), (0.0, 0.0), MEASURED.format(1.56e-5)),
        # 2.9 DY about a border between pixels: two points
        (Grid.square(8.99e-7, 16), (0.0, 0.0), LEAST.format(8.99e-7)),
        (Grid((16, 16), (4.4e-7, 8e-6)), (0.0, 0.0), LEAST.format(4.4e-7)),
        (Grid((16, 16), (8e-6, 9.2e-7)), (0.0, 0.0), LEAST.format(9.2e-7)),
        (Grid.square(SIDE, 16), (5.1e-7, 0.0), r"offset.*at most 5e-07 x 3\.75e-06 m"),
        (Grid((16, 2), (SIDE, 1e-12)), (0.0, 8e-6), r"offset.*at most 5e-07 x 7\.75e-06 m"),
        (
            Grid.square(SIDE, 16, periodic=True),
            (0.0, 0.0),
            r"periodic = True: expected false: a\.npy does not",
        ),
    ],
)
def test_windows_that_a_map_cannot_fill_are_refused(
    tmp_path: Path, grid: Grid, offset: tuple[float, float], refusal: str
) -> None:
    with pytest.raises(InputError, match=refusal):
        quietly(write_npy(tmp_path / "a.npy", ROUGH), grid, offset)


def test_finer_than_measured_warns(tmp_path: Path) -> None:
    surface = write_npy(tmp_path / "a.npy", ROUGH)
    with pytest.warns(SurfaceWarning, match="finer than the measured pixel"):
        surface.heights(Grid.square(SIDE, 26))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        surface.heights(Grid.square(SIDE, 25))  # 3.2e-7 m
        for M in range(4, 30):
            surface.heights(Grid.square(M * DY, M))  # the pixel itself, up to rounding


# --- gaps ---


@pytest.mark.parametrize(
    ("options", "allowed"),
    [({"max_missing": 1 / 16}, None), ({"max_missing": 0.0624}, "0.0624"), ({"max_missing": 0.0}, "0"),
     ({"max_missing": 0.1, "missing": "refuse"}, "0"), ({}, "0.05")],
)  # fmt: skip
def test_the_fraction_that_may_be_missing_is_allowed_and_no_more(
    tmp_path: Path, options: dict[str, Any], allowed: str | None
) -> None:
    z = np.zeros((8, 8))
    z[2, 1:5] = np.nan  # 4 of 64 points: a sixteenth
    np.save(tmp_path / "a.npy", z)
    surface = MeasuredSurface(tmp_path / "a.npy", unit="m", pixel_size=1.0, **options)
    if allowed is None:
        np.testing.assert_allclose(quietly(surface, Grid.square(8.0, 8)), 0.0, rtol=0, atol=1e-15)
        return
    with pytest.raises(InputError) as refusal:
        surface.heights(Grid.square(8.0, 8))
    assert refusal.value.value == "4 of 64 points of the window in a.npy"
    assert refusal.value.allowed == f"at most a fraction of {allowed}"


def test_a_map_of_missing_points_alone_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="1404 of 1404"):
        write_npy(tmp_path / "b.npy", np.full((NX, NY), np.nan)).heights(Grid.square(SIDE, 16))


# --- level ---


@pytest.mark.parametrize("grid", [Grid.square(7.2e-6, 16), Grid((16, 9), (9e-6, 7.2e-6))], ids=str)
def test_level_is_fitted_in_the_window_only(tmp_path: Path, grid: Grid) -> None:
    z = np.full((NX, NY), 5e-6)
    z[:, 13:37] = (np.arange(NX) * 1e-9)[:, None]  # all that a window of 7.2 um along y holds
    surface = MeasuredSurface(write_npy(tmp_path / "a.npy", z).path, unit="m", pixel_size=(DX, DY))
    (level,) = (line for line in surface.describe(grid) if "level 'plane'" in line)
    slope_x, slope_y = (
        float(word.strip("()")) for word in level.split("slopes ")[1].split(")")[0].split(" x ")
    )
    assert abs(slope_x * DX / 1e-9 - 1) < 1e-5  # as printed
    assert abs(slope_y) < 1e-12
    assert level.endswith("m after")
    assert float(level.split()[-3]) < 1e-20


@pytest.mark.parametrize("level", list(DEGREES))
def test_fit_is_the_least_squares_polynomial(level: str) -> None:
    degree = DEGREES[level]
    x, y, z = np.arange(3.0, 20.0), np.arange(-4.0, 8.0), RNG.normal(size=(17, 12))
    columns = [
        np.outer(x**a, y**b).ravel() for a in range(degree + 1) for b in range(degree + 1) if a + b <= degree
    ]
    expected = np.zeros(z.size)
    if columns:
        design = np.stack(columns, axis=1)
        expected = design @ np.linalg.lstsq(design, z.ravel(), rcond=None)[0]
    np.testing.assert_allclose(fit(x, y, z, degree)(x, y).ravel(), expected, rtol=0, atol=1e-12)


def test_texts_are_of_the_map_as_it_lies(tmp_path: Path) -> None:
    """Turned, the pixel is DY x DX."""
    np.save(tmp_path / "a.npy", ROUGH)
    surface = MeasuredSurface(
        tmp_path / "a.npy", unit="m", pixel_size=(DX, DY), rotate_deg=90, centre=(4e-6, 7e-6)
    )
    grid = Grid((8, 12), (4e-6, 1.2e-6))
    assert surface.pitch((1e-6, 1e-6)) == DX
    assert surface.on_upper_body().reading is surface.reading
    assert "is finer than the measured pixel, 3.1e-07 x 1.5e-07 m" in surface.notes(grid)[-1]
    assert (
        "the window of 4e-06 x 1.2e-06 m about (4e-06, 7e-06) m is used, 13 x 8" in surface.describe(grid)[1]
    )


@pytest.mark.parametrize("suffix", ["npy", "txt", "csv"])
def test_infinite_entries_of_a_file_are_missing(tmp_path: Path, suffix: str) -> None:
    """Four rows along x, one entry infinite either way, one not a number."""
    z = np.arange(24.0).reshape(4, 6) - 5
    z[1, 2], z[2, 4], z[3, 5] = np.inf, -np.inf, np.nan
    path = tmp_path / f"map.{suffix}"
    if suffix == "npy":
        np.save(path, z)
    else:
        np.savetxt(path, z, delimiter="," if suffix == "csv" else " ")
    found = read(path, unit="um", pixel_size=(2e-6, 3e-6))
    assert np.isnan(found.heights).sum() == 3
    kept = np.isfinite(z)
    assert np.allclose(found.heights[kept], z[kept] * 1e-6, rtol=1e-12, atol=0)


def test_the_pitch_of_points_is_their_span_over_whole_steps(tmp_path: Path) -> None:
    """Most steps are 2 or 3 % too long, the last is shorter: pitches 1 and 2."""
    x, y = np.array([0, 1.02, 2.04, 3.06, 4]), np.array([0, 2.06, 4.12, 6])
    points = [(a, b, 10 * i + j) for i, a in enumerate(x) for j, b in enumerate(y)]
    path = tmp_path / "points.xyz"
    np.savetxt(path, points)
    found = read(path, unit="m")
    assert found.pixel == pytest.approx((1.0, 2.0), rel=1e-12)
    assert found.heights[3, 2] == 32


@pytest.mark.parametrize("pixel", [(1.0, 1.0), (1.0, 3.0), (2.0, 0.5), (1.0, 100.0)])
@pytest.mark.parametrize("size", [20, 70])
def test_holes_are_filled_by_the_saddle_around_them(pixel: tuple[float, float], size: int) -> None:
    """x^2 - y^2 + 0.3 x y is harmonic, discretely as well; small holes by elimination, large ones by CG."""
    n = size + 10
    x, y = pixel[0] * np.arange(n)[:, None], pixel[1] * np.arange(n)[None, :]
    z = x**2 - y**2 + 0.3 * x * y + 7.0
    holed = z.copy()
    holed[4 : 4 + size, 5 : 5 + size] = np.nan
    assert (size**2 > MAX_ELIMINATED) == (size == 70)
    assert np.abs(fill(holed, pixel) - z).max() < 1e-7 * np.ptp(z)


def test_missing_points_do_not_lower_the_spectrum() -> None:
    """White noise of variance 4 on pixels of 2 x 3 m has C = 24 m^4, with a third of it missing."""
    z = np.random.default_rng(4).normal(scale=2.0, size=(200, 200))
    z[np.random.default_rng(5).uniform(size=z.shape) < 1 / 3] = np.nan
    found = Spectrum.of(z, (2.0, 3.0))
    assert np.average(found.C, weights=found.count) == pytest.approx(24.0, rel=0.03)
