"""Files from anywhere: each read in a child process, to heights or a refusal."""

from __future__ import annotations

import faulthandler
import os
import signal
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from refimpl.errors import MOST, InputError
from refimpl.grid import Array

T = TypeVar("T")

_HEAD = 4096  # bytes that tell a binary file
_NUMPY = b"\x93NUMPY"  # read by NumPy in Python, which does not crash
_CPU_SECONDS = 60  # processor time for a parser: 16 million points take three


def read_untrusted(path: Path, load: Callable[[], T]) -> T:
    """Return what ``load`` returns; raise `InputError` for whatever else becomes of the file.

    Parsers of other people raise errors of any kind on bytes that are not what they claim to be, and some
    crash the process: binary files are first read in a child process, whose end is all that counts.
    """
    try:
        if _is_binary(path):
            _try_in_child(path, lambda: _load_whole(path, load))
        return _load_whole(path, load)
    except InputError:
        raise
    except Exception as error:  # readers of forged bytes raise anything
        found = " ".join(f"{type(error).__name__}: {error}".split())[:160]
        raise InputError("path", str(path), f"a file that can be read ({found})") from error


def _load_whole(path: Path, load: Callable[[], T]) -> T:
    """Result of ``load``, of a file that holds all its data."""
    _refuse_external_data(path)
    return load()


def _is_binary(path: Path) -> bool:
    if not os.path.isfile(path):  # no error for long names
        return False
    with path.open("rb") as file:
        head = file.read(_HEAD)
    return b"\0" in head and not head.startswith(_NUMPY)


def _try_in_child(path: Path, load: Callable[[], object]) -> None:
    """Raise `InputError` where a forked child that loads the file is killed, by a fault or for its time."""
    if not hasattr(os, "fork"):
        return
    child = os.fork()
    if child == 0:
        try:
            _limit_child()
            load()
        finally:
            os._exit(0)  # an exception is for the parent, which will have it too
    _, ended = os.waitpid(child, 0)
    if os.WIFSIGNALED(ended):
        name = signal.Signals(os.WTERMSIG(ended)).name
        raise InputError("path", str(path), f"a file that can be read (its reader was ended by {name})")


def _limit_child() -> None:
    import resource

    faulthandler.disable()
    for stream in (1, 2):
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream)
    signal.setitimer(signal.ITIMER_PROF, 0)  # a limit of the parent's
    signal.signal(signal.SIGXCPU, signal.SIG_DFL)
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    hard = resource.getrlimit(resource.RLIMIT_CPU)[1]
    if hard == resource.RLIM_INFINITY:
        resource.setrlimit(resource.RLIMIT_CPU, (_CPU_SECONDS, hard))


def refuse_huge(path: Path, heights: Array) -> None:
    """Raise `InputError` for heights (m) whose squares no double holds."""
    most = float(np.nanmax(np.abs(heights), initial=0.0))
    if most > MOST:
        found = f"heights up to {most:.3g} m in {path.name}"
        raise InputError("path", found, f"heights of at most {MOST:g} m")


def _refuse_external_data(path: Path) -> None:
    """Raise `InputError` for an HDF5 file that takes bytes from other files."""
    try:
        import h5py
    except ImportError:  # nothing can read such a file then
        return
    is_hdf5: bool = path.is_file() and h5py.is_hdf5(path)
    if not is_hdf5:
        return
    with h5py.File(path, "r") as file:
        for name in _external(file, h5py):
            allowed = f"an HDF5 file that holds all its data ({name[:60]!r} is in another file)"
            raise InputError("path", str(path), allowed)


def _external(file: Any, h5py: Any) -> Iterator[str]:
    """Names of links and of data in other files."""
    found: list[str] = []

    def see_link(name: str, link: object) -> None:
        if isinstance(link, h5py.ExternalLink):
            found.append(name)

    def see_object(name: str, item: Any) -> None:
        if isinstance(item, h5py.Dataset) and (item.external or item.is_virtual):
            found.append(name)

    file.visititems_links(see_link)
    file.visititems(see_object)
    return iter(found)
