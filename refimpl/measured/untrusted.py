"""Files from anywhere: heights or a refusal, whatever becomes of a parser."""

from __future__ import annotations

import os
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from refimpl.errors import MOST, InputError
from refimpl.grid import Array
from refimpl.measured.reader_process import read_elsewhere
from refimpl.measured.reading import read_or_refuse, unreadable

T = TypeVar("T")

_HEAD = 4096  # bytes that tell a binary file
_SMALL = 4_000_000  # bytes of text that take a second and 80 MB, whatever they are
_NUMPY = b"\x93NUMPY"  # read by NumPy in Python, which does not crash


def read_untrusted(path: Path, load: Callable[[], T]) -> T:
    """Return what ``load`` returns; raise `InputError` for whatever else becomes of the file.

    Parsers may crash or take all memory: binary and large files are read in another process.
    """
    reading = partial(read_or_refuse, path, partial(_read, path, load))
    return read_elsewhere(path, reading) if _is_risky(path) else reading()


def _read(path: Path, load: Callable[[], T]) -> T:
    _refuse_external_data(path)
    return load()


def _is_risky(path: Path) -> bool:
    if not os.path.isfile(path):  # no error for long names, no waiting for a pipe
        return False
    with suppress(OSError), path.open("rb") as file:  # an error is for `read_or_refuse`
        head = file.read(_HEAD)
        return (b"\0" in head or os.path.getsize(path) > _SMALL) and not head.startswith(_NUMPY)
    return False


def refuse_huge(path: Path, heights: Array) -> None:
    """Raise `InputError` for heights (m) whose squares no double holds."""
    most = float(np.nanmax(np.abs(heights), initial=0.0))
    if most > MOST:
        found = f"heights up to {most:.3g} m in {path.name}"
        raise InputError("path", found, f"heights of at most {MOST:g} m")


def _refuse_external_data(path: Path) -> None:
    try:
        import h5py
    except ImportError:  # nothing can read such a file then
        return
    is_hdf5: bool = path.is_file() and h5py.is_hdf5(path)
    if not is_hdf5:
        return
    found: list[str] = []

    def see_link(name: str, link: object) -> None:
        if isinstance(link, h5py.ExternalLink):
            found.append(name)

    def see_object(name: str, item: Any) -> None:
        if isinstance(item, h5py.Dataset) and (item.external or item.is_virtual):
            found.append(name)

    with h5py.File(path, "r") as file:
        file.visititems_links(see_link)
        file.visititems(see_object)
    if found:
        allowed = f"an HDF5 file that holds all its data ({found[0][:60]!r} is in another file)"
        raise unreadable(path, allowed)
