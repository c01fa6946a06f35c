"""The whole suite, and its run with one solver under test."""

from __future__ import annotations

import hashlib
import importlib
import pkgutil
from collections.abc import Iterable
from fnmatch import fnmatchcase
from functools import cache

from verification.framework.case import Result
from verification.solver_suite import checks
from verification.solver_suite.check import Check
from verification.solver_suite.protocol import SolverUnderTest

VERSION = "1.3"
"""Version of the suite, in every result and in CITATION.cff: raised when a case is added, removed or judged
otherwise. `identity` has a digest that shows when it should be."""


@cache
def suite() -> tuple[Check, ...]:
    """Return every check of every module in `verification.solver_suite.checks`, in the modules' order."""
    names = [m.name for m in pkgutil.iter_modules(checks.__path__, prefix=f"{checks.__name__}.")]
    return tuple(check for name in names for check in importlib.import_module(name).CHECKS)


def thorough() -> tuple[Check, ...]:
    """Return the suite, with the problems of further covering arrays."""
    from verification.solver_suite.checks.covering import further

    return (*suite(), *further())


def identity() -> dict[str, str | int]:
    """Return the suite's version, number of cases, and a digest of their claims, tolerances and metrics.

    The claims of covering designs name the levels of their rows. The digest has those of `thorough` too.
    """
    cases = sorted((c.id, c.claim, c.metric.value, repr(float(c.tolerance))) for c in thorough())
    digest = hashlib.sha256(repr(cases).encode()).hexdigest()[:12]
    return {"version": VERSION, "cases": len(suite()), "digest": digest}


def select(globs: Iterable[str] = (), among: tuple[Check, ...] | None = None) -> tuple[Check, ...]:
    """Return the checks whose id (``solver/...``) matches a glob; all without any. ``!glob`` takes away.

    ``among`` takes the place of the suite. Raises LookupError for a glob that matches none, and where all
    are taken away: an empty selection must not look like success.
    """
    patterns, checks_ = tuple(globs), suite() if among is None else among
    idle = [p for p in patterns if not any(fnmatchcase(c.id, p.removeprefix("!")) for c in checks_)]
    if idle:
        raise LookupError(f"no case of the suite matches {', '.join(idle)}")
    out = [p[1:] for p in patterns if p.startswith("!")]
    into = [p for p in patterns if not p.startswith("!")] or ["*"]
    chosen = (c for c in checks_ if any(fnmatchcase(c.id, p) for p in into))
    found = tuple(c for c in chosen if not any(fnmatchcase(c.id, p) for p in out))
    if not found:
        raise LookupError(f"{', '.join(patterns)} leave no case of the suite")
    return found


def run(solver: SolverUnderTest, globs: Iterable[str] = ()) -> list[Result]:
    """Return a solver's results, from this process; a case beyond its abilities is `unavailable`."""
    return [check.case(solver).run() for check in select(globs)]


if __name__ == "__main__":
    print("\n".join(f"{name}: {value}" for name, value in identity().items()))
