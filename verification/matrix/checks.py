"""Checks tried against the faults: quick cases, and the invariants on fixed samples."""

from __future__ import annotations

import signal
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from types import CodeType, FrameType
from typing import Any

import refimpl as rf
from verification.framework.case import Case, Measured, Metric, Tier
from verification.framework.registry import load, select
from verification.properties import INVARIANTS
from verification.properties.registry import Solver
from verification.properties.samples import Sample

SECONDS = 4
"""CPU seconds; a check that a fault makes run longer, four times what is cheap, counts as an error."""

SAMPLES = (
    Sample(
        bumps=((3, 0, 7, 2, 0), (0, 9, 1, 0, 4), (5, 0, 0, 12, 0), (0, 2, 6, 0, 1), (8, 0, 3, 0, 0)),
        bowl=20, E=(5, 70), nu=(10, 40), pressure=40, tau=40, beta=20, angle=40,
    ),
    Sample(
        bumps=((0, 14, 0, 1), (2, 0, 0, 11), (0, 6, 3, 0), (13, 0, 5, 2)),
        bowl=5, E=(120, 30), nu=(-20, 30), pressure=15, tau=30, beta=30, angle=200,
    ),
    Sample(
        bumps=((0, 9, 2, 5), (7, 1, 0, 3), (4, 0, 8, 1), (1, 6, 3, 0)),
        E=(4, 90), nu=(20, 35), pressure=6, tau=20, beta=25, angle=70, periodic=True,
    ),
)  # fmt: skip


def _unrubbed(sample: Sample) -> Sample:
    return replace(sample, tau=0, beta=0, periodic=False)


def _without_tau(sample: Sample) -> Sample:
    return replace(sample, tau=0)


FITTED: dict[str, Callable[[Sample], Sample]] = {
    "periodic_translation": lambda sample: replace(sample, periodic=True),
    "displacements": lambda sample: replace(sample, periodic=False),
    "skew_coupling": lambda sample: replace(sample, tau=0, periodic=False),
    "positive_energy": _without_tau,
    "load_and_approach": _without_tau,
    "reciprocity": _unrubbed,
    "energy_is_work": _unrubbed,
    "monotone_in_load": _unrubbed,
    "monotone_in_approach": _unrubbed,
}
"""What an invariant asks of its samples."""

METHODS: dict[str, Solver] = {
    method: partial(rf.solve, method=method, tolerance=1e-12) for method in ("fft", "dense")
}
PRODUCTION = tuple(str(Path(__file__).parents[2] / package) for package in ("refimpl", "appendix_a"))


@dataclass(frozen=True)
class Ended:
    """Verdict and CPU seconds of one run."""

    status: str
    seconds: float


def all_checks() -> list[Case]:
    """Every quick case, in the registry's order, and every invariant as a case."""
    return [*select(load(), Tier.QUICK), *map(_as_case, INVARIANTS)]


def family(check: Case) -> str:
    """Group of checks that share cached results: a module's cases; each invariant stands alone."""
    return check.id if check.id.startswith("invariant/") else check.module


def run(check: Case) -> Ended:
    """The check's verdict; `SECONDS` of CPU time at most."""
    start = time.process_time()
    with _at_most(SECONDS):
        status = check.run().status
    return Ended(status, time.process_time() - start)


def traced(check: Case) -> set[CodeType]:
    """The functions of `refimpl` and `appendix_a` that the check calls."""
    called: set[CodeType] = set()

    def watch(frame: FrameType, event: str, argument: Any) -> None:
        if event == "call":
            called.add(frame.f_code)

    sys.setprofile(watch)
    try:
        check.run()
    finally:
        sys.setprofile(None)
    return {code for code in called if code.co_filename.startswith(PRODUCTION)}


def _as_case(name: str) -> Case:
    def function() -> Measured:
        for sample in SAMPLES:
            for solver in METHODS.values():
                INVARIANTS[name].check(solver, FITTED[name](sample) if name in FITTED else sample)
        return Measured(value=0.0, reference=0.0)

    return Case(
        id=f"invariant/{name}",
        title=name,
        claim=INVARIANTS[name].claim,
        source="verification/properties",
        metric=Metric.EQUAL,
        tolerance=0.0,
        tolerance_reason="an invariant holds or raises",
        function=function,
    )


@contextmanager
def _at_most(seconds: int) -> Iterator[None]:
    """Raise TimeoutError in this process after so many seconds of its CPU time."""

    def late(number: int, frame: FrameType | None) -> None:
        raise TimeoutError(f"still running after {seconds} s")

    before: Callable[..., Any] | int | None = signal.signal(signal.SIGPROF, late)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)
