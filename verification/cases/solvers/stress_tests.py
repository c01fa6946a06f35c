"""Extremes: every axis of the study as a case, a sample of all axes for the quick tier, their foundations."""

from __future__ import annotations

from itertools import islice

import numpy as np

import refimpl as rf
from refimpl.planning.plan import Method
from verification.cases import Measured, case, family
from verification.exact import lawful_states, positive_definite
from verification.stress_tests import conditioning
from verification.stress_tests.axes import AXES, states
from verification.stress_tests.judge import judged
from verification.stress_tests.study import Row, counts, run, run_state, unexplained

CLAIM = "at the extremes a result is right, or its failure is of a listed kind: none is wrong or crashes"
SOURCE = "exact discrete states in 34 digits, scaling laws, closed forms; see verification.stress_tests"
EVERY = 60
COSTLY = ("grid", "finite elements", "wedge")


def counted(rows: list[Row]) -> Measured:
    """Return the number of states that are neither right nor of a listed kind; their ids are its data."""
    numbers = counts(rows)
    numbers.pop("wrong")
    broken = unexplained(rows)
    data, note = {"unexplained": broken}, f"{len(rows)} states: {numbers}"
    return Measured(value=float(len(broken)), data=data, note=note)


@family(
    "axis",
    {f"extremes/{axis.replace(' ', '-')}": (axis,) for axis in AXES},
    metric="at_most", tolerance=0.0, tier="full", claim=CLAIM, source=SOURCE, tolerance_reason="a count",
)  # fmt: skip
def all_states(axis: str) -> Measured:
    """Extremes of the axis {axis!r}."""
    return counted(run([axis]))


@case("extremes/sample", metric="at_most", tolerance=0.0, claim=CLAIM, source=SOURCE)
def sample() -> Measured:
    """A sample of all cheap extremes.

    Tolerance: a count
    """
    cheap = [name for name in AXES if name not in COSTLY]
    return counted([run_state(*state) for name in cheap for state in islice(states(name), 7, None, EVERY)])


@case("extremes/unit-scaling", metric="at_most", tolerance=0.0)
def powers_of_two() -> Measured:
    """Powers of two in length, modulus and load change no bit.

    Claim: a scene scaled by powers of two from 1e-12 to 1e12 gives the same mantissas
    Source: similarity of Eqs (1)-(7)
    Tolerance: exact: every operation of the solvers commutes with powers of two, short of underflow
    """
    chosen = [(unique, s) for unique, s in states("units") if "twos" in s.series][::6]
    errors = {unique: judged(s.run).error for unique, s in chosen}
    return Measured(value=max(np.inf if e is None else e for e in errors.values()), data={"error": errors})


@case("extremes/positive-definite", metric="at_most", tolerance=1e-9)
def definite() -> Measured:
    """a + beta c is positive definite for any beta.

    Claim: the symmetric part's least eigenvalue does not depend on beta and exceeds the symbol's least
    Source: proof in verification.exact.positive_definite
    Tolerance: beta c of size 1e6 is skew to its own rounding, 1e6 x 1e-16; ten times that
    """
    bound = positive_definite.least_symbol()
    least = {
        M: [float(positive_definite.symmetric_part(M, b, 0.3)[0]) for b in (0.0, 1.0, 1e3, 1e6)]
        for M in (2, 4, 6)
    }
    spread = max(abs(v / values[0] - 1) for values in least.values() for v in values)
    above = min(values[0] - bound for values in least.values())
    return Measured(value=spread if above > 0 else np.inf, data={"least by M": least, "symbol": bound})


@case("extremes/lawful-states", metric="at_most", tolerance=0.0, tier="full")
def lawful() -> Measured:
    """Lawful states counted by trying every contact set.

    Claim: every CONVERGED contact set is lawful; without tau there is exactly one, with tau none or several
    Source: brute force over the 511 contact sets of 3 x 3 elements
    Tolerance: a count
    """
    found = [lawful_states.count(tau) for tau in lawful_states.TAUS]
    broken = sum(c.wrong for c in found) + (found[0].one != lawful_states.SCENES)
    return Measured(value=float(broken), data={"counts": [c._asdict() for c in found]})


@case("extremes/condition-numbers", metric="relative", tolerance=0.01, tier="full")
def condition() -> Measured:
    """Condition number of the dense flexibility.

    Claim: it grows like the grid, 1.66 M: largest eigenvalue, 3.03 M, over the symbol's least value
    Source: dense eigenvalues; symbol of positive_definite
    Tolerance: the least eigenvalue approaches the symbol's minimum like 1/M^2: 0.2 % at 40
    """
    columns = conditioning.table()
    reference = columns["largest"][-1] / positive_definite.least_symbol()
    return Measured(value=columns["condition"][-1], reference=reference, data=columns)


@case("extremes/beyond-rounding", metric="equal", tolerance=0.0)
def beyond_rounding() -> Measured:
    """A tolerance below rounding is not met, and no solver reports success.

    Claim: with the tolerance 1e-18 every method returns another status than CONVERGED
    Source: double precision: eps = 2.2e-16
    Tolerance: a count
    """
    # without symmetry: of sixteen elements that are four, residuals may be zero by luck
    scene, beyond = rf.read_scene("table1-rough"), 1e-18
    methods: tuple[Method, ...] = ("fft", "dense", "paper")
    found = {method: rf.solve(scene, 16, method=method, tolerance=beyond) for method in methods}
    claimed = sum(solution.status is rf.Status.CONVERGED for solution in found.values())
    return Measured(float(claimed), 0.0, data={"status": {m: s.status.value for m, s in found.items()}})
