"""A solver under test in a process of its own: a crash, hang or early exit is an `error`, never a pass."""

from __future__ import annotations

import importlib
import multiprocessing
import os
import signal
import sys
import time
from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field, replace
from multiprocessing.connection import wait
from typing import Any

from refimpl.errors import InputError
from refimpl.grid import Array
from verification.contestants.check import Check
from verification.contestants.command import require_timeout
from verification.contestants.ending import told
from verification.contestants.protocol import Abilities, Answer, ContactProblem, Contestant, abilities_of
from verification.contestants.serving import PATIENCE, Source, serve
from verification.contestants.suite import select
from verification.framework.case import Result, Status

MOST_PROBLEMS = 6
"""No check poses more problems: so many times the time for one is the time for a check."""
GRACE = 10.0
"""Seconds beyond that: a command's own limit goes first, and says more."""
START = 120.0
"""Seconds for a new process to import the solver and the suite."""


@dataclass(frozen=True)
class Named:
    """A solver under test by the name of a Python object, ``package.module:function``.

    ``stated`` are fields of `Abilities` that replace those that the object carries; the others stay.
    """

    name: str
    stated: Mapping[str, Any] = field(default_factory=dict)

    def contestant(self) -> Contestant:
        """Import the object. Raises `InputError` where that fails, and where it cannot be called."""
        module, _, attribute = self.name.partition(":")
        allowed = "package.module:function, importable from here"
        if not module or not attribute:
            raise InputError("--solver", self.name, allowed)
        sys.path.insert(0, os.getcwd())
        try:
            found: Any = importlib.import_module(module)
            for part in attribute.split("."):
                found = getattr(found, part)
        except (Exception, SystemExit) as broken:  # a module may do anything when it is imported
            reason = f"{type(broken).__name__}: {broken}"
            raise InputError("--solver", self.name, f"{allowed} ({reason})") from broken
        if not callable(found):
            raise InputError("--solver", self.name, allowed)
        carried = abilities_of(found)
        return Limited(found, replace(carried, **self.stated)) if self.stated else found


@dataclass(frozen=True)
class Limited:
    """A solver under test with other abilities than its own attribute states."""

    solver: Contestant
    abilities: Abilities

    def __call__(self, problem: ContactProblem) -> Answer | Array:
        """Pass the problem on."""
        return self.solver(problem)


class Table:
    """Runs checks one by one in a child process, and starts a new one after a death or a timeout."""

    def __init__(self, source: Source, timeout: float, name: str) -> None:
        require_timeout(timeout)
        self._source, self._limit, self._name = source, MOST_PROBLEMS * timeout + GRACE, name
        self._open()

    def run(self, check: Check) -> Result:
        """Return the verdict on one check; never raises for a fault of the solver under test."""
        start, case = time.perf_counter(), check.case(_absent)
        try:
            self._pipe.send(check.slug)
            if self._pipe.poll(self._limit):
                result: object = self._pipe.recv()
                if isinstance(result, Result) and result.id == case.id:
                    return result
                note = "the solver's process sent something else than this case's verdict"
            else:
                note = f"no verdict within {self._limit:g} s"
        except (EOFError, OSError):
            note = f"the solver's process died ({told(self._exit_status())})"
        self.close()
        self._open()
        return case.result(Status.ERROR, note, time.perf_counter() - start)

    def close(self) -> None:
        """End the process and what it started: first in good order, then by force.

        What has left the process's group is out of reach, but for a program that the process itself ran.
        """
        self._process.terminate()
        wait([self._process.sentinel], PATIENCE)
        if self._process.pid is not None:
            with suppress(ProcessLookupError):  # gone already, or not yet the head of a group
                os.killpg(self._process.pid, signal.SIGKILL)
        self._process.kill()
        self._process.join()
        self._pipe.close()

    def _open(self) -> None:
        context = multiprocessing.get_context("spawn")
        self._pipe, theirs = context.Pipe()
        self._process = context.Process(target=serve, args=(theirs, self._source))
        self._process.start()
        theirs.close()
        try:
            refusal = self._refusal()
        except BaseException:
            self.close()
            raise
        if refusal is not None:
            self.close()
            raise refusal

    def _refusal(self) -> InputError | None:
        """What the new process has against the solver, or what became of the process itself."""
        try:
            if self._pipe.poll(START):
                refused: InputError | None = self._pipe.recv()
                return refused
            reason = f"no end within {START:g} s"
        except EOFError:
            reason = f"its process died, {told(self._exit_status())}"
        return InputError("--solver", self._name, f"a solver whose import ends well ({reason})")

    def _exit_status(self) -> int | None:
        self._process.join(1.0)
        return self._process.exitcode


def _absent(problem: ContactProblem) -> Answer:
    raise RuntimeError("stands for a solver whose process died")


def run(
    source: Source,
    globs: Iterable[str],
    *,
    timeout: float,
    name: str = "the solver",
    tick: Callable[[Result], None] = lambda r: None,
) -> list[Result]:
    """Results of the checks that match ``globs`` (all without any), with ``timeout`` seconds for one problem.

    A check is ended after `MOST_PROBLEMS` times that and `GRACE`: a function cannot be timed from outside
    problem by problem. ``name`` is what a refusal calls the solver.

    Raises `InputError` for a solver that cannot be loaded, LookupError for a glob that matches nothing.
    """
    chosen = select(globs)
    table, results = Table(source, timeout, name), []
    try:
        for check in chosen:
            results.append(table.run(check))
            tick(results[-1])
    finally:
        table.close()
    return results
