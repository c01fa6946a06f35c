"""The suite for anyone's solver, tested: our own passes, and every broken one fails where it should."""

from __future__ import annotations

from verification.case import Measured
from verification.contestants import own
from verification.contestants.broken import BROKEN
from verification.contestants.check import Fault
from verification.contestants.suite import run, suite
from verification.registry import case

SOURCE = "the suite of verification.contestants"


@case(
    "contestants/own-solver",
    title="Our own solver through the suite for contestants",
    claim="refimpl's production solver passes every case that other solvers are put to",
    source=SOURCE,
    metric="equal",
    tolerance=0.0,
    tolerance_reason="a number of cases",
    tags=("contestant",),
)
def own_solver() -> Measured:
    results = run(own.solve)
    left = [f"{r.id}: {r.status} {r.note}" for r in results if r.status != "pass"]
    data = {r.id: r.error for r in results}
    return Measured(len(left), 0.0, unit="cases", data=data, note="; ".join(left) or f"{len(results)} cases")


def _declare(fault: Fault) -> None:
    """The case that a fault is caught in every check that names it."""

    @case(
        "contestants/catches-" + "-".join(fault.replace("%", "percent").split()),
        title=f"A solver with a fault: {fault}",
        claim="It claims success, and fails in each case of the suite whose description names the fault",
        source=SOURCE,
        metric="equal",
        tolerance=0.0,
        tolerance_reason="a number of cases that name the fault and do not fail",
        tier="full",
        tags=("contestant", "self-test"),
    )
    def caught() -> Measured:
        naming = {check.id for check in suite() if fault in check.catches}
        if not naming:
            raise ValueError(f"no case of the suite names {fault!r}")
        results = run(BROKEN[fault]())
        missed = [r.id for r in results if r.id in naming and r.status != "fail"]
        others = [r.id for r in results if r.id not in naming and r.status in ("fail", "error")]
        data = {
            "fault": fault.value,
            "verdicts": {r.id: r.status for r in results},
            "named in": sorted(naming),
        }
        note = f"caught in {len(naming)} that name it and {len(others)} others; missed in {missed or 'none'}"
        return Measured(len(missed), 0.0, unit="cases", data=data, note=note)


for _fault in BROKEN:
    _declare(_fault)
