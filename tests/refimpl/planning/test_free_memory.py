"""Memory by the system, by control groups of both versions, and by limits of the process."""

from __future__ import annotations

import resource
from pathlib import Path

import pytest

from refimpl.planning import free_memory as module
from refimpl.planning.free_memory import free_memory

GB = 2**30


@pytest.fixture
def system(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A machine with 8 GB free, without groups and limits."""
    (tmp_path / "proc/self").mkdir(parents=True)
    (tmp_path / "proc/meminfo").write_text(f"MemFree: 1 kB\nMemAvailable: {8 * GB // 1024} kB\n")
    monkeypatch.setattr(module, "PROC", tmp_path / "proc")
    monkeypatch.setattr(module, "GROUPS", tmp_path / "cgroup")
    unlimited = (resource.RLIM_INFINITY, resource.RLIM_INFINITY)
    monkeypatch.setattr(resource, "getrlimit", lambda which: unlimited)
    return tmp_path


def group(folder: Path, limit: str, **other: str) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in ({"memory.max": limit, "memory.current": f"{GB}"} | other).items():
        (folder / name).write_text(text)


@pytest.mark.parametrize(
    ("limit", "left"), [("max", 8), (f"{4 * GB}", 3), (f"{GB // 2}", 0), ("nonsense", 8)]
)
def test_the_group_of_the_process(limit: str, left: int, system: Path) -> None:
    (system / "proc/self/cgroup").write_text("0::/a/b\n")
    group(system / "cgroup/a/b", limit)
    assert free_memory() == left * GB


def test_groups_above_it_count_and_dropped_pages_are_free(system: Path) -> None:
    (system / "proc/self/cgroup").write_text("0::/a/b\n")
    group(system / "cgroup/a/b", "max")
    group(system / "cgroup/a", f"{3 * GB}", **{"memory.stat": f"anon 1\ninactive_file {GB // 2}\n"})
    assert free_memory() == 2 * GB + GB // 2


def test_groups_of_version_1(system: Path) -> None:
    (system / "proc/self/cgroup").write_text("5:cpu:/x\n4:memory:/a\n0::/\n")
    folder = system / "cgroup/memory/a"
    folder.mkdir(parents=True)
    (folder / "memory.limit_in_bytes").write_text(f"{5 * GB}\n")
    (folder / "memory.usage_in_bytes").write_text(f"{GB}\n")
    assert free_memory() == 4 * GB


@pytest.mark.parametrize(
    ("which", "left"), [(resource.RLIMIT_AS, 2 * GB), (resource.RLIMIT_DATA, 5 * GB // 2)]
)
def test_limits_of_the_process(which: int, left: int, system: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of the address space 1 GB is used, of the data segment half of that."""
    page = resource.getpagesize()
    (system / "proc/self/statm").write_text(f"{GB // page} 0 0 0 0 {GB // (2 * page)} 0\n")
    limits = {which: (3 * GB, 3 * GB)}
    unlimited = (resource.RLIM_INFINITY, resource.RLIM_INFINITY)
    monkeypatch.setattr(resource, "getrlimit", lambda asked: limits.get(asked, unlimited))
    assert free_memory() == left
