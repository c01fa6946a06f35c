"""Small maps whose readings, centres and parameters are worked out by hand."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from refimpl.surfaces.areal_parameters import Spectrum
from refimpl.surfaces.missing_points import MAX_ELIMINATED, fill
from refimpl.surfaces.readers import read


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


def test_entries_that_a_line_lacks_at_its_end_are_missing(tmp_path: Path) -> None:
    path = tmp_path / "map.txt"
    path.write_text("1.5\t2.5\t3.5\t4.5\n5.5\t6.5\t7.5\n8.5\t9.5\t1.5\t2.5\n3.5\t4.5\t5.5\t6.5\n")
    found = read(path, unit="m", pixel_size=(1.0, 1.0))
    assert np.isnan(found.heights[1, 3])
    assert np.isnan(found.heights).sum() == 1
    assert found.heights[3].tolist() == [3.5, 4.5, 5.5, 6.5]


def test_the_pitch_of_points_is_their_span_over_whole_steps(tmp_path: Path) -> None:
    """Most steps are 2 or 3 % too long, the last is shorter: pitches 1 and 2."""
    x, y = np.array([0, 1.02, 2.04, 3.06, 4]), np.array([0, 2.06, 4.12, 6])
    points = [(a, b, 10 * i + j) for i, a in enumerate(x) for j, b in enumerate(y)]
    path = tmp_path / "points.xyz"
    np.savetxt(path, points)
    found = read(path, unit="m")
    assert found.pixel == pytest.approx((1.0, 2.0), rel=1e-12)
    assert found.heights[3, 2] == 32


@pytest.mark.parametrize("pixel", [(1.0, 1.0), (1.0, 3.0), (2.0, 0.5)])
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
