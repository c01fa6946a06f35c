"""Spikes and scars of the test plate are counted, and a clean plate has none."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import refimpl as rf
from refimpl.measured.missing_points import fill
from refimpl.measured.preparation import FAR, outlying, scars
from tests import plate

POINTS = (160, 120)
PIXEL = (plate.PITCH, plate.PITCH)


@pytest.mark.parametrize("short_cut", [1.0, 8.0])
def test_spikes_and_scars_are_counted(short_cut: float) -> None:
    surface = plate.worn(short_cut=short_cut * plate.PITCH)
    clean = plate.sampled(surface, plate.CLEAN, POINTS)
    spiked = plate.sampled(surface, plate.Dirt(spikes=20, holes=50), POINTS)
    scarred = plate.sampled(surface, plate.Dirt(spikes=0, holes=0, scars=7), POINTS)
    known = np.isfinite(spiked)
    spiked = fill(spiked, PIXEL)
    assert not outlying(clean, np.isfinite(clean), FAR)[0].any()
    assert (scars(clean), scars(clean.T)) == (0, 0)
    found = np.count_nonzero(outlying(spiked, known, FAR)[0])
    assert 17 <= found <= 20  # where two are neighbours, or one beside a hole, one may hide
    assert 5 <= scars(scarred.T) <= 7  # of two neighbouring lines neither stands out from both sides
    assert scars(scarred) == 0


def test_lines_of_a_scan_are_levelled_one_by_one(tmp_path: Path) -> None:
    """A surface whose lines along x have mean and slope zero comes back, whatever was added to each line."""
    rng = np.random.default_rng(4)
    x = np.arange(40.0)[:, None]
    z = np.sin(x / 3.0) * np.cos(np.arange(30.0) / 4.0)
    z = z - np.polynomial.polynomial.polyval(x[:, 0], np.polynomial.polynomial.polyfit(x[:, 0], z, 1)).T
    expected = z - np.median(z, axis=0)
    expected -= expected.mean() - z.mean()
    scanned = z + rng.normal(size=30) + rng.normal(size=30) * x / 20
    scanned[7, 9] = np.nan
    np.save(tmp_path / "a.npy", scanned)
    np.save(tmp_path / "b.npy", scanned.T)
    for name, axis in (("a", "x"), ("b", "y")):
        keys = {"unit": "um", "pixel_size": 1e-6, "level": "none", "scan_lines": axis}
        found = rf.inspect_surface(tmp_path / f"{name}.npy", **keys).z
        found = 1e6 * (found if axis == "x" else found.T)
        lines = np.arange(30) != 9  # its hole moves the fit of that line
        away = (found - expected)[:, lines]
        np.testing.assert_allclose(away, away.mean(), rtol=0, atol=1e-12)
        assert np.isnan(found[7, 9])
    with pytest.raises(rf.InputError, match="scan_lines"):
        rf.MeasuredSurface("a.npy", scan_lines="z")
    with pytest.raises(rf.InputError, match="scan_lines"):
        rf.MeasuredSurface(tmp_path / "a.npy", **keys, repeats=True).prepared  # noqa: B018  # raises


def test_the_note_names_the_option_that_removes_the_points(tmp_path: Path) -> None:
    path = plate.write(plate.sampled(plate.worn(), plate.Dirt(spikes=20), POINTS), tmp_path / "map.txt")
    found = rf.inspect_surface(path, unit="um", pixel_size=plate.PITCH, max_missing=0.2)
    assert any("stand out" in note and "--outliers 8" in note for note in found.document()["notes"])
    again = rf.inspect_surface(path, unit="um", pixel_size=plate.PITCH, max_missing=0.2, outliers=8.0)
    assert not any("points stand out" in note for note in again.document()["notes"])
