"""Measured surfaces' files: formats, units, refusals. All files are written here."""

from __future__ import annotations

import os
import sys
import time
from pathlib import Path

import numpy as np
import pytest
import SurfaceTopography
import SurfaceTopography.Exceptions

from refimpl.errors import InputError
from refimpl.grid import Grid
from refimpl.measured import MeasuredSurface, readers
from tests.refimpl.surfaces.measured import (
    DX,
    DY,
    NX,
    NY,
    RNG,
    ROUGH,
    SIDE,
    write_npy,
    write_x3p,
)


@pytest.mark.parametrize("name", ["a.csv", "a.asc", "a.txt"])
def test_a_byte_order_mark_is_no_number(tmp_path: Path, name: str) -> None:
    path = tmp_path / name
    separator = "," if name.endswith("csv") else " "
    rows = "\n".join(separator.join(f"{height:.17g}" for height in row) for row in ROUGH * 1e9)
    path.write_text(rows + "\n", encoding="utf-8-sig")
    reading = MeasuredSurface(path, unit="nm", pixel_size=(DX, DY)).reading
    np.testing.assert_allclose(reading.heights, ROUGH, rtol=1e-15, atol=0)


def test_text_with_an_instruments_header_is_scaled_by_it(tmp_path: Path) -> None:
    """Header: lines of constant y from the top, a conversion factor of the heights."""
    path = tmp_path / "a.asc"
    header = (
        f"h={NY} w={NX}\npixel size=1.500000e-007 m\ndata unit=rad\nheight conversion factor (-> m)=2.5e-8\n"
    )
    rows = "\n".join(" ".join(f"{v:.17g}" for v in row) for row in (ROUGH / 2.5e-8).T[::-1])
    path.write_text(header + rows + "\n")
    reading = MeasuredSurface(path).reading
    np.testing.assert_allclose(reading.heights, ROUGH, rtol=1e-14, atol=0)
    np.testing.assert_allclose(reading.pixel, (1.5e-7, 1.5e-7), rtol=1e-14)
    overridden = MeasuredSurface(path, unit="um").reading
    np.testing.assert_allclose(overridden.heights, reading.heights * 1e-6, rtol=1e-14, atol=0)
    assert overridden.notes == ("unit 'um' is used; the file states 'm'",)


def test_files_that_state_no_unit_need_one(tmp_path: Path) -> None:
    for name in ("a.npy", "a.csv", "a.dat"):
        path = tmp_path / name
        np.save(path, ROUGH) if name.endswith("npy") else np.savetxt(path, ROUGH, delimiter=",")
        if name.endswith("dat"):
            np.savetxt(path, ROUGH, fmt="%.17g")
        with pytest.raises(InputError, match="unit, pixel_size = \\('um', None\\): expected both"):
            MeasuredSurface(path, unit="um").reading  # noqa: B018  # likewise
    plain = MeasuredSurface(tmp_path / "a.dat", unit="um", pixel_size=DX).reading  # whatever its suffix
    np.testing.assert_allclose(plain.heights, ROUGH * 1e-6, rtol=1e-15, atol=0)


def test_the_missing_optional_package_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "SurfaceTopography", None)
    with pytest.raises(InputError, match=r"\.\[instrument\]"):
        MeasuredSurface(write_x3p(tmp_path / "a.x3p", ROUGH)).reading  # noqa: B018  # likewise
    write_npy(tmp_path / "a.npy", ROUGH).heights(
        Grid.square(SIDE, 16)
    )  # and is not missed where it is not needed


def test_files_are_read_once_and_late(tmp_path: Path) -> None:
    surface = MeasuredSurface(tmp_path / "late.npy", unit="m", pixel_size=(DX, DY))
    write_npy(tmp_path / "late.npy", ROUGH)
    first = surface.heights(Grid.square(SIDE, 16))
    (tmp_path / "late.npy").unlink()
    np.testing.assert_array_equal(surface.heights(Grid.square(SIDE, 16)), first)


class Trap:
    """Unpickled, it would leave a file behind."""

    def __init__(self, sprung: Path) -> None:
        self.sprung = sprung

    def __reduce__(self) -> tuple[object, ...]:
        return os.mkdir, (str(self.sprung),)


def hostile(folder: Path) -> dict[str, Path]:
    whole = write_x3p(folder / "whole.x3p", ROUGH).read_bytes()
    files = {
        "truncated.x3p": whole[: len(whole) // 2],
        "short.x3p": whole[:40],
        "empty.x3p": b"",
        "noise.x3p": RNG.bytes(4096),
        "noise.dat": RNG.bytes(4096),
        "words.asc": b"no numbers here\n" * 1000,
        "ragged.asc": b"h=2 w=5\npixel size=1e-7 m\n1 2 3 4 5\n1 2\n",
        "ragged.csv": b"1,2,3,4\n1,2\n",
        "words.csv": b"a,b,c,d\n" * 5,
        "bytes.csv": RNG.bytes(999),
        "few.csv": b"1,2\n3,4\n",
        "promise.npy": b"\x93NUMPY\x01\x00v\x00"
        + b"{'descr': '<f8', 'fortran_order': False, 'shape': (1000000, 1000000), }".ljust(117)
        + b"\n1234",
        "header.npy": b"\x93NUMPY\x02\x00\xff\xff\xff\x7f" + b"(" * 9999,
    }
    for name, content in files.items():
        (folder / name).write_bytes(content)
    np.save(folder / "complex.npy", np.zeros((5, 5), complex))
    np.save(folder / "cube.npy", np.zeros((5, 5, 5)))
    traps = np.full((4, 4), Trap(folder / "sprung"), dtype=object)
    np.save(folder / "pickle.npy", traps, allow_pickle=True)
    np.savez(folder / "pickle.npz", z=traps)
    (folder / "pickle.x3p").write_bytes((folder / "pickle.npz").read_bytes())
    write_x3p(folder / "huge.x3p", np.empty((2**20, 0)), data=b"").write_bytes(
        write_x3p(folder / "nodata.x3p", ROUGH, data=b"").read_bytes()
    )
    write_x3p(folder / "negative.x3p", ROUGH, dx=-DX)
    write_x3p(folder / "nan.x3p", ROUGH, dx="nan")
    (folder / "folder.x3p").mkdir()
    return {path.name: path for path in folder.iterdir() if path.name != "whole.x3p"}


def test_broken_and_hostile_files_get_one_clear_line(tmp_path: Path) -> None:
    files = hostile(tmp_path)
    assert len(files) >= 20
    for name, path in {**files, "absent.x3p": tmp_path / "absent.x3p"}.items():
        given = {"unit": "m", "pixel_size": DX} if path.suffix in (".npy", ".csv") else {}
        with pytest.raises(InputError) as refusal:
            MeasuredSurface(path, **given).heights(Grid.square(SIDE, 16))  # type: ignore[arg-type]  # mixed dict
        assert "\n" not in str(refusal.value), name
        assert len(str(refusal.value)) < 500, name
    assert not (tmp_path / "sprung").exists()


@pytest.mark.parametrize("content", ["# only a comment\n", "\n\n\n"])
@pytest.mark.parametrize("name", ["a.csv", "a.txt"])
@pytest.mark.filterwarnings("error")
def test_a_table_without_rows_is_refused_without_a_warning(tmp_path: Path, name: str, content: str) -> None:
    (tmp_path / name).write_text(content)
    with pytest.raises(InputError, match=f"{name}.*: expected .*numbers"):
        MeasuredSurface(tmp_path / name, unit="m", pixel_size=DX).reading  # noqa: B018  # reading is what raises


@pytest.mark.parametrize("content", ["a,b,c,d\n1,2,3,4\n", "1 2 3 4\n5 6 7 8\n"])
def test_points_of_four_columns_are_refused(tmp_path: Path, content: str) -> None:
    (tmp_path / "a.xyz").write_text(content)
    with pytest.raises(InputError, match="two or three columns"):
        MeasuredSurface(tmp_path / "a.xyz", unit="m", pixel_size=DX).reading  # noqa: B018  # reading is what raises


@pytest.mark.parametrize(
    "name",
    ["UnknownFileFormat", "CannotPerformAnalysisError", "UndefinedDataError", "NoReliableDataError",
     "ReentrantDataError", "ReadFileError"],
)  # fmt: skip
def test_whatever_the_library_raises_is_a_refusal(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    def refuses(*_: object, **__: object) -> None:
        raise getattr(SurfaceTopography.Exceptions, name)("not this file")

    monkeypatch.setattr(SurfaceTopography, "open_topography", refuses)
    with pytest.raises(InputError, match=f"{name}: not this file"):
        MeasuredSurface(write_x3p(tmp_path / "a.x3p", ROUGH)).reading  # noqa: B018  # likewise


def test_zip_bombs_are_not_unpacked(tmp_path: Path) -> None:
    bomb = write_x3p(tmp_path / "bomb.x3p", ROUGH, data=bytes(readers.MAX_BYTES + 1))
    assert bomb.stat().st_size < readers.MAX_BYTES / 500
    with pytest.raises(InputError, match="unpacked"):
        MeasuredSurface(bomb).reading  # noqa: B018  # reading is what raises


def test_large_junk_is_refused_at_once(tmp_path: Path) -> None:
    path = tmp_path / "junk.asc"
    path.write_bytes(b"junk\n" * 1_000_000)
    start = time.process_time()
    with pytest.raises(InputError, match="rows of numbers"):
        MeasuredSurface(path).reading  # noqa: B018  # likewise
    assert time.process_time() - start < 1.5  # 5 MB in CPU seconds; the text reader itself needs 4.5
