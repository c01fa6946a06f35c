"""Measured surfaces' files: formats, units, refusals. All files are written here."""

from __future__ import annotations

import os
import sys
import time
from functools import partial
from pathlib import Path

import h5py
import numpy as np
import pytest

from refimpl.errors import InputError
from refimpl.grid import Grid
from refimpl.measured import MeasuredSurface, reader_process, readers
from refimpl.measured.reader_process import read_untrusted
from tests.refimpl.surfaces.measured import DX, DY, RNG, ROUGH, SIDE, quietly, write_npy, write_x3p


def test_the_missing_optional_package_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "SurfaceTopography", None)
    with pytest.raises(InputError, match=r"\.\[instrument\]"):
        readers.read(write_x3p(tmp_path / "a.x3p", ROUGH))
    # nor is it missed where it is not needed
    write_npy(tmp_path / "a.npy", ROUGH).heights(Grid.square(SIDE, 16))


def test_files_are_read_once_and_late(tmp_path: Path) -> None:
    surface = MeasuredSurface(tmp_path / "late.npy", unit="m", pixel_size=(DX, DY))
    write_npy(tmp_path / "late.npy", ROUGH)
    first = quietly(surface, Grid.square(SIDE, 16))
    (tmp_path / "late.npy").unlink()
    np.testing.assert_array_equal(quietly(surface, Grid.square(SIDE, 16)), first)


class MakesAFolder:
    """Unpickled, it would leave a file behind."""

    def __init__(self, sprung: Path) -> None:
        self.sprung = sprung

    def __reduce__(self) -> tuple[object, ...]:
        return os.mkdir, (str(self.sprung),)


def malformed(folder: Path) -> dict[str, Path]:
    whole = write_x3p(folder / "whole.x3p", ROUGH).read_bytes()
    files = {
        "truncated.x3p": whole[: len(whole) // 2],
        "empty.x3p": b"",
        "zeros.mat": bytes(1000),
        "comment.csv": b"# only a comment\n",
        "four.xyz": b"1 2 3 4\n5 6 7 8\n",
        "noise.x3p": RNG.bytes(4096),
        "words.asc": b"no numbers here\n" * 1000,
        "ragged.asc": b"h=2 w=5\npixel size=1e-7 m\n1 2 3 4 5\n1 2\n",
        "bytes.csv": RNG.bytes(999),
        "few.csv": b"1,2\n3,4\n",
        "promise.npy": b"\x93NUMPY\x01\x00v\x00"
        + b"{'descr': '<f8', 'fortran_order': False, 'shape': (1000000, 1000000), }".ljust(117)
        + b"\n1234",
        "long.npy": b"\x93NUMPY\x02\x00\xff\xff\xff\x7f" + b"(" * 9999,
    }
    for name, content in files.items():
        (folder / name).write_bytes(content)
    np.save(folder / "header.npy", np.zeros((9, 9)))
    for name, end in (("brace.npy", b"}"), ("bracket.npy", b")")):
        (folder / name).write_bytes((folder / "header.npy").read_bytes().replace(end, b" ", 1))
    (folder / "header.npy").unlink()
    np.save(folder / "complex.npy", np.zeros((5, 5), complex))
    unpickled = np.full((4, 4), MakesAFolder(folder / "sprung"), dtype=object)
    np.save(folder / "pickle.npy", unpickled, allow_pickle=True)
    np.savez(folder / "pickle.npz", z=unpickled)
    (folder / "pickle.x3p").write_bytes((folder / "pickle.npz").read_bytes())
    write_x3p(folder / "huge.x3p", np.empty((2**20, 0)), data=b"")
    write_x3p(folder / "nodata.x3p", ROUGH, data=b"")
    write_x3p(folder / "negative.x3p", ROUGH, dx=-DX)
    (folder / "folder.x3p").mkdir()
    return {path.name: path for path in folder.iterdir() if path.name != "whole.x3p"}


@pytest.mark.filterwarnings("error")
def test_damaged_and_malformed_files_get_one_clear_line(tmp_path: Path) -> None:
    files = malformed(tmp_path)
    assert len(files) >= 17
    for name, path in {**files, "absent.x3p": tmp_path / "absent.x3p", "long": Path("x" * 5000)}.items():
        given = {"unit": "m", "pixel_size": DX} if path.suffix in (".npy", ".csv", ".mat", ".txt") else {}
        with pytest.raises(InputError) as refusal:
            MeasuredSurface(path, **given).heights(Grid.square(SIDE, 16))  # type: ignore[arg-type]  # mixed dict
        assert "\n" not in str(refusal.value), name
        assert len(str(refusal.value)) < 500, name
    assert not (tmp_path / "sprung").exists()


def test_zip_bombs_are_not_unpacked(tmp_path: Path) -> None:
    bomb = write_x3p(tmp_path / "bomb.x3p", ROUGH, data=bytes(readers.MAX_BYTES + 1))
    assert bomb.stat().st_size < readers.MAX_BYTES / 200
    with pytest.raises(InputError, match="unpacked"):
        MeasuredSurface(bomb).reading  # noqa: B018  # reading is what raises


@pytest.mark.parametrize("error", [UnboundLocalError("x"), KeyError("\x1b[2J"), Exception("own")])
def test_whatever_a_parser_raises_is_a_refusal(error: Exception, tmp_path: Path) -> None:
    def breaks() -> None:
        raise error

    with pytest.raises(InputError, match=type(error).__name__) as refused:
        read_untrusted(tmp_path / "x", breaks)
    assert "\x1b" not in str(refused.value)


def test_a_parser_that_crashes_or_never_ends_is_a_refusal_and_the_next_file_is_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    resource = pytest.importorskip("resource", reason="limits of POSIX")
    path = write_x3p(tmp_path / "a.x3p", ROUGH)
    with pytest.raises(InputError, match="exit status 7"):
        read_untrusted(path, partial(os._exit, 7))
    monkeypatch.setattr(reader_process, "SECONDS", 0.2)
    with pytest.raises(InputError, match="took too long"):
        read_untrusted(path, partial(time.sleep, 60))
    monkeypatch.undo()
    limit, _ = read_untrusted(path, partial(resource.getrlimit, resource.RLIMIT_CPU))
    assert reader_process.CPU_SECONDS <= limit < 100  # with what its imports took
    with pytest.raises(InputError, match="MemoryError"):
        read_untrusted(path, partial(bytes, 2**32))
    np.testing.assert_allclose(MeasuredSurface(path).reading.heights, ROUGH, rtol=1e-12, atol=0)


@pytest.mark.parametrize(("size", "suffix"), [(1e308, ".npy"), (1e31, ".txt")])
def test_heights_whose_squares_overflow(size: float, suffix: str, tmp_path: Path) -> None:
    path, z = tmp_path / f"h{suffix}", ROUGH.copy()
    z[0, 0], z[1, 1] = size, -size
    np.save(path, z) if suffix == ".npy" else np.savetxt(path, z)
    with pytest.raises(InputError, match="at most 1e"):
        MeasuredSurface(path, unit="m", pixel_size=1e-6).heights(Grid.square(8e-6, 8))


@pytest.mark.parametrize(
    ("kind", "name"),
    [("external storage", "s.h5"), ("external link", "s.nc"), ("virtual", "s.dat"), ("virtual", "s.h5")],
)
def test_bytes_of_other_files_are_no_heights(kind: str, name: str, tmp_path: Path) -> None:
    secret, path = tmp_path / "secret", tmp_path / name
    secret.write_bytes(ROUGH.tobytes())
    with h5py.File(tmp_path / "other.h5", "w") as other:
        other["h"] = ROUGH
    with h5py.File(path, "w") as file:
        if kind == "external storage":
            file.create_dataset("h", ROUGH.shape, "f8", external=[(str(secret), 0, ROUGH.nbytes)])
        elif kind == "external link":
            file["h"] = h5py.ExternalLink(str(tmp_path / "other.h5"), "h")
        else:
            layout = h5py.VirtualLayout(ROUGH.shape, "f8")
            layout[:] = h5py.VirtualSource(str(tmp_path / "other.h5"), "h", ROUGH.shape)
            file.create_virtual_dataset("h", layout)
    with pytest.raises(InputError, match="holds all its data"):
        MeasuredSurface(path, unit="m", pixel_size=1e-6).reading  # noqa: B018  # reading is what raises
