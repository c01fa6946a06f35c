"""The suite with a solver in a process of its own: the judge, here, is out of the solver's reach.

A solver may crash, hang, fork, or write into every descriptor that it finds: its case gets an `error`, and a
new process starts. What it started is ended with it, whatever session that is in (`process.end_all`).
"""

from __future__ import annotations

import importlib
import multiprocessing
import os
import pickle
import secrets
import socket
import sys
import time
from collections.abc import Callable, Iterable, Mapping
from contextlib import ExitStack
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from refimpl.errors import InputError
from refimpl.grid import Array
from refimpl.operating_system import interrupts_blocked, start_tracker
from verification.framework.case import Reported, Result, Unavailable, readable
from verification.solver_suite import process
from verification.solver_suite.check import Check
from verification.solver_suite.command import require_timeout
from verification.solver_suite.identity import Identity, of_object
from verification.solver_suite.process import Source
from verification.solver_suite.protocol import (
    NUMBERS,
    Abilities,
    Answer,
    ContactProblem,
    SolverUnderTest,
    abilities_of,
)
from verification.solver_suite.suite import select

GRACE = 5.0
"""Seconds beyond the limit of a problem: a command's own limit goes first, and says more."""
START = 120.0
"""Seconds for a new process to import the solver."""


@dataclass(frozen=True)
class Named:
    """A solver under test by the name of a Python object, ``package.module:function``.

    ``stated`` are fields of `Abilities` that replace those that the object carries; the others stay.
    """

    name: str
    stated: Mapping[str, Any] = field(default_factory=dict)

    def solver(self) -> SolverUnderTest:
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
        return Limited(found, replace(carried, **self.stated), of_object(module, found))


@dataclass(frozen=True)
class Limited:
    """A solver under test with the abilities that it is given here, and its identity."""

    solver: SolverUnderTest
    abilities: Abilities
    identity: Identity = field(default_factory=dict)

    def __call__(self, problem: ContactProblem) -> Answer | Array:
        """Pass the problem on."""
        return self.solver(problem)


class Remote:
    """A solver under test in another process: poses problems to it, and starts it anew after a failure.

    ``left`` names the processes that it left behind so far; ``identity`` is what its process says of it.
    """

    def __init__(self, source: Source, timeout: float, name: str) -> None:
        require_timeout(timeout)
        self._source, self._limit, self._name = source, timeout + GRACE, name
        self._mark, self._number, self._lost = secrets.token_hex(8), 0, False
        self.left: list[str] = []
        self.identity: Identity = {}
        start_tracker()
        self.abilities = self._open()

    def __call__(self, problem: ContactProblem) -> Answer:
        """The solver's answer. Raises `Reported` for what became of it instead, and `Unavailable`."""
        if self._lost:
            self.close()
            self._open()
        self._number, deadline = self._number + 1, time.monotonic() + self._limit
        try:
            reply, body = self._exchange(problem, deadline)
        except BaseException:
            self._lost = True
            raise
        if reply["kind"] == "unavailable":
            raise Unavailable(str(reply.get("note", "")))
        if reply["kind"] != "answer":
            raise Reported(str(reply.get("note", "")))
        beside = {name: reply.get(name) for name in NUMBERS}
        return Answer(np.frombuffer(body, "<f8").reshape(problem.shape), True, **beside)

    def _exchange(self, problem: ContactProblem, deadline: float) -> tuple[dict[str, Any], bytes]:
        try:
            question = {"number": self._number}
            process.send(self._socket, question, pickle.dumps(problem), seconds=self._limit)
            reply: dict[str, Any] = {}
            while reply.get("number") != self._number:  # an earlier answer's double is skipped
                left = max(0.0, deadline - time.monotonic())
                reply, body = process.receive(self._socket, seconds=left)
                if not (isinstance(reply.get("number"), int) and reply["number"] <= self._number):
                    raise process.Garbled("an answer to no problem")
            if reply.get("kind") not in ("answer", "failed", "unavailable"):
                raise process.Garbled("an answer of no kind")
            if reply["kind"] == "answer" and len(body) != problem.gap.nbytes:
                raise process.Garbled("pressures of another size")
        except process.Late:
            raise Reported(f"no answer within {self._limit:g} s") from None
        except process.Garbled:
            raise Reported("the solver's process sent something else than an answer") from None
        except (EOFError, OSError):
            raise Reported(f"the solver's process died ({process.exit_text(self._exit_status())})") from None
        return reply, body

    def close(self) -> None:
        """End the process and what it started."""
        self.left += process.end_all(self._process, self._mark)
        self._socket.close()

    def _open(self) -> Abilities:
        context, before = multiprocessing.get_context("spawn"), os.environ.get(process.SOLVER_OF)
        self._socket, theirs = socket.socketpair()
        self._lost = False
        os.environ[process.SOLVER_OF] = self._mark
        try:
            with interrupts_blocked():
                self._process = context.Process(target=process.serve, args=(theirs, self._source))
                self._process.start()
        finally:
            del os.environ[process.SOLVER_OF]
            if before is not None:
                os.environ[process.SOLVER_OF] = before
            theirs.close()
        try:
            return self._greeting()
        except BaseException:
            self.close()
            raise

    def _greeting(self) -> Abilities:
        """Abilities of the solver. Raises `InputError` for one that is refused, or whose process is lost."""
        try:
            reply, _ = process.receive(self._socket, seconds=START)
            if reply.get("kind") == "refused":
                raise InputError(str(reply["field"]), str(reply["value"]), str(reply["allowed"]))
            self.identity = {name: readable(str(text)) for name, text in reply["identity"].items() if text}
            return Abilities(**reply["abilities"])
        except process.Late:
            reason = f"no end within {START:g} s"
        except (EOFError, OSError):
            reason = f"its process died, {process.exit_text(self._exit_status())}"
        except (process.Garbled, AttributeError, KeyError, TypeError):
            reason = "its process sent something else than its abilities"
        raise InputError("--solver", self._name, f"a solver whose import ends well ({reason})")

    def _exit_status(self) -> int | None:
        self._process.join(1.0)
        return self._process.exitcode


def run(
    source: Source,
    globs: Iterable[str],
    *,
    timeout: float,
    name: str = "the solver",
    among: tuple[Check, ...] | None = None,
    identified: Callable[[Identity], None] = lambda identity: None,
    begin: Callable[[Check], None] = lambda check: None,
    tick: Callable[[Result], None] = lambda result: None,
    left: Callable[[str], None] = lambda process: None,
) -> list[Result]:
    """Results of the checks that match ``globs`` (all without any), with ``timeout`` seconds for one problem.

    ``among`` takes the place of the suite; ``name`` is what a refusal calls the solver. ``identified`` sees
    the solver's identity, ``begin`` and ``tick`` each check before and after, and ``left`` what the solver
    left running.

    Raises `InputError` for a solver that cannot be loaded, LookupError for a glob that matches nothing.
    """
    chosen, results = select(globs, among), []
    with ExitStack() as ending:
        remote = Remote(source, timeout, name)
        ending.callback(lambda: any(map(left, remote.left)))
        ending.callback(remote.close)
        identified(remote.identity)
        for check in chosen:
            begin(check)
            results.append(check.case(remote).run())
            tick(results[-1])
    return results
