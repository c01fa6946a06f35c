"""Processes that a solver leaves behind, in whatever session: they are found, ended and named (Linux).

While `adopting`, this process inherits the orphans of its descendants (``PR_SET_CHILD_SUBREAPER``). What
carries the run's mark in its environment is a solver's and is ended; an orphan without it is only named.
"""

from __future__ import annotations

import ctypes
import os
import signal
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

MARK = "ROUGH_FRICTION_SOLVER_OF"
"""Environment variable of a solver's process and of all that it starts."""
_SET_SUBREAPER, _GET_SUBREAPER = 36, 37
_ROUNDS = 20


@contextmanager
def adopting() -> Iterator[None]:
    """Orphans of descendants become children of this process within the block; on Linux, else not."""
    if sys.platform != "linux":
        yield
        return
    libc, before = ctypes.CDLL(None), ctypes.c_int(0)
    libc.prctl(_GET_SUBREAPER, ctypes.byref(before), 0, 0, 0)
    libc.prctl(_SET_SUBREAPER, 1, 0, 0, 0)
    try:
        yield
    finally:
        libc.prctl(_SET_SUBREAPER, before.value, 0, 0, 0)


def children() -> set[int]:
    """Ids of this process's children, zombies included; empty where /proc does not tell."""
    found = set()
    for stat in Path("/proc").glob("[0-9]*/stat"):
        with suppress(OSError, ValueError, IndexError):
            if int(stat.read_text().rpartition(")")[2].split()[1]) == os.getpid():
                found.add(int(stat.parent.name))
    return found


def end(expected: set[int], mark: str) -> list[str]:
    """End the adopted processes that carry the mark, and what they leave in turn; return what was found.

    ``expected`` are children that are somebody else's business.
    """
    found: dict[int, str] = {}
    for _ in range(_ROUNDS):
        new = [pid for pid in children() - expected if pid not in found or _marked(pid, mark)]
        if not new:
            break
        for pid in new:
            name, marked = _name(pid), _marked(pid, mark)
            if marked:
                with suppress(ProcessLookupError):
                    os.kill(pid, signal.SIGKILL)
            if name:
                found[pid] = f"{name} (process {pid}): {'ended' if marked else 'still running'}"
            _bury(pid)
        time.sleep(0.01)  # the dead one's own children arrive
    return [found[pid] for pid in sorted(found)]


def _bury(pid: int) -> None:
    for _ in range(100):
        try:
            if os.waitpid(pid, os.WNOHANG) != (0, 0):
                return
        except ChildProcessError:
            return
        if not _name(pid):
            return
        time.sleep(0.01)


def _name(pid: int) -> str:
    """Command line of a process; empty of a zombie, or of none."""
    try:
        return (
            Path(f"/proc/{pid}/cmdline")
            .read_bytes()
            .replace(b"\0", b" ")
            .decode(errors="replace")
            .strip()[:80]
        )
    except OSError:
        return ""


def _marked(pid: int, mark: str) -> bool:
    try:
        return f"{MARK}={mark}".encode() in Path(f"/proc/{pid}/environ").read_bytes().split(b"\0")
    except OSError:
        return False
