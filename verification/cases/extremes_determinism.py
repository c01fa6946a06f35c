"""Determinism: fresh processes and repeated runs agree to the last bit; numbers of threads within a bound."""

from __future__ import annotations

import numpy as np

from refimpl.plan import Method
from verification.case import Measured
from verification.extremes.determinism import difference, in_a_process, solved
from verification.registry import case

SETTINGS: tuple[tuple[Method, bool], ...] = (("fft", False), ("fft", True), ("dense", False))
SOURCE = "pressures and numbers compared in hexadecimal"


@case(
    "extremes/determinism-processes",
    title="Two fresh processes with as many threads",
    claim="the same scene gives the same bits in every process, with one thread and with two",
    source=SOURCE,
    metric="equal",
    tolerance=0.0,
    tolerance_reason="equal bits",
    tier="full",
    tags=("extremes", "determinism"),
)
def processes() -> Measured:
    found = {
        f"{method}, periodic {periodic}, {threads} threads": difference(
            in_a_process(method, periodic, threads), in_a_process(method, periodic, threads)
        )
        for method, periodic in SETTINGS
        for threads in (1, 2)
    }
    return Measured(value=max(found.values()), reference=0.0, data={"difference": found})


@case(
    "extremes/determinism-threads",
    title="One thread against two",
    claim="threads of BLAS change the order of its sums and nothing else: within 1e-12",
    source=SOURCE,
    metric="at_most",
    tolerance=1e-12,
    tolerance_reason="scalar products of 65536 numbers round by 1e-15, CG amplifies that; measured 3e-14",
    tier="full",
    tags=("extremes", "determinism"),
)
def threads() -> Measured:
    found = {
        f"{method}, periodic {periodic}": difference(
            in_a_process(method, periodic, 1), in_a_process(method, periodic, 2)
        )
        for method, periodic in SETTINGS
    }
    return Measured(value=max(found.values()), data={"difference": found})


@case(
    "extremes/determinism-repeated",
    title="Twice in one process",
    claim="a second solve of the same scene gives the same bits: nothing is remembered that matters",
    source=SOURCE,
    metric="equal",
    tolerance=0.0,
    tolerance_reason="equal bits",
    tags=("extremes", "determinism"),
)
def repeated() -> Measured:
    first, second = (solved("dense", False) for _ in range(2))
    apart = float(np.abs(first.pressure - second.pressure).max())
    return Measured(value=apart, reference=0.0)
