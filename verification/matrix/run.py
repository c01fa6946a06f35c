"""Runs the checks with each fault, in a process of its own each time, and forms the matrix's document."""

from __future__ import annotations

import multiprocessing
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from fnmatch import fnmatchcase
from functools import cached_property, partial
from multiprocessing.connection import Connection
from types import CodeType
from typing import Any, TypeVar

from verification.exact.manufactured import manufacture
from verification.framework.case import Case, Status
from verification.framework.files import Progress
from verification.framework.provenance import provenance
from verification.matrix.appendix_faults import IN_APPENDIX
from verification.matrix.checks import Ended, all_checks, family, run, traced
from verification.matrix.faults import FAULTS, Fault, Patch
from verification.matrix.local_faults import IN_REFIMPL
from verification.matrix.patches import fault as fault_of

T = TypeVar("T")
FORMAT = "rough-friction fault matrix, version 1"
CHEAP = 1.0
"""CPU seconds that a check may take, if nobody says otherwise, to be tried against every fault."""


@dataclass(frozen=True)
class Matrix:
    """Verdicts per fault and check, of the checks that pass without a fault in `CHEAP` seconds."""

    checks: Mapping[str, Case]
    sound: Mapping[str, Ended]
    excluded: Mapping[str, str]
    faults: Mapping[str, Fault]
    verdicts: Mapping[str, Mapping[str, str]]

    @cached_property
    def caught_by(self) -> dict[str, list[str]]:
        """The checks that do not pass, by fault."""
        return {
            fault: [check for check, status in row.items() if status != Status.PASS]
            for fault, row in self.verdicts.items()
        }

    def document(self) -> dict[str, Any]:
        """The matrix, for JSON."""
        catches: dict[str, list[str]] = {check: [] for check in self.sound}
        for fault, seen in self.caught_by.items():
            for check in seen:
                catches[check].append(fault)
        return {
            "format": FORMAT,
            "faults": [
                {
                    "name": name,
                    "what": fault.what,
                    "kind": "seeded" if name in FAULTS else "local",
                    "tried": len(self.verdicts[name]),
                    "broke": sum(status == Status.ERROR for status in self.verdicts[name].values()),
                    "caught_by": self.caught_by[name],
                }
                for name, fault in self.faults.items()
            ],
            "checks": [
                {
                    "id": id,
                    "claim": self.checks[id].claim,
                    "seconds": round(ended.seconds, 3),
                    "catches": catches[id],
                    "alone": [f for f in catches[id] if self.caught_by[f] == [id]],
                    "among_few": [f for f in catches[id] if 1 < len(self.caught_by[f]) <= 3],
                }
                for id, ended in self.sound.items()
            ],
            "excluded": dict(self.excluded),
            "provenance": provenance(),
        }


def measure(
    cheap: float = CHEAP,
    known: Mapping[str, float] | None = None,
    skip: Iterable[str] = (),
    only: Iterable[str] = ("*",),
    against: Iterable[str] = ("*",),
) -> Iterator[Matrix]:
    """Try every cheap check, if any, against every fault that it could see; yields the matrix after each.

    ``known`` holds seconds of an earlier run: what took longer than ``cheap`` then is not even timed.
    ``skip`` are globs of checks to exclude, ``only`` of those to take, ``against`` of the faults.
    """
    checks = {check.id: check for check in all_checks() if _any(check.id, only)}
    for arguments in ((False, False), (True, False), (True, True)):
        manufacture(8, 1, 0.7, *arguments)  # made once, from sums that share nothing with what is judged
    local = {**IN_REFIMPL, **IN_APPENDIX}
    faults = {**FAULTS, **{name: fault_of(described) for name, described in local.items()}}
    faults = {name: fault for name, fault in faults.items() if _any(name, against)}
    progress = Progress(len(faults) + 2)
    excluded = {id: "excluded on request" for id in checks if _any(id, skip)}
    slow = {id: t for id, t in (known or {}).items() if id in checks and t > cheap}
    excluded |= {id: f"takes {t:.1f} s" for id, t in slow.items()}
    sound = _cheap(checks, cheap, excluded)
    if not sound:
        return
    progress.tick("without a fault")
    reach = _forked(lambda: {id: {_key(code) for code in traced(checks[id])} for id in sound})
    progress.tick("traced")
    verdicts: dict[str, dict[str, str]] = {}
    for name, fault in faults.items():
        seeing = _seeing(fault, checks, reach)
        chosen = [id for id in sound if id in seeing]
        verdicts[name] = {id: ended.status for id, ended in _tried(fault, chosen, checks).items()}
        progress.tick(name)
        yield Matrix(checks, sound, excluded, {n: faults[n] for n in verdicts}, verdicts)
    progress.close()


def _any(name: str, globs: Iterable[str]) -> bool:
    return any(fnmatchcase(name, glob) for glob in globs)


def _cheap(checks: Mapping[str, Case], cheap: float, excluded: dict[str, str]) -> dict[str, Ended]:
    """The checks that pass cheaply; adds to ``excluded`` why the others do not count.

    Twice: what a dear check leaves in a cache, the next one of its module has to pay for.
    """
    ended: dict[str, Ended] = {}
    for _ in range(2):
        left = [id for id in checks if id not in excluded]
        ended = _forked(partial(_run_all, left, checks))
        for id, found in ended.items():
            if found.seconds > cheap:
                excluded[id] = f"takes {found.seconds:.1f} s or more"
            elif found.status != Status.PASS:
                excluded[id] = f"{found.status} without a fault"
    return {id: found for id, found in ended.items() if id not in excluded}


def _run_all(ids: Iterable[str], checks: Mapping[str, Case]) -> dict[str, Ended]:
    return {id: run(checks[id]) for id in ids}


def _tried(fault: Fault, ids: Iterable[str], checks: Mapping[str, Case]) -> dict[str, Ended]:
    def work() -> dict[str, Ended]:
        with fault.injected():
            return _run_all(ids, checks)

    return _forked(work)


def _seeing(fault: Fault, checks: Mapping[str, Case], reach: Mapping[str, set[str]]) -> set[str]:
    """The checks of every family in which one calls a function that the fault replaces.

    A fault in a constant could be seen by any.
    """
    codes = [_code(patch) for patch in fault.patches]
    if any(code is None for code in codes):
        return set(reach)
    keys = {_key(code) for code in codes if code is not None}
    families = {family(checks[id]) for id, called in reach.items() if called & keys}
    return {id for id in reach if family(checks[id]) in families}


def _code(patch: Patch) -> CodeType | None:
    """The code that a patch replaces; None for data."""
    owner, name, _ = patch
    right = vars(owner)[name]
    for inside in ("fget", "func", "__wrapped__"):
        right = getattr(right, inside, right)
    code: CodeType | None = getattr(right, "__code__", None)
    return code


def _key(code: CodeType) -> str:
    return f"{code.co_filename}:{code.co_firstlineno}:{code.co_name}"


def _forked(work: Callable[[], T]) -> T:
    """What ``work`` returns in a copy of this process, so that nothing it caches or breaks stays."""
    context = multiprocessing.get_context("fork")
    ours, theirs = context.Pipe(duplex=False)
    child = context.Process(target=_report, args=(theirs, work))
    child.start()
    theirs.close()
    try:
        found: T = ours.recv()
    finally:
        child.join()
    return found


def _report(connection: Connection, work: Callable[[], Any]) -> None:
    connection.send(work())
    connection.close()
