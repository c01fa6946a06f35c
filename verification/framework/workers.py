"""Worker processes for cases: one thread each, so that their number changes no result."""

from __future__ import annotations

import importlib
import itertools
import multiprocessing
import queue
import threading
import time
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import ExitStack
from multiprocessing.process import BaseProcess

from refimpl.operating_system import interrupts_blocked
from verification.framework import registry
from verification.framework.case import Case, Result, Status
from verification.framework.threads import one_thread


class Worker:
    """A process that runs cases one by one. A case that kills it is an `error`, and a new process starts."""

    def __init__(self) -> None:
        self._pool = _process()

    def run(self, case: Case) -> Result:
        """Return the case's verdict; never raises for what the case does."""
        start = time.perf_counter()
        try:
            with interrupts_blocked():
                running = self._pool.submit(_run_in_worker, case.module, case.id)
            return running.result()
        except BrokenProcessPool:
            self.close()
            self._pool = _process()
            note = "the worker process died while it ran this case"
            return case.result(Status.ERROR, note, time.perf_counter() - start)

    def close(self) -> None:
        """End the process."""
        self._pool.shutdown()


def run_all(cases: Sequence[Case], jobs: int, tick: Callable[[Result], None]) -> list[Result]:
    """Return the results in the order of `cases`, from `jobs` workers; `tick` sees each as it is finished.

    A worker takes the cases of a whole module, in their order, since those may share a cached solution.
    """
    before = set(multiprocessing.active_children())
    modules = [list(module) for _, module in itertools.groupby(cases, key=lambda c: c.module)]
    idle: queue.SimpleQueue[Worker] = queue.SimpleQueue()
    stopped = threading.Event()

    def work(module: list[Case]) -> list[Result]:
        worker, results = idle.get(), []
        try:
            for case in itertools.takewhile(lambda _: not stopped.is_set(), module):
                results.append(worker.run(case))
                tick(results[-1])
        finally:
            idle.put(worker)
        return results

    with ExitStack() as ending:
        for worker in (Worker() for _ in range(jobs)):
            ending.callback(worker.close)
            idle.put(worker)
        with one_thread(), ThreadPoolExecutor(jobs) as threads:
            try:
                return [result for results in threads.map(work, modules) for result in results]
            except BaseException:
                stopped.set()
                kill_workers(before)
                raise


def kill_workers(others: set[BaseProcess]) -> None:
    """Kill this process's worker processes but for the others."""
    for worker in set(multiprocessing.active_children()) - others:
        worker.kill()


def _process() -> ProcessPoolExecutor:
    """Start fresh interpreters ('spawn'): nothing is inherited but the environment and the module path."""
    return ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("spawn"))


def _run_in_worker(module: str, case_id: str) -> Result:
    """Find the case again in the worker, by module and id: its function need not be picklable."""
    importlib.import_module(module)
    return registry.find(case_id).run()
