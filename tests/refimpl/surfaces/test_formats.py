"""Formats of instruments: an asymmetric map comes back, with orientation, pixel, unit and missing point."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from refimpl.errors import InputError
from refimpl.surfaces.readers import read
from refimpl.surfaces.reading import ARRAY, IMAGE
from tests.refimpl.surfaces import instrument_writers as write
from tests.refimpl.surfaces.instrument_writers import MAP, MISSING, PIXEL, Writer

BOTH = {"unit": "um", "pixel_size": PIXEL}
COORDINATES = "coordinates as the file states them"
SINGLE = 1e-12  # single precision of heights of 2 um, and of SUR's step of 10 nm
COMPLETE = np.where(np.isnan(MAP), np.nanmin(MAP), MAP)

# file, its writer, what the scene must state, error of heights (m), orientation
FORMATS = [
    ("map.npy", write.write_npy, BOTH, 1e-20, ARRAY),
    ("map.npz", write.write_npz, BOTH, 1e-20, ARRAY),
    ("map.mat", write.write_mat, BOTH, 1e-20, ARRAY),
    ("map.h5", write.write_h5, BOTH, 1e-20, ARRAY),
    ("plain.csv", write.write_plain_csv, BOTH, 1e-20, ARRAY),
    ("map.csv", write.write_csv, BOTH, 1e-20, IMAGE),
    ("map.txt", write.write_txt, {}, 1e-20, IMAGE),
    ("map.xyz", write.write_xyz, {"unit": "um"}, 1e-20, COORDINATES),
    ("points.txt", write.write_xyz, {"unit": "um"}, 1e-20, COORDINATES),
    ("map.x3p", write.write_x3p, {}, 1e-20, ARRAY),
    ("map.sur", write.write_sur, {}, SINGLE, IMAGE),
    ("packed.sur", write.write_packed_sur, {}, SINGLE, IMAGE),
    ("map.opd", write.write_opd, {}, SINGLE, IMAGE),
    ("map.plu", write.write_plu, {}, SINGLE, IMAGE),
    ("map.gwy", write.write_gwy, {}, 1e-20, IMAGE),
    ("map.nc", write.write_nc, {}, 1e-20, ARRAY),
    ("map.sdf", write.write_sdf, {}, 1e-20, ARRAY),
    ("map.asc", write.write_asc, {}, 1e-20, IMAGE),
    ("map.bcr", write.write_bcr, {}, 1e-20, IMAGE),
    ("map.tmd", write.write_tmd, {}, SINGLE, IMAGE),
    ("map.os3d", write.write_os3d, {}, SINGLE, IMAGE),
    ("map.al3d", write.write_al3d, {}, SINGLE, IMAGE),
]

NOTES = {
    "map.csv": ("separator ';', decimal comma", "a leading index column was dropped"),
    "packed.sur": ("compressed SUR, unpacked here",),
}


@pytest.mark.parametrize(
    ("name", "writer", "given", "error", "orientation"), FORMATS, ids=[row[0] for row in FORMATS]
)
@pytest.mark.filterwarnings("error")
def test_a_format_comes_back(
    tmp_path: Path, name: str, writer: Writer, given: dict[str, Any], error: float, orientation: str
) -> None:
    writer(tmp_path / name, MAP)
    reading = read(tmp_path / name, **given)
    np.testing.assert_allclose(reading.heights, MAP, rtol=0, atol=error)
    assert [tuple(at) for at in np.argwhere(np.isnan(reading.heights))] == [MISSING]
    np.testing.assert_allclose(reading.pixel, PIXEL, rtol=1e-7)  # single precision
    assert reading.orientation == orientation
    assert reading.notes == NOTES.get(name, ())


@pytest.mark.parametrize(
    ("name", "writer", "step"),
    [("map.001", write.write_di, 1e-20), ("map.nms", write.write_nms, 3e-11)],
    ids=["di", "nms"],
)
def test_a_format_without_missing_points_comes_back(
    tmp_path: Path, name: str, writer: Writer, step: float
) -> None:
    """NMS holds heights in 65534 steps of the range, 2.7 um."""
    writer(tmp_path / name, COMPLETE)
    reading = read(tmp_path / name)
    np.testing.assert_allclose(reading.heights, COMPLETE, rtol=0, atol=step)
    np.testing.assert_allclose(reading.pixel, PIXEL, rtol=1e-12)
    assert reading.orientation == IMAGE


def test_the_map_is_like_none_of_its_mirror_images() -> None:
    images = [z for turned in (COMPLETE, COMPLETE[::-1, ::-1]) for z in (turned, turned[:, ::-1])]
    for k, z in enumerate(images):
        for other in images[k + 1 :]:
            assert np.abs(z - other).max() > 1e-7


@pytest.mark.parametrize("row", FORMATS, ids=[row[0] for row in FORMATS])
def test_unit_and_pixel_are_overridden_with_a_note(tmp_path: Path, row: tuple[Any, ...]) -> None:
    name, writer, given, *_ = row
    writer(tmp_path / name, MAP)
    stated = read(tmp_path / name, **given)
    found = read(tmp_path / name, unit="pm", pixel_size=(5e-6, 7e-6))
    assert found.pixel == (5e-6, 7e-6)
    size = np.nanmax(np.abs(stated.heights))
    factor = np.nanmax(np.abs(found.heights)) / size
    assert np.log10(factor) == pytest.approx(round(np.log10(factor)), abs=1e-6)
    np.testing.assert_allclose(found.heights, stated.heights * factor, rtol=0, atol=1e-6 * size * factor)
    if not given:
        assert any("the file states" in note and "unit 'pm'" in note for note in found.notes)
    if "pixel_size" not in given:
        assert any("a pixel of 5e-06 x 7e-06 m is used; the file states" in note for note in found.notes)


def test_what_an_array_lacks_is_asked_for(tmp_path: Path) -> None:
    for name, writer, given, *_ in FORMATS:
        if given == BOTH:
            writer(tmp_path / name, MAP)
            with pytest.raises(InputError, match="unit, pixel_size"):
                read(tmp_path / name, unit="um")


@pytest.mark.parametrize(("unit", "name", "size"), [("A", "A", 1e-10), ("Å", "A", 1e-10), ("μm", "um", 1e-6)])
def test_units_have_names_in_ascii(tmp_path: Path, unit: str, name: str, size: float) -> None:
    np.save(tmp_path / "a.npy", np.ones((4, 5)))
    reading = read(tmp_path / "a.npy", unit=unit, pixel_size=PIXEL)
    assert (reading.unit, reading.heights[0, 0]) == (name, size)
