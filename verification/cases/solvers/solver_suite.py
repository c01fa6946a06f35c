"""The suite for anyone's solver, tested: our own passes, and every faulty one fails where it should."""

from __future__ import annotations

import re
from functools import cache

from verification.cases import Measured, case, family
from verification.solver_suite import own
from verification.solver_suite.check import Fault
from verification.solver_suite.faulty_solvers.table import FAULTY
from verification.solver_suite.suite import run, suite

SOURCE = "the suite of verification.solver_suite"


NAMED = tuple(check.id for check in suite() if not check.slug.startswith("design-"))
"""Cases that name faults; those of the covering designs name none."""


@cache
def verdicts(fault: Fault) -> dict[str, str]:
    """Return the status of every case of the suite, by slug, for the solver with a fault."""
    return {r.id.partition("/")[2]: r.status for r in run(FAULTY[fault](), NAMED)}


DESIGNS = tuple(c.id for c in suite() if re.search(r"/design-(large|(?!tiny).*[1-9]$)", c.id))
"""Covering designs but for tiny problems and every tenth of the others: nine tenths of the suite's time."""


@family(
    "cases, tier",
    {
        "solver_suite/own-solver": (tuple(c.id for c in suite() if c.id not in DESIGNS), "quick"),
        "solver_suite/own-solver-designs": (DESIGNS, "full"),
    },
    metric="equal", tolerance=0.0, source=SOURCE,
)  # fmt: skip
def own_solver(cases: tuple[str, ...]) -> Measured:
    """The project's own solver through the suite for other solvers.

    Claim: refimpl's production solver passes every case that other solvers are put to, in two parts
    Tolerance: a number of cases
    """
    results = run(own.solve, cases)
    left = [f"{r.id}: {r.status} {r.note}" for r in results if r.status != "pass"]
    return Measured(len(left), 0.0, unit="cases", note="; ".join(left) or f"{len(results)} cases")


@family(
    "fault",
    {"solver_suite/catches-" + "-".join(fault.replace("%", "percent").split()): (fault,) for fault in FAULTY},
    metric="equal", tolerance=0.0, tier="full", source=SOURCE,
)  # fmt: skip
def caught(fault: Fault) -> Measured:
    """A solver with a fault: {fault}.

    Claim: It claims success, and fails in each case of the suite whose description names the fault
    Tolerance: a number of cases that name the fault and do not fail
    """
    naming = [check.slug for check in suite() if fault in check.catches]
    if not naming:
        raise ValueError(f"no case of the suite names {fault!r}")
    found = verdicts(fault)
    missed = [slug for slug in naming if found[slug] != "fail"]
    others = [slug for slug in found if slug not in naming and found[slug] in ("fail", "error")]
    note = f"caught in {len(naming)} that name it and in {len(others)} others; missed in {missed or 'none'}"
    return Measured(len(missed), 0.0, unit="cases", note=note)


@case("solver_suite/each-case-earns-its-place", metric="equal", tolerance=0.0, tier="full", source=SOURCE)
def each_case_earns_its_place() -> Measured:
    """Cases of the suite against faulty solvers.

    Claim: Every case of the suite fails at least one of the faulty solvers
    Tolerance: a number of cases that fail none
    """
    found = {fault: verdicts(fault) for fault in FAULTY}
    named = [c for c in suite() if c.id in NAMED]
    idle = [c.slug for c in named if not any(found[fault][c.slug] == "fail" for fault in found)]
    return Measured(len(idle), 0.0, unit="cases", note=f"idle: {', '.join(idle) or 'none'}")
