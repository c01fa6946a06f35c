"""Formats of instruments: an asymmetric map comes back from each, and faults that files had are met."""

from __future__ import annotations

import logging
import warnings
import zipfile
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
import SurfaceTopography
import SurfaceTopography.Container.IO
from scipy.io import savemat
from SurfaceTopography.Container.SurfaceContainer import InMemorySurfaceContainer

from refimpl.errors import InputError
from refimpl.grid import Grid
from refimpl.measured import MeasuredSurface
from refimpl.measured.readers import read
from refimpl.measured.reading import ALONG_Y, ARRAY, IMAGE
from tests.refimpl.surfaces import instrument_writers as write
from tests.refimpl.surfaces.instrument_writers import (
    BOTH,
    COMPLETE,
    MAP,
    NX,
    NY,
    PIXEL,
    Writer,
    same,
    sur_bytes,
)

COORDINATES = "coordinates as the file states them"
SINGLE = 1e-12  # single precision of heights of 2 um, and of SUR's step of 10 nm

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
    ("wyko.asc", write.write_wyko_text, {}, 1e-20, ALONG_Y),
    ("map.plu", write.write_plu, {}, SINGLE, IMAGE),
    ("map.gwy", write.write_gwy, {}, 1e-20, IMAGE),
    ("map.nc", write.write_nc, {}, 1e-20, ARRAY),
    ("map.sdf", write.write_sdf, {}, 1e-20, ARRAY),
    ("map.asc", write.write_asc, {}, 1e-20, IMAGE),
    ("map.bcr", write.write_bcr, {}, 1e-20, IMAGE),
    ("map.tmd", write.write_tmd, {}, SINGLE, IMAGE),
    ("map.os3d", write.write_os3d, {}, SINGLE, IMAGE),
    ("map.al3d", write.write_al3d, {}, SINGLE, IMAGE),
    ("map.001", write.write_di, {}, 1e-20, IMAGE),
    ("map.nms", write.write_nms, {}, 3e-11, IMAGE),  # heights in 65534 steps of the range, 2.7 um
]
UNMARKED = ("map.001", "map.nms")  # formats without a mark for missing points

NOTES = {
    "map.csv": (
        "separator ';', decimal comma",
        "a leading index row was dropped",
        "a leading index column was dropped",
    ),
    "packed.sur": ("compressed SUR, unpacked here",),
    "map.nms": ("NMS: its spacing is in nm",),
}


@pytest.mark.parametrize(
    ("name", "writer", "given", "error", "orientation"), FORMATS, ids=[row[0] for row in FORMATS]
)
@pytest.mark.filterwarnings("error")
def test_a_format_comes_back(
    tmp_path: Path, name: str, writer: Writer, given: dict[str, Any], error: float, orientation: str
) -> None:
    z = COMPLETE if name in UNMARKED else MAP
    writer(tmp_path / name, z)
    reading = read(tmp_path / name, **given)
    np.testing.assert_allclose(reading.heights, z, rtol=0, atol=error)
    assert np.array_equal(np.isnan(reading.heights), np.isnan(z))
    np.testing.assert_allclose(reading.pixel, PIXEL, rtol=1e-7)  # single precision
    assert reading.orientation == orientation
    assert reading.notes == NOTES.get(name, ())


def test_what_an_array_lacks_is_asked_for(tmp_path: Path) -> None:
    for name, writer, given, *_ in FORMATS:
        if given == BOTH:
            writer(tmp_path / name, MAP)
            with pytest.raises(InputError, match="unit, pixel_size"):
                read(tmp_path / name, unit="um")


@pytest.mark.parametrize("spelling", [b"", b"V"])
@pytest.mark.parametrize("absent", ["si_unit_xy", "si_unit_z", "both"])
def test_a_gwyddion_field_without_a_unit_takes_the_given_one(
    tmp_path: Path, absent: str, spelling: bytes
) -> None:
    """A unit left out or empty is none; volts are one, and no heights."""
    path = tmp_path / "a.gwy"
    write.write_gwy(path, MAP)
    raw = path.read_bytes()
    for key in ("si_unit_xy", "si_unit_z") if absent == "both" else (absent,):
        unit = key.encode() + b"\0oGwySIUnit\0\x0b\0\0\0unitstr\0sm\0"
        assert unit in raw
        # texts of equal length: another key, and one letter changed
        raw = raw.replace(unit, unit[:-2] + spelling + b"\0" if spelling else b"no" + unit[2:])
    path.write_bytes(raw)
    if spelling:
        with pytest.raises(InputError, match="a map of heights"):
            read(path, **BOTH)
        return
    with pytest.raises(InputError, match=r"both: a\.gwy does not state them .*--pixel-size 1e-6"):
        read(path, unit="um")
    found = read(path, **BOTH)
    same(found.heights / 1e-6)
    assert (found.pixel, found.unit) == (PIXEL, "um")
    states_metres = ("unit 'um' is used; the file states 'm'",)
    assert found.notes == (states_metres if absent == "si_unit_xy" else ())


@pytest.mark.parametrize(("unit", "name", "size"), [("A", "A", 1e-10), ("Å", "A", 1e-10), ("μm", "um", 1e-6)])
def test_units_have_names_in_ascii(tmp_path: Path, unit: str, name: str, size: float) -> None:
    np.save(tmp_path / "a.npy", np.ones((4, 5)))
    reading = read(tmp_path / "a.npy", unit=unit, pixel_size=PIXEL)
    assert (reading.unit, reading.heights[0, 0]) == (name, size)


@pytest.mark.parametrize("unit", [b"\xb5m", b"\xe6m", b"um", b"\xc2\xb5m"])
def test_sur_with_any_micro_sign(tmp_path: Path, unit: bytes) -> None:
    (tmp_path / "map.sur").write_bytes(sur_bytes(MAP, unit))
    reading = read(tmp_path / "map.sur")
    same(reading.heights, 1e-12)
    np.testing.assert_allclose(reading.pixel, PIXEL, rtol=1e-7)


@pytest.mark.parametrize(
    ("old", "new", "factor"),
    [
        ("Mult\t6\t2\t5\n", "", 5),
        ("Mult\t6\t2\t5", "Mult\t7\t4\t5.0", 1),
        ("Format 0\t0", "Format 0\t1", 5 / 633),
        ("Wavelength\t7\t4\t633.0\n", "", None),
    ],
)
def test_wykos_text_is_in_wavelengths_over_mult(
    tmp_path: Path, old: str, new: str, factor: float | None
) -> None:
    write.write_wyko_text(tmp_path / "map.asc", MAP)
    changed = (tmp_path / "map.asc").read_text().replace(old, new)
    (tmp_path / "map.asc").write_text(changed)
    if factor is None:
        with pytest.raises(InputError, match="Wyko's text with a Wavelength"):
            read(tmp_path / "map.asc")
    else:
        same(read(tmp_path / "map.asc").heights / factor)


def channels(path: Path) -> Path:
    with h5py.File(path, "w") as file:
        file["first"], file["Second"] = np.zeros((6, 8)), np.nan_to_num(MAP)
        file["line"] = np.zeros(9)
    return path


@pytest.mark.parametrize("channel", ["Second", "second", 0])
def test_channels_are_chosen_by_name_or_number(tmp_path: Path, channel: str | int) -> None:
    surface = MeasuredSurface(channels(tmp_path / "a.h5"), unit="m", pixel_size=PIXEL, channel=channel)
    reading = surface.reading
    assert reading.channel == ("Second" if channel != 0 or reading.channel == "Second" else "first")
    assert set(reading.channels) == {"first", "Second"}
    told = " ".join(surface.describe(Grid((8, 8), (8e-6, 12e-6))))
    assert f"channel {reading.channel!r} was read; there are also" in told


@pytest.mark.parametrize("channel", ["third", 7, -1])
def test_a_channel_that_is_not_there_is_refused_with_those_that_are(
    tmp_path: Path, channel: str | int
) -> None:
    with pytest.raises(InputError, match=r"a channel of a\.h5: .*'first'"):
        read(channels(tmp_path / "a.h5"), "m", PIXEL, channel)


def test_the_librarys_errors_carry_their_cause(tmp_path: Path) -> None:
    (tmp_path / "a.opd").write_bytes(b"\x01\x00Directory" + bytes(60))
    with pytest.raises(InputError) as refused:
        read(tmp_path / "a.opd")
    assert "opd: CorruptFile: " in str(refused.value)
    assert "tried" not in str(refused.value)


@pytest.mark.parametrize(
    ("start", "says"),
    [
        (b"", r"a map of heights: a\.txt is neither text \(UTF-8, UTF-16, Latin-1\) nor a format of Surface"),
        (b"\xff\xfe", r"text in UTF-8, UTF-16 or Latin-1: a\.txt begins as UTF-16, but its bytes are none"),
    ],
)
def test_bytes_that_are_no_text_are_refused_in_our_own_words(tmp_path: Path, start: bytes, says: str) -> None:
    (tmp_path / "a.txt").write_bytes(start + bytes(range(256)) * 20)
    with pytest.raises(InputError, match=says):
        read(tmp_path / "a.txt")


def test_the_librarys_warnings_become_notes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    write.write_x3p(tmp_path / "map.x3p", MAP)
    original = SurfaceTopography.open_topography

    def noisy(*arguments: object, **options: object) -> object:
        warnings.warn("the stage was tilted", stacklevel=1)
        logging.getLogger("SurfaceTopography.IO").warning("on stderr")
        return original(*arguments, **options)

    monkeypatch.setattr(SurfaceTopography, "open_topography", noisy)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        reading = read(tmp_path / "map.x3p")
    assert reading.notes == ("SurfaceTopography: UserWarning: the stage was tilted",)
    assert capfd.readouterr().err == ""


# --- arrays beside others, containers, other kinds ---


@pytest.mark.parametrize("suffix", [".mat", ".npz"])
@pytest.mark.parametrize("grid", ["xy", "ij", "vectors"])
def test_z_beside_x_and_y_is_the_map_where_they_say(tmp_path: Path, suffix: str, grid: str) -> None:
    """MATLAB's meshgrid has x along the columns; the arrays tell, and the pitch."""
    x, y = 2.0 * np.arange(NX), 3.0 * np.arange(NY)
    z = 1e6 * (MAP if grid == "ij" else MAP.T)
    arrays = dict(zip("XYZ", (x[None, :], y[:, None], z), strict=True))
    if grid != "vectors":
        arrays |= dict(zip("XY", np.meshgrid(x, y, indexing=grid), strict=True))
    save = savemat if suffix == ".mat" else lambda path, a: np.savez(path, **a)
    save(tmp_path / f"a{suffix}", arrays)
    found = read(tmp_path / f"a{suffix}", unit="um")
    same(found.heights, 1e-20)
    np.testing.assert_allclose(found.pixel, PIXEL, rtol=1e-12)
    assert found.notes == ("channel 'Z' was read; there are also 'X', 'Y'",)
    solved = MeasuredSurface(tmp_path / f"a{suffix}", unit="um").notes(Grid((8, 8), (8e-6, 12e-6)))
    assert any("channel 'Z' was read" in note for note in solved)
    save(tmp_path / f"b{suffix}", {"first": z, "second": z})
    with pytest.raises(InputError, match=r"channel = None: .*heights in b\.\w+: 0 'first', 1 'second'"):
        read(tmp_path / f"b{suffix}", **BOTH)


def test_a_container_of_contact_engineering_gives_each_of_its_maps(tmp_path: Path) -> None:
    """Written by the library, with netCDF files inside, as the store's own downloads have."""
    one, two = write.topography(MAP), write.topography(2 * COMPLETE)
    for name, map_ in (("one", one), ("two", two)):
        map_.info["name"] = name
    for maps, path in (([one, two], "both.zip"), ([two], "two.zip")):
        SurfaceTopography.Container.IO.write_containers(
            [InMemorySurfaceContainer(maps)], str(tmp_path / path)
        )
    with pytest.raises(
        InputError, match=r"channel = None: expected the one that is heights in both.zip: 0 '"
    ):
        read(tmp_path / "both.zip")
    both = [read(tmp_path / "both.zip", channel=k) for k in (0, 1)]
    same(both[0].heights, 1e-18)
    np.testing.assert_allclose(both[1].heights, 2 * COMPLETE, rtol=0, atol=1e-18)
    np.testing.assert_allclose(both[0].pixel, PIXEL, rtol=1e-9)
    assert "of a container of contact.engineering" in both[0].notes[0]
    assert len(both[0].channels) == 2
    assert read(tmp_path / "two.zip").orientation == ARRAY
    with pytest.raises(InputError, match=r"a channel of both\.zip"):
        read(tmp_path / "both.zip", channel="three")


GSF = b"Gwyddion Simple Field 1.0\nXRes = 2\nYRes = 2\n\0\0\0\0" + bytes(16)
STL = b"made by hand".ljust(80) + b"\2\0\0\0" + bytes(100)


@pytest.mark.parametrize(
    ("name", "content", "kind", "remedy"),
    [
        ("a.png", b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR" + bytes(90), "PNG picture", "brightness is not heights"),
        ("a.gsf", GSF, "Gwyddion simple field", r"as \.gwy"),
        ("a.stl", STL, "STL mesh", "resample"),
        ("a.xls", b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1" + bytes(600), "Excel or OLE", "CSV"),
        ("xl/workbook.xml", None, "Excel file", "CSV"),
        ("notes.txt", None, "ZIP archive of other files", "unpack"),
    ],
)
def test_a_file_of_another_kind_is_named_with_the_remedy(
    tmp_path: Path, name: str, content: bytes | None, kind: str, remedy: str
) -> None:
    path = tmp_path / Path(name).name
    if content is None:
        path = tmp_path / "a.zip"
        with zipfile.ZipFile(path, "w") as archive:
            archive.writestr(name, "hello")
    else:
        path.write_bytes(content)
    with pytest.raises(InputError, match=rf"expected a map of heights: this is an? {kind}.*; .*{remedy}"):
        MeasuredSurface(path, unit="um", pixel_size=1e-6).reading  # noqa: B018  # reading is what raises
