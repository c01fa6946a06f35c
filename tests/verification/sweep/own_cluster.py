"""A dask.distributed cluster of processes of our own, which ends with the test."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

START_SECONDS = 60.0


@contextmanager
def cluster(
    folder: Path, environment: Mapping[str, str], *, drop: tuple[str, ...]
) -> Iterator[tuple[str, subprocess.Popen[bytes]]]:
    """Address and scheduler of a cluster of one worker of one thread.

    ``environment`` is added to this process's, without ``drop``.
    """
    import distributed

    every = {name: value for name, value in os.environ.items() if name not in drop} | dict(environment)

    def start(module: str, *options: str) -> subprocess.Popen[bytes]:
        command = [sys.executable, "-m", f"distributed.cli.{module}", *options, "--no-dashboard"]
        quiet = {"stderr": subprocess.DEVNULL, "stdout": subprocess.DEVNULL}
        return subprocess.Popen(command, env=every, cwd=folder, **quiet)  # type: ignore[call-overload]  # flags

    file = folder / "scheduler.json"
    made = [start("dask_scheduler", "--port", "0", "--host", "127.0.0.1", "--scheduler-file", str(file))]
    try:
        address = _address(file, made[0])
        alone = ("--no-nanny", "--nthreads", "1", "--local-directory", str(folder))
        made.append(start("dask_worker", address, *alone))
        connect: Any = distributed.Client  # untyped
        with connect(address, timeout=START_SECONDS) as client:
            client.wait_for_workers(1, timeout=START_SECONDS)
        yield address, made[0]
    finally:
        for process in made:
            process.kill()
            process.wait()


def _address(file: Path, process: subprocess.Popen[bytes]) -> str:
    """The address that the scheduler has written, when it has."""
    deadline = time.monotonic() + START_SECONDS
    while time.monotonic() < deadline and process.poll() is None:
        try:
            return str(json.loads(file.read_text())["address"])
        except (FileNotFoundError, ValueError):
            time.sleep(0.05)
    raise TimeoutError("the scheduler did not start")
