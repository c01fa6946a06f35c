"""Runs what a store lacks of a study: in this process, in worker processes, or on a dask cluster.

Only the process that called `sweep` writes. A run's numbers depend on its inputs alone (one BLAS and FFT
thread everywhere), so how many workers there are, and how often they were killed, changes no result.
"""

from __future__ import annotations

import logging
import multiprocessing
import multiprocessing.connection
import os
import threading
import time
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import (
    FIRST_COMPLETED,
    CancelledError,
    Executor,
    Future,
    ProcessPoolExecutor,
    ThreadPoolExecutor,
    wait,
)
from concurrent.futures.process import BrokenProcessPool
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from refimpl.errors import InputError
from refimpl.operating_system import interrupts_blocked
from verification.framework.threads import one_thread
from verification.framework.workers import kill_workers
from verification.sweep.run import CERTIFIED, Row, Run, execute
from verification.sweep.store import open_store
from verification.sweep.study import Study

PER_WORKER = 2  # runs submitted per worker: one at work, one waiting
CONNECT_SECONDS = 10.0  # for a scheduler to answer
POLL_SECONDS = 1.0  # between two looks at whether a cluster is still there
PATIENCE_SECONDS = 30.0  # for a new worker to come when the last one is lost


@dataclass(frozen=True)
class Progress:
    """State of a sweep for its progress line; ``seconds_left`` is None until a run is finished."""

    done: int
    total: int
    failed: int
    seconds_left: float | None


@dataclass(frozen=True)
class Sweep:
    """Result of a sweep: runs found in the store, finished now, and failed (key to message).

    ``rows`` are those of the study in its order, all of them exactly when nothing failed, and one for points
    that are the same run; ``solve_seconds`` is the processor time that each took, whenever that was.
    """

    found: int
    finished: int
    failures: dict[str, str]
    rows: list[Row]
    solve_seconds: list[float]
    seconds: float

    @property
    def statuses(self) -> dict[str, int]:
        """Number of rows by `refimpl.Status`."""
        return dict(Counter(row["status"] for row in self.rows))

    @property
    def unconverged(self) -> list[Row]:
        """The rows whose numbers are no solution; they are kept: solved again, they would end the same."""
        return [row for row in self.rows if row["status"] not in CERTIFIED]

    def table(self) -> list[Row]:
        """Return the rows with the processor seconds that each took."""
        return [row | {"seconds": took} for row, took in zip(self.rows, self.solve_seconds, strict=True)]

    def to_dataframe(self) -> Any:
        """Return the table as a `pandas.DataFrame`, a column for each parameter varied by its full name too.

        Units are in ``attrs["units"]``. Raises `InputError` where pandas is not installed.
        """
        from verification.sweep.export import to_dataframe

        return to_dataframe(self.table())


class WorkersLost(RuntimeError):
    """Workers or the cluster died; what was finished is kept, and the same sweep goes on from there."""

    def __init__(self, found: str) -> None:
        super().__init__(f"{found}; run the same sweep again to go on")


def sweep(
    study: Study,
    store: Path,
    *,
    workers: int = 1,
    scheduler: str | None = None,
    tick: Callable[[Progress], None] = lambda _: None,
) -> Sweep:
    """Run the study's missing runs and keep each as it finishes.

    ``workers`` processes, or with 0 this process itself, which then should have one BLAS thread;
    ``scheduler`` is the address of a dask.distributed cluster to use instead. A run that raises is reported
    in ``failures``, is not kept, and is tried again by the next sweep. Raises InputError for a store that
    another sweep is using or a scheduler that cannot serve, WorkersLost when a worker process was killed, or
    the scheduler or the last worker of a cluster is lost.
    """
    started = time.perf_counter()
    # Points without roughness are the same run in every realisation, and are solved once.
    runs = list({run.key: run for run in study.runs()}.values())
    with ExitStack() as stack:
        kept = stack.enter_context(open_store(store))
        present = kept.keys()
        missing = [run for run in runs if run.key not in present]
        meter = _Meter(len(runs), missing, tick)
        failures: dict[str, str] = {}
        if missing:
            for run, done in _executed(stack, missing, workers, scheduler):
                failure = _failure(done)
                if failure is None:
                    kept.add(run, *done.result())
                else:
                    failures[run.key] = f"{type(failure).__name__}: {failure}"
                meter.count(run, failed=failure is not None)
        finished = list(kept.finished(runs))
    found = len(runs) - len(missing)
    rows, spent = [row for row, _ in finished], [took for _, took in finished]
    return Sweep(found, len(missing) - len(failures), failures, rows, spent, time.perf_counter() - started)


Done = Iterator[tuple[Run, "Future[tuple[Row, float]]"]]


def _failure(done: Future[tuple[Row, float]]) -> BaseException | None:
    """What the run raised; raises WorkersLost where it is not the run's doing."""
    try:
        failure = done.exception()
    except CancelledError as lost:
        raise WorkersLost("the scheduler was lost") from lost
    if isinstance(failure, BrokenProcessPool):
        raise WorkersLost("a worker process died")
    return failure


def _executed(stack: ExitStack, runs: list[Run], workers: int, scheduler: str | None) -> Done:
    if scheduler is not None:
        executor, size, check_alive = stack.enter_context(_cluster(scheduler))
        return _through(executor, runs, PER_WORKER * size, check_alive)
    if workers == 0:
        here = stack.enter_context(ThreadPoolExecutor(1))
        return _through(here, runs, depth=1)
    executor = stack.enter_context(_processes(workers))
    return _through(executor, runs, PER_WORKER * workers)


def _through(
    executor: Executor, runs: Iterable[Run], depth: int, check_alive: Callable[[], None] = lambda: None
) -> Done:
    """Runs as they finish, at most ``depth`` submitted at a time; ``check_alive`` raises where none will."""
    waiting: dict[Future[tuple[Row, float]], Run] = {}
    queue = iter(runs)
    exhausted = False
    while waiting or not exhausted:
        while not exhausted and len(waiting) < depth:
            run = next(queue, None)
            if run is None:
                exhausted = True
            else:
                waiting[executor.submit(execute, run.inputs)] = run
        finished, _ = wait(waiting, POLL_SECONDS, FIRST_COMPLETED)
        if waiting and not finished:
            check_alive()
        for future in finished:
            yield waiting.pop(future), future


@contextmanager
def _processes(workers: int) -> Iterator[ProcessPoolExecutor]:
    """Fresh interpreters ('spawn') with one thread each, that end when this process does."""
    context = multiprocessing.get_context("spawn")
    with one_thread():
        executor = ProcessPoolExecutor(workers, mp_context=context, initializer=_end_with_parent)
        before = set(multiprocessing.active_children())
        with interrupts_blocked():
            for _ in range(workers):  # each starts a worker, as none is idle yet
                executor.submit(int)
        try:
            yield executor
            executor.shutdown()
        finally:
            executor.shutdown(wait=False, cancel_futures=True)
            kill_workers(before)  # the next sweep repeats unfinished runs


def _end_with_parent() -> None:
    """In a worker: leave when the parent is gone. A killed parent cannot tell its workers to stop."""
    parent = multiprocessing.parent_process()
    if parent is None:
        return
    sentinel = parent.sentinel

    def watch() -> None:
        multiprocessing.connection.wait([sentinel])
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()


@contextmanager
def _cluster(address: str) -> Iterator[tuple[Executor, int, Callable[[], None]]]:
    """A running dask.distributed scheduler: its workers as an executor, their number, a check of life."""
    try:
        import distributed

        connect: Any = distributed.Client  # untyped
    except ModuleNotFoundError as missing:
        allowed = "dask.distributed installed: pip install '.[cluster]' in a checkout"
        raise InputError("--scheduler", address, allowed) from missing
    with ExitStack() as stack:
        # libraries are silent about connections that break: `WorkersLost` is one line about them
        stack.callback(logging.disable, logging.root.manager.disable)
        logging.disable(logging.CRITICAL)
        try:
            client = connect(address, timeout=CONNECT_SECONDS)
        except (OSError, ValueError) as unreachable:
            allowed = f"a scheduler's address ({unreachable})"
            raise InputError("--scheduler", address, allowed) from unreachable
        stack.callback(client.close, timeout=CONNECT_SECONDS)
        cluster = _Cluster(client)
        threads = cluster.threads()
        if not threads or set(threads.values()) != {1}:
            found = f"{address} with workers of {sorted(threads.values())} threads"
            allowed = "workers of one thread each (dask worker --nthreads 1)"
            raise InputError("--scheduler", found, allowed)
        yield client.get_executor(pure=False), len(threads), cluster.check_alive


class _Cluster:
    """Whether a cluster can still finish what was submitted."""

    def __init__(self, client: Any) -> None:
        self._client, self._worked = client, time.monotonic()

    def threads(self) -> dict[str, int]:
        """Threads by worker; raises WorkersLost where the scheduler does not answer in time."""
        try:
            ask = self._client.scheduler.ncores
            found: dict[str, int] = self._client.sync(ask, workers=None, callback_timeout=CONNECT_SECONDS)
        except (OSError, TimeoutError, CancelledError) as lost:  # comm errors of distributed are OSErrors
            raise WorkersLost("the scheduler was lost") from lost
        return found

    def check_alive(self) -> None:
        """Raise WorkersLost where the scheduler is lost, or there has been no worker for too long."""
        if self._client.status != "running":
            raise WorkersLost("the scheduler was lost")
        if self.threads():
            self._worked = time.monotonic()
        elif time.monotonic() - self._worked > PATIENCE_SECONDS:
            raise WorkersLost("the last worker of the cluster was lost")


class _Meter:
    """Counts finished runs and estimates the time left from the work done so far."""

    def __init__(self, total: int, missing: list[Run], tick: Callable[[Progress], None]) -> None:
        self._total, self._done, self._failed = total, total - len(missing), 0
        self._left, self._worked = sum(run.weight for run in missing), 0.0
        self._started, self._tick = time.perf_counter(), tick
        tick(Progress(self._done, total, 0, None))

    def count(self, run: Run, *, failed: bool) -> None:
        """One run is finished."""
        self._done += not failed
        self._failed += failed
        self._worked += run.weight
        self._left -= run.weight
        seconds = (time.perf_counter() - self._started) * self._left / self._worked
        self._tick(Progress(self._done, self._total, self._failed, max(seconds, 0.0)))
