"""The memory that an allocation may take now: by the system, the control group and the process's limits."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

PROC, GROUPS = Path("/proc"), Path("/sys/fs/cgroup")
_USAGE = {"memory.max": "memory.current", "memory.limit_in_bytes": "memory.usage_in_bytes"}
"""Files of a limit and of what is used of it, in control groups of version 2 and 1."""


def free_memory() -> int:
    """Return the bytes: the least of what the kernel, the control group and resource limits leave."""
    return max(0, min((_available(), *_left_in_groups(), *_left_of_limits())))


def _available() -> int:
    """The kernel's own estimate, or all memory where it makes none."""
    with suppress(OSError):
        for line in (PROC / "meminfo").read_text(encoding="ascii").splitlines():
            if line.startswith("MemAvailable:"):
                return int(line.split()[1]) * 1024
    return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")


def _left_in_groups() -> Iterator[int]:
    """Bytes that the limit of each group above this process leaves; droppable file pages count as free."""
    for folder in _groups():
        for limit, usage in _USAGE.items():
            with suppress(OSError, ValueError):  # "max" is no limit
                most = int((folder / limit).read_text())
                yield most - int((folder / usage).read_text()) + _droppable(folder)


def _groups() -> Iterator[Path]:
    """The folders of this process's memory group and of those above it; in a container, its own root."""
    with suppress(OSError, ValueError):
        for line in (PROC / "self/cgroup").read_text().splitlines():
            _, controllers, place = line.split(":", 2)
            if controllers and "memory" not in controllers.split(","):
                continue
            root = GROUPS / "memory" if controllers else GROUPS
            folder = root / place.lstrip("/")
            yield from (folder, *(above for above in folder.parents if above.is_relative_to(root)))


def _droppable(folder: Path) -> int:
    with suppress(OSError, ValueError):
        for line in (folder / "memory.stat").read_text().splitlines():
            if line.startswith(("inactive_file ", "total_inactive_file ")):
                return int(line.split()[1])
    return 0


def _left_of_limits() -> Iterator[int]:
    """Bytes that the limits of the address space and of the data segment leave (POSIX)."""
    with suppress(ImportError, OSError, ValueError):
        import resource

        pages = (PROC / "self/statm").read_text().split()
        for limit, used in ((resource.RLIMIT_AS, pages[0]), (resource.RLIMIT_DATA, pages[5])):
            most = resource.getrlimit(limit)[0]
            if most != resource.RLIM_INFINITY:
                yield most - int(used) * os.sysconf("SC_PAGE_SIZE")
