"""The suite with a solver in a process of its own: the judge's objects, here, are not the solver's to change.

It may forge a reply, so no number of one is believed but what the judge recomputes; who it is, and what it
declines, is its own word. It may crash, hang, or fork: its case gets an `error`, and a new process starts.
What it started is ended with it (`process.end_all`).
"""

from __future__ import annotations

import importlib
import os
import secrets
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterable, Mapping
from contextlib import ExitStack
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from refimpl.errors import InputError
from refimpl.grid import Array
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
    """A Python object, ``package.module:function``; ``stated`` replaces fields of its `Abilities`."""

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
        return self.solver(problem)


class Remote:
    """A solver under test in another process: poses problems to it, and starts it anew after a failure.

    ``left`` names the processes that it left behind so far; ``identity`` is what its process says of it.
    """

    def __init__(self, source: Source, timeout: float, name: str) -> None:
        require_timeout(timeout)
        self._source, self._limit, self._name = source, timeout + GRACE, name
        self._mark, self._lost = secrets.token_hex(8), True
        self.left: list[str] = []
        self.identity: Identity = {}
        self.abilities = self._open()

    def __call__(self, problem: ContactProblem) -> Answer:
        if self._lost:
            self.close()
            self._open()
        self._number += 1
        self._lost = True  # until there is a reply
        process.pose(self._process, self._folder, self._number, problem)
        place = self._folder / str(self._number)
        reply, body = process.reply(self._process, place, self._limit, problem.gap.nbytes)
        self._lost = False
        if reply.get("kind") == "unavailable":
            raise Unavailable(str(reply.get("note", "")))
        if reply.get("kind") != "answer":
            raise Reported(str(reply.get("note", "")))
        beside = {name: reply.get(name) for name in NUMBERS}
        return Answer(np.frombuffer(body, "<f8").reshape(problem.shape), True, **beside)

    def close(self) -> None:
        """End the process and what it started, once."""
        self._ending.close()

    def _open(self) -> Abilities:
        self._folder, self._number = Path(tempfile.mkdtemp(prefix="solver-")), 0
        with ExitStack() as opened:
            opened.callback(shutil.rmtree, self._folder, ignore_errors=True)
            self._process: subprocess.Popen[bytes] = process.start(self._source, self._folder, self._mark)
            opened.callback(lambda: self.left.extend(process.end_all(self._process, self._mark)))
            abilities = self._greeting()
            self._ending = opened.pop_all()
        self._lost = False
        return abilities

    def _greeting(self) -> Abilities:
        """Return the solver's abilities. Raises `InputError` if it is refused, or its process is lost."""
        try:
            said, _ = process.reply(self._process, self._folder / "0", START)
            if "abilities" in said:
                named = dict(said["identity"]).items()
                self.identity = {name: readable(str(text)) for name, text in named if text}
                return Abilities(**said["abilities"])
            refused = {name: str(said[name]) for name in ("field", "value", "allowed")}
        except (Reported, KeyError, TypeError, ValueError) as lost:
            reason = f"a solver whose import ends well ({lost})"
            raise InputError("--solver", self._name, reason) from None
        raise InputError(**refused)


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
    """Return the results of checks that match ``globs`` (or all), ``timeout`` seconds a problem.

    ``among`` takes the place of the suite; ``name`` is what a refusal calls the solver. ``identified`` sees
    its identity, ``begin`` and ``tick`` each check before and after, ``left`` what the solver left running.
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
