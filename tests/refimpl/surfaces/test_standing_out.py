"""Spikes and scars of the test plate are counted, and a clean plate has none."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import refimpl as rf
from refimpl.measured.missing_points import fill
from refimpl.measured.standing_out import scars, spikes
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
    assert (spikes(clean, np.isfinite(clean)), scars(clean), scars(clean.T)) == (0, 0, 0)
    assert 17 <= spikes(spiked, known) <= 20  # where two are neighbours, or one beside a hole, one may hide
    assert 5 <= scars(scarred.T) <= 7  # of two neighbouring lines neither stands out from both sides
    assert scars(scarred) == 0


def test_the_note_names_the_option_that_removes_the_points(tmp_path: Path) -> None:
    path = plate.write(plate.sampled(plate.worn(), plate.Dirt(spikes=20), POINTS), tmp_path / "map.txt")
    found = rf.inspect_surface(path, unit="um", pixel_size=plate.PITCH, max_missing=0.2)
    assert any("stand out" in note and "--outliers 8" in note for note in found.document()["notes"])
    again = rf.inspect_surface(path, unit="um", pixel_size=plate.PITCH, max_missing=0.2, outliers=8.0)
    assert not any("points stand out" in note for note in again.document()["notes"])
