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
from collections.abc import Callable, Iterator
from concurrent.futures import (
    CancelledError,
    Executor,
    Future,
    ProcessPoolExecutor,
    ThreadPoolExecutor,
    as_completed,
)
from concurrent.futures.process import BrokenProcessPool
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from refimpl.errors import InputError, require_installed
from refimpl.operating_system import interrupts_blocked
from verification.framework.threads import one_thread
from verification.framework.workers import kill_workers
from verification.sweep.run import CERTIFIED, Row, Run, execute
from verification.sweep.store import open_store
from verification.sweep.study import Study

CONNECT_SECONDS = 10.0  # for a scheduler to answer


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
    that are the same run.
    """

    found: int
    finished: int
    failures: dict[str, str]
    rows: list[Row]
    seconds: float

    @property
    def statuses(self) -> dict[str, int]:
        """Number of rows by `refimpl.Status`."""
        return dict(Counter(row["status"] for row in self.rows))

    @property
    def unconverged(self) -> list[Row]:
        """The rows whose numbers are no solution; they are kept: solved again, they would end the same."""
        return [row for row in self.rows if row["status"] not in CERTIFIED]

    def to_dataframe(self) -> Any:
        """Return a `pandas.DataFrame` by full names, ``attrs["units"]`` beside. InputError without pandas."""
        from verification.sweep.export import to_dataframe

        return to_dataframe(self.rows)


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

    ``workers`` processes, or with 0 this process, which should have one BLAS thread; ``scheduler`` is the
    address of a dask.distributed cluster. A run that raises is in ``failures``, and is tried again by the
    next sweep. Raises InputError for a store or a scheduler that cannot serve, WorkersLost when a worker
    process was killed or the scheduler is lost; a cluster that lost its last worker is waited for.
    """
    started = time.perf_counter()
    # Points without roughness are the same run in every realisation, and are solved once.
    runs = list({run.key: run for run in study.runs()}.values())
    with ExitStack() as stack:
        executor = None if scheduler is None else stack.enter_context(_cluster(scheduler))
        kept = stack.enter_context(open_store(store))
        present = kept.keys()
        missing = [run for run in runs if run.key not in present]
        meter = _Meter(len(runs), missing, tick)
        failures: dict[str, str] = {}
        if missing:
            executor = executor or stack.enter_context(_here(workers))
            waiting = {executor.submit(execute, run.inputs): run for run in missing}
            for done in as_completed(waiting):
                run, failure = waiting.pop(done), _failure(done)
                if failure is None:
                    kept.add(run, done.result())
                else:
                    failures[run.key] = f"{type(failure).__name__}: {failure}"
                meter.count(run, failed=failure is not None)
        rows = list(kept.finished(runs))
    found = len(runs) - len(missing)
    return Sweep(found, len(missing) - len(failures), failures, rows, time.perf_counter() - started)


def _failure(done: Future[Row]) -> BaseException | None:
    """Return what the run raised; raises WorkersLost where it is not the run's doing."""
    try:
        failure = done.exception()
    except CancelledError as lost:
        raise WorkersLost("the scheduler was lost") from lost
    if isinstance(failure, BrokenProcessPool):
        raise WorkersLost("a worker process died")
    return failure


@contextmanager
def _here(workers: int) -> Iterator[Executor]:
    """Yield this process, or fresh interpreters ('spawn') with one thread each, that end with it."""
    if workers == 0:
        thread = ThreadPoolExecutor(1)
        try:
            yield thread
        finally:
            thread.shutdown(cancel_futures=True)
        return
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
    """Leave a worker when the parent is gone. A killed parent cannot tell its workers to stop."""
    parent = multiprocessing.parent_process()
    if parent is None:
        return
    sentinel = parent.sentinel

    def watch() -> None:
        multiprocessing.connection.wait([sentinel])
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()


@contextmanager
def _cluster(address: str) -> Iterator[Executor]:
    allowed = "dask.distributed installed: pip install '.[cluster]' in a checkout"
    require_installed("--scheduler", address, allowed, "distributed")
    import distributed

    connect: Any = distributed.Client  # untyped
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

        threads = client.nthreads()
        if not threads or set(threads.values()) != {1}:
            found = f"{address} with workers of {sorted(threads.values())} threads"
            allowed = "workers of one thread each (dask worker --nthreads 1)"
            raise InputError("--scheduler", found, allowed)
        yield client.get_executor(pure=False)


class _Meter:
    """Counts finished runs and estimates the time left from the work done so far."""

    def __init__(self, total: int, missing: list[Run], tick: Callable[[Progress], None]) -> None:
        self._total, self._done, self._failed = total, total - len(missing), 0
        self._left, self._worked = sum(run.weight for run in missing), 0.0
        self._started, self._tick = time.perf_counter(), tick
        tick(Progress(self._done, total, 0, None))

    def count(self, run: Run, *, failed: bool) -> None:
        """Record one finished run."""
        self._done += not failed
        self._failed += failed
        self._worked += run.weight
        self._left -= run.weight
        seconds = (time.perf_counter() - self._started) * self._left / self._worked
        self._tick(Progress(self._done, self._total, self._failed, max(seconds, 0.0)))
