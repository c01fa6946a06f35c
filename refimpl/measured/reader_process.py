"""Files from anywhere: heights or a refusal, whatever becomes of a parser.

One process reads all binary and large files: a fresh interpreter that is started with the first, in which
parsers stay imported. It ends with its standard input.
"""

from __future__ import annotations

import atexit
import faulthandler
import os
import pickle
import signal
import subprocess
import sys
import threading
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from refimpl.errors import MOST, InputError
from refimpl.grid import Array
from refimpl.measured.reading import read_or_refuse, unreadable
from refimpl.operating_system import limit_process

T = TypeVar("T")

SECONDS = 240.0  # for a file, on a busy machine
CPU_SECONDS, CPU_PER_BYTE = 8.0, 80e-9  # processor time: text takes 45e-9 a byte, instruments' files less
MEMORY, MEMORY_PER_BYTE = 2**30, 8  # bytes: text takes 5, 16 million points from a packed file half of 2**30
_CODE = "from refimpl.measured.reader_process import serve; serve()"
_LOCK = threading.Lock()
_started: dict[int, subprocess.Popen[bytes]] = {}
"""The reader by the process that started it, of which a fork has none."""
_HEAD = 4096  # bytes that tell a binary file
_SMALL = 4_000_000  # bytes of text that take a second and 80 MB, whatever they are
_NUMPY = b"\x93NUMPY"  # read by NumPy in Python, which does not crash


def read_elsewhere(path: Path, load: Callable[[], T]) -> T:
    """Return what ``load``, which can be pickled, returns in the reader.

    Raises `InputError` where it does, where the reader crashes, or takes more than a file of that size may.
    """
    with _LOCK:
        reader = _reader()
        assert reader.stdin is not None  # both are pipes
        assert reader.stdout is not None
        try:
            pickle.dump((os.getcwd(), SECONDS, os.path.getsize(path), load), reader.stdin)
            reader.stdin.flush()
            found = pickle.load(reader.stdout)
        except (EOFError, OSError, pickle.UnpicklingError):
            status = _end()
            allowed = f"a file that can be read (its reader crashed or took too long: exit status {status})"
            raise unreadable(path, allowed) from None
        except BaseException:  # an interrupt: the answer would be taken for that to the next file
            _end()
            raise
    if isinstance(found, InputError):
        raise found
    result: T = found
    return result


def _reader() -> subprocess.Popen[bytes]:
    own = os.getpid()
    if own not in _started or _started[own].poll() is not None:
        _started[own] = subprocess.Popen(
            [sys.executable, "-P", "-c", _CODE],  # -P: no modules from the folder of the files
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            env=os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)},
        )
    return _started[own]


@atexit.register
def _end() -> int | None:
    """End the reader and return its exit status, its own where it ended before."""
    reader = _started.pop(os.getpid(), None)
    if reader is None:
        return None
    for pipe in (reader.stdin, reader.stdout):
        with suppress(OSError):  # bytes that were not yet sent
            pipe.close()  # type: ignore[union-attr]  # both are pipes
    try:
        return reader.wait(0.5)
    except subprocess.TimeoutExpired:
        reader.kill()
        return reader.wait()


def serve() -> None:
    """Answer in the reader process until standard input ends. What parsers print goes nowhere."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    with os.fdopen(os.dup(1), "wb") as answers, open(os.devnull, "wb") as nowhere:
        os.dup2(nowhere.fileno(), 1)
        while True:
            try:
                folder, seconds, size, load = pickle.load(sys.stdin.buffer)
            except EOFError:
                return
            os.chdir(folder)
            limit_process(CPU_SECONDS + CPU_PER_BYTE * size, MEMORY + MEMORY_PER_BYTE * size)
            faulthandler.dump_traceback_later(seconds, exit=True, file=nowhere)
            try:
                found = load()
            except InputError as refused:
                found = refused
            faulthandler.cancel_dump_traceback_later()
            pickle.dump(found, answers)
            answers.flush()


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
