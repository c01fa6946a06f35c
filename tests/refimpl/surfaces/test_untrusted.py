"""Hostile height files: bytes of other files, parsers that break, heights beyond every square."""

from __future__ import annotations

import random
from pathlib import Path

import numpy as np
import pytest
import scipy.io

import refimpl as rf
from refimpl.measured import MeasuredSurface
from refimpl.measured.untrusted import read_untrusted

HEIGHTS = 1e-8 * np.random.default_rng(5).standard_normal((9, 10))
GRID = rf.Grid.square(8e-6, 8)


def heights(path: Path) -> object:
    return MeasuredSurface(path, unit="m", pixel_size=1e-6).heights(GRID)


def test_a_matlab_file_of_zeros(tmp_path: Path) -> None:
    (tmp_path / "z.mat").write_bytes(bytes(1000))
    with pytest.raises(rf.InputError, match="can be read"):
        heights(tmp_path / "z.mat")


def test_matlab_files_with_forged_bytes(tmp_path: Path) -> None:
    path, source = tmp_path / "f.mat", random.Random(1)
    scipy.io.savemat(path, {"h": HEIGHTS})
    valid = path.read_bytes()
    heights(path)
    for _ in range(20):
        content = bytearray(valid)
        for _ in range(3):
            content[source.randrange(256)] = source.randrange(256)  # header and tags
        path.write_bytes(content)
        try:
            heights(path)
        except rf.InputError:
            continue


@pytest.mark.parametrize("error", [UnboundLocalError("x"), KeyError("\x1b[2J"), Exception("own")])
def test_whatever_a_parser_raises_is_a_refusal(error: Exception, tmp_path: Path) -> None:
    def breaks() -> None:
        raise error

    with pytest.raises(rf.InputError, match=type(error).__name__) as refused:
        read_untrusted(tmp_path / "x", breaks)
    assert "\x1b" not in str(refused.value)


@pytest.mark.parametrize("size", [1e308, 1e200, 1e31])
@pytest.mark.parametrize("suffix", [".npy", ".txt"])
def test_heights_whose_squares_overflow(size: float, suffix: str, tmp_path: Path) -> None:
    path, z = tmp_path / f"h{suffix}", HEIGHTS.copy()
    z[0, 0], z[1, 1] = size, -size
    np.save(path, z) if suffix == ".npy" else np.savetxt(path, z)
    with pytest.raises(rf.InputError, match="at most 1e"):
        heights(path)


@pytest.mark.parametrize("kind", ["external storage", "external link", "virtual"])
@pytest.mark.parametrize("name", ["s.h5", "s.nc", "s.dat"])
def test_bytes_of_other_files_are_no_heights(kind: str, name: str, tmp_path: Path) -> None:
    h5py = pytest.importorskip("h5py")
    secret, path = tmp_path / "secret", tmp_path / name
    secret.write_bytes(HEIGHTS.tobytes())
    with h5py.File(tmp_path / "other.h5", "w") as other:
        other["h"] = HEIGHTS
    with h5py.File(path, "w") as file:
        if kind == "external storage":
            file.create_dataset("h", HEIGHTS.shape, "f8", external=[(str(secret), 0, HEIGHTS.nbytes)])
        elif kind == "external link":
            file["h"] = h5py.ExternalLink(str(tmp_path / "other.h5"), "h")
        else:
            layout = h5py.VirtualLayout(HEIGHTS.shape, "f8")
            layout[:] = h5py.VirtualSource(str(tmp_path / "other.h5"), "h", HEIGHTS.shape)
            file.create_virtual_dataset("h", layout)
    with pytest.raises(rf.InputError, match="holds all its data"):
        heights(path)


def test_an_hdf5_file_with_its_own_data_is_read(tmp_path: Path) -> None:
    h5py = pytest.importorskip("h5py")
    with h5py.File(tmp_path / "own.h5", "w") as file:
        file["h"] = HEIGHTS
    heights(tmp_path / "own.h5")
