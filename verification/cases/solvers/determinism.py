"""Determinism: fresh processes and repeated runs agree to the last bit; numbers of threads within a bound."""

from __future__ import annotations

import math

import numpy as np

from refimpl.planning.plan import Method
from verification.cases import Measured, case
from verification.stress_tests.determinism import difference, in_a_process, solved

SETTINGS: tuple[tuple[Method, bool], ...] = (("fft", False), ("fft", True), ("dense", False))
SOURCE = "pressures and numbers compared in hexadecimal"


@case("extremes/determinism-processes", metric="equal", tolerance=0.0, tier="full", source=SOURCE)
def processes() -> Measured:
    """Two fresh processes with as many threads.

    Claim: the same scene gives the same bits in every process, with one thread and with two
    Tolerance: equal bits
    """
    found = {
        f"{method}, periodic {periodic}, {threads} threads": difference(
            *(in_a_process(method, periodic, transforms=threads, blas=threads) for _ in range(2))
        )
        for method, periodic in SETTINGS
        for threads in (1, 2)
    }
    return Measured(value=max(found.values()), reference=0.0, data={"difference": found})


@case("extremes/determinism-threads", metric="at_most", tolerance=1e-12, tier="full", source=SOURCE)
def threads() -> Measured:
    """One thread against two.

    Claim: two threads of BLAS change no bit; two of ducc0's transforms round differently, and change the
    pressures of these scenes by less than 1e-12 of the peak
    Tolerance: a transform by two threads differs by up to 6e-16, CG amplifies that: 4e-14 measured. Where
    rounding decides which iteration is the last, the solver's tolerance is the bound: 8e-9 of table1-smooth
    on 512 x 512
    """
    blas, both = {}, {}
    for method, periodic in SETTINGS:
        name = f"{method}, periodic {periodic}"
        one = in_a_process(method, periodic, transforms=1, blas=1)
        blas[name] = difference(one, in_a_process(method, periodic, transforms=1, blas=2))
        both[name] = difference(one, in_a_process(method, periodic, transforms=2, blas=2))
    value = math.inf if any(blas.values()) else max(both.values())
    return Measured(value, data={"BLAS alone": blas, "BLAS and transforms": both})


@case("extremes/determinism-repeated", metric="equal", tolerance=0.0, source=SOURCE)
def repeated() -> Measured:
    """Twice in one process.

    Claim: a second solve of the same scene gives the same bits: nothing is remembered that matters
    Tolerance: equal bits
    """
    first, second = (solved("dense", False) for _ in range(2))
    apart = float(np.abs(first.pressure - second.pressure).max())
    return Measured(value=apart, reference=0.0)
