"""A dask.distributed cluster of processes of our own, whose members can be killed one by one."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

START_SECONDS = 60.0
_NOWHERE = subprocess.DEVNULL
ONE_THREAD = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}


@dataclass
class Cluster:
    """The scheduler's address, its process, and the workers' (without nannies, so that a kill is final)."""

    address: str
    scheduler: subprocess.Popen[bytes]
    folder: Path
    environment: Mapping[str, str]
    workers: list[subprocess.Popen[bytes]] = field(default_factory=list)

    def add_worker(self) -> subprocess.Popen[bytes]:
        """Start a worker of one thread."""
        options = ("--no-nanny", "--nthreads", "1", "--no-dashboard", "--local-directory", str(self.folder))
        command = [sys.executable, "-m", "distributed.cli.dask_worker", self.address, *options]
        worker = subprocess.Popen(
            command, env=self.environment, cwd=self.folder, stderr=_NOWHERE, stdout=_NOWHERE
        )
        self.workers.append(worker)
        return worker

    def wait_for_workers(self, number: int) -> None:
        """Return when that many workers have come; raises TimeoutError."""
        import distributed

        connect: Any = distributed.Client  # untyped
        with connect(self.address, timeout=START_SECONDS) as client:
            client.wait_for_workers(number, timeout=START_SECONDS)

    def end(self) -> None:
        """Kill what still runs."""
        for process in (*self.workers, self.scheduler):
            process.kill()
            process.wait()


@contextmanager
def cluster(
    folder: Path, workers: int, environment: Mapping[str, str] = ONE_THREAD, *, drop: tuple[str, ...] = ()
) -> Iterator[Cluster]:
    """A cluster with so many workers; ``environment`` is added to this process's, without ``drop``."""
    file = folder / "scheduler.json"
    file.unlink(missing_ok=True)  # left by an earlier cluster
    options = ("--port", "0", "--host", "127.0.0.1", "--no-dashboard", "--scheduler-file", str(file))
    command = [sys.executable, "-m", "distributed.cli.dask_scheduler", *options]
    every = {name: value for name, value in os.environ.items() if name not in drop} | dict(environment)
    process = subprocess.Popen(command, env=every, cwd=folder, stderr=_NOWHERE, stdout=_NOWHERE)
    made = Cluster("", process, folder, every)
    try:
        made.address = _address(file, process)
        for _ in range(workers):
            made.add_worker()
        if workers:
            made.wait_for_workers(workers)
        yield made
    finally:
        made.end()


def _address(file: Path, process: subprocess.Popen[bytes]) -> str:
    """The address that the scheduler has written, when it has."""
    deadline = time.monotonic() + START_SECONDS
    while time.monotonic() < deadline and process.poll() is None:
        try:
            return str(json.loads(file.read_text())["address"])
        except (FileNotFoundError, ValueError):
            time.sleep(0.05)
    raise TimeoutError("the scheduler did not start")
