"""A contestant at work in a process of its own: a crash, a hang or an early exit is an `error`, never a pass."""

from __future__ import annotations

import importlib
import multiprocessing
import os
import signal
import sys
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from multiprocessing.connection import Connection

from refimpl.errors import InputError
from verification.case import Result, Status
from verification.contestants.check import Check
from verification.contestants.protocol import Abilities, Contestant, abilities_of
from verification.contestants.suite import select, suite

GRACE = 10.0
"""Seconds beyond the time limit: a command's own limit goes first, and says more."""


@dataclass(frozen=True)
class Named:
    """A contestant by the name of a Python object, ``package.module:function``.

    ``abilities``, if given, replace those that the object carries.
    """

    name: str
    abilities: Abilities | None = None

    def contestant(self) -> Contestant:
        """Import the object. Raises `InputError` where there is none, or where it cannot be called."""
        module, _, attribute = self.name.partition(":")
        allowed = "package.module:function, importable from here"
        if not module or not attribute:
            raise InputError("--solver", self.name, allowed)
        sys.path.insert(0, os.getcwd())
        try:
            found: object = importlib.import_module(module)
            for part in attribute.split("."):
                found = getattr(found, part)
        except (ImportError, AttributeError) as missing:
            raise InputError("--solver", self.name, f"{allowed} ({missing})") from missing
        if not callable(found):
            raise InputError("--solver", self.name, allowed)
        abilities_of(found)
        return found if self.abilities is None else _Limited(found, self.abilities)


@dataclass(frozen=True)
class _Limited:
    """A contestant with other abilities than it carries itself."""

    solver: Contestant
    abilities: Abilities

    def __call__(self, problem: object) -> object:
        return self.solver(problem)  # type: ignore[arg-type]  # passed through untouched


Source = Callable[[], Contestant]
"""Makes the contestant, in the process that will run it; must be picklable."""


class Table:
    """Runs checks one by one in a child process, and starts a new one after a death or a timeout."""

    def __init__(self, source: Source, timeout: float) -> None:
        if not timeout > 0:
            raise InputError("--timeout", timeout, "a positive number of seconds")
        self._source, self._timeout = source, timeout
        self._open()

    def run(self, check: Check) -> Result:
        """The verdict on one check; never raises for what the contestant does."""
        start = time.perf_counter()
        try:
            self._pipe.send(check.slug)
            if self._pipe.poll(self._timeout + GRACE):
                result: Result = self._pipe.recv()
                return result
            note = f"no verdict within {self._timeout:g} s"
        except (EOFError, OSError):
            note = f"the solver's process died (exit status {self._exit_status()})"
        self.close()
        self._open()
        case = check.case(_absent)
        return case.result(Status.ERROR, note, time.perf_counter() - start)

    def close(self) -> None:
        """End the process and all that it started."""
        self._pipe.close()
        if self._process.pid is not None and self._process.is_alive():
            try:
                os.killpg(self._process.pid, signal.SIGKILL)
            except ProcessLookupError:
                self._process.kill()
        self._process.join()

    def _open(self) -> None:
        context = multiprocessing.get_context("spawn")
        self._pipe, theirs = context.Pipe()
        self._process = context.Process(target=_serve, args=(theirs, self._source), daemon=True)
        self._process.start()
        theirs.close()
        try:
            refusal = self._pipe.recv()
        except EOFError:
            refusal = InputError(
                "--solver", repr(self._source), "a solver that can be imported; its process died"
            )
        if refusal is not None:
            self.close()
            raise refusal

    def _exit_status(self) -> int | None:
        self._process.join(1.0)
        return self._process.exitcode


def _absent(problem: object) -> object:
    raise RuntimeError("stands for a contestant whose process died")


def _serve(pipe: Connection, source: Source) -> None:
    """In the child: what the solver prints goes to stderr, so that it cannot end up in a result file."""
    os.setsid()
    os.dup2(2, 1)
    try:
        contestant = source()
    except InputError as refused:
        pipe.send(refused)
        return
    pipe.send(None)
    checks = {check.slug: check for check in suite()}
    while True:
        try:
            slug = pipe.recv()
        except EOFError:
            return
        pipe.send(checks[slug].case(contestant).run())


def run(
    source: Source, globs: Iterable[str], *, timeout: float, tick: Callable[[Result], None] = lambda r: None
) -> list[Result]:
    """Results of the checks that match ``globs`` (all without any), each within about ``timeout`` seconds.

    Raises `InputError` for a contestant that cannot be had, LookupError for a glob that matches nothing.
    """
    chosen = select(globs)
    table, results = Table(source, timeout), []
    try:
        for check in chosen:
            results.append(table.run(check))
            tick(results[-1])
    finally:
        table.close()
    return results
