"""Differences between operating systems: processors, memory, time limits, signals, groups, file names.

Ruff refuses these names elsewhere (``banned-api`` in pyproject.toml), and a test runs the command line in a
Python that lacks them.
"""

from __future__ import annotations

import errno
import math
import os
import platform
import re
import shlex
import signal
import stat
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import BinaryIO

import psutil

PROC, GROUPS = Path("/proc"), Path("/sys/fs/cgroup")
_USAGE = {"memory.max": "memory.current", "memory.limit_in_bytes": "memory.usage_in_bytes"}
"""Files of a limit and of the memory used of it, in control groups of version 2 and 1."""
_DEVICES = re.compile(r"(con|prn|aux|nul|conin\$|conout\$|(com|lpt)[1-9])[ .:]*(\..*)?", re.I)

END_SIGNALS = tuple(signal.Signals[name] for name in ("SIGTERM", "SIGHUP") if hasattr(signal, name))
"""Signals of a batch queue, and of a terminal that is closed."""
MOST_WORKERS = 61 if os.name == "nt" else 1024
"""Processes of a pool; Windows waits for no more."""


def cores() -> int:
    """Return the number of cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def processor_name() -> str:
    """Return the model of the processor; Linux has it in a file, where `platform` does not look."""
    with suppress(OSError):
        for line in (PROC / "cpuinfo").read_text(encoding="utf-8", errors="replace").splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    return platform.processor()


def free_memory() -> int:
    """Return the bytes that an allocation may take: the least that system, control group and limits leave."""
    return max(0, min((int(psutil.virtual_memory().available), *_left_in_groups(), *_left_of_limits())))


def _left_in_groups() -> Iterator[int]:
    """Yield the bytes that each control group leaves; droppable file pages count as free."""
    for folder in _groups():
        for limit, usage in _USAGE.items():
            with suppress(OSError, ValueError):  # "max" is no limit
                most = int(_text(folder / limit))
                yield most - int(_text(folder / usage)) + _droppable(folder)


def _groups() -> Iterator[Path]:
    """Yield the folders of this process's memory group and those above it."""
    with suppress(OSError, ValueError):
        for line in _text(PROC / "self/cgroup").splitlines():
            _, controllers, place = line.split(":", 2)
            if controllers and "memory" not in controllers.split(","):
                continue
            root = GROUPS / "memory" if controllers else GROUPS
            folder = root / place.lstrip("/")
            yield from (folder, *(above for above in folder.parents if above.is_relative_to(root)))


def _droppable(folder: Path) -> int:
    with suppress(OSError, ValueError):
        for line in _text(folder / "memory.stat").splitlines():
            if line.startswith(("inactive_file ", "total_inactive_file ")):
                return int(line.split()[1])
    return 0


def _text(path: Path) -> str:
    return path.read_text(encoding="utf-8", errors="surrogateescape")


def _left_of_limits() -> Iterator[int]:
    """Yield the bytes that limits of address space and data segment leave, where psutil has them."""
    process = psutil.Process()
    if hasattr(process, "rlimit"):
        used = process.memory_info()
        for limit, taken in ((psutil.RLIMIT_AS, used.vms), (psutil.RLIMIT_DATA, used.data)):
            most = process.rlimit(limit)[0]
            if most != psutil.RLIM_INFINITY:
                yield most - taken


def peak_memory() -> int:
    """Return the largest resident size of this process so far (bytes).

    Linux keeps that of a parent in ``ru_maxrss`` across exec, so the process's own record is read first.
    """
    with suppress(OSError):
        for line in _text(PROC / "self/status").splitlines():
            if line.startswith("VmHWM:"):
                return 1024 * int(line.split()[1])
    used = psutil.Process().memory_info()
    if hasattr(used, "peak_wset"):  # Windows
        return int(used.peak_wset)
    with suppress(ImportError):
        import resource

        most = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        return most if sys.platform == "darwin" else 1024 * most
    return int(used.rss)


@contextmanager
def processor_time(seconds: float, failure: Exception) -> Iterator[None]:
    """Raise ``failure`` in the block when it has used that much (main thread); no limit on Windows."""
    if not hasattr(signal, "setitimer"):
        yield
        return

    def expired(*_: object) -> None:
        raise failure

    before = signal.signal(signal.SIGPROF, expired)
    signal.setitimer(signal.ITIMER_PROF, seconds, 1.0)  # again, should a callback swallow the first
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        signal.signal(signal.SIGPROF, before)


def limit_process(seconds: float, memory: int) -> None:
    """Let the system end this process after so much more processor time, and refuse it so many bytes more.

    On Windows it has no such limits; a lower one that is there stays.
    """
    with suppress(ImportError, OSError, ValueError):
        import resource

        used = resource.getrusage(resource.RUSAGE_SELF)
        limits = {
            resource.RLIMIT_CPU: math.ceil(used.ru_utime + used.ru_stime + seconds),
            resource.RLIMIT_AS: psutil.Process().memory_info().vms + memory,
        }
        for limit, most in limits.items():
            hard = resource.getrlimit(limit)[1]
            resource.setrlimit(limit, (most if hard == resource.RLIM_INFINITY else min(most, hard), hard))


@contextmanager
def interrupts_blocked() -> Iterator[None]:
    """Keep interrupts to the group from processes started in the block; Windows sends them to all."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def in_session(process: int, leader: int) -> bool:
    """Return whether a process belongs to the session of that leader; on Windows there are none."""
    with suppress(OSError):
        return hasattr(os, "getsid") and os.getsid(process) == leader
    return False


def kill_group(leader: int) -> None:
    """Kill the group of a leader; where there are none, the process and all below it."""
    with suppress(ProcessLookupError, PermissionError, psutil.Error):  # gone; on macOS, all zombies
        if hasattr(os, "killpg"):
            os.killpg(leader, signal.SIGKILL)
            return
        head = psutil.Process(leader)
        for each in (*head.children(recursive=True), head):
            with suppress(psutil.Error):
                each.kill()


def has_ended(child: int) -> bool:
    """Return whether a child has ended, not reaping it; by its status where there is no such call."""
    if hasattr(os, "waitid"):
        with suppress(ChildProcessError):  # reaped before
            return os.waitid(os.P_PID, child, os.WEXITED | os.WNOHANG | os.WNOWAIT) is not None
        return True
    try:
        return bool(psutil.Process(child).status() == psutil.STATUS_ZOMBIE)
    except psutil.Error:
        return True


@contextmanager
def open_regular(path: Path) -> Iterator[BinaryIO]:
    """Open a regular file to be read; raises OSError at once for another: a pipe is not waited for."""
    at_once = getattr(os, "O_NONBLOCK", 0)  # absent on Windows, whose pipes have no names in folders
    with open(path, "rb", opener=lambda name, flags: os.open(name, flags | at_once)) as file:
        if not stat.S_ISREG(os.fstat(file.fileno()).st_mode):
            raise OSError(errno.EINVAL, "no regular file", str(path))
        yield file


def words_of(command: str, *, windows: bool = os.name == "nt") -> list[str]:
    r"""Return the words of a command line, split like a shell does. Raises ValueError for an open quote.

    >>> words_of(r'"C:\my codes\solve.exe" --fast', windows=True), words_of("./solve 'a b'", windows=False)
    (['C:\\my codes\\solve.exe', '--fast'], ['./solve', 'a b'])
    """
    words = shlex.split(command, posix=not windows)
    return [word[1:-1] if windows and word[0] == word[-1] == '"' else word for word in words]


def is_device(name: str, *, windows: bool = os.name == "nt") -> bool:
    """Return whether Windows takes a file of this name for a device and loses what is written there.

    >>> [is_device(name, windows=True) for name in ("aux.csv", "NUL", "auxiliary.csv")]
    [True, True, False]
    """
    return windows and _DEVICES.fullmatch(name) is not None
