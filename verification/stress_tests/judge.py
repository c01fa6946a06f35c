"""Solve a state and judge the solution: by the oracle, by a scaling law, or by a known answer."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from functools import partial
from typing import Any, TypeVar

import mpmath as mp
import numpy as np

import refimpl as rf
from appendix_a.errors import InputError
from refimpl.planning.plan import Method
from verification.exact import lawful_states
from verification.stress_tests.oracle import EXACT, NotSettled, Oracle
from verification.stress_tests.state import EXISTS, NO_STATE, NOT_FOUND, Extreme, Judged, Verdict, number

TOLERANCE = 1e-10
"""Tolerance of every solve, a hundredth of the default: larger errors belong to the state."""
WRONG_FROM = 1e-6
"""Relative error of a number that counts as wrong although the certificate met `TOLERANCE`. The certificate's
gap bounds the square of the error in energy, so 1e-5 would be lawful; measured errors stay below 1e-7."""
M = 5
"""Elements a side of states that the oracle judges, unless an axis varies them."""
SOLVERS: tuple[Method, ...] = ("fft", "dense")
GOOD = (rf.Status.CONVERGED, rf.Status.CYCLED, rf.Status.NO_CONTACT)
DOCUMENTED = (rf.InputError, rf.NotConverged, InputError)
"""Exceptions by which the code under test says that it refuses, or finds no solution."""
T = TypeVar("T")


class Failed(Exception):
    """Exception of the code under test, which is its cause; those of judges come as they are."""


def tested(run: Callable[..., T], *args: Any, **kwargs: Any) -> T:
    """Return what the code under test returns; raises Failed where it raises."""
    try:
        return run(*args, **kwargs)
    # Exceptions of any kind are what the stress tests look for: `judged` names and counts them.
    except Exception as error:
        raise Failed from error


def judged(judge: Callable[[], Judged]) -> Judged:
    """Return a judge's verdict, or one on the exception of what it tests, or of its own."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return judge()
    except Failed as failed:
        error = failed.__cause__
        verdict = Verdict.DETECTED if isinstance(error, DOCUMENTED) else Verdict.CRASH
    except Exception as own:
        error, verdict = own, Verdict.UNJUDGED
    return Judged(verdict, type(error).__name__, None, WRONG_FROM, "none", str(error).partition("\n")[0])


def state(
    series: str, at: str, x: float, scene: rf.Scene, method: Method,
    elements: int = M, seconds: float = 20.0, **options: Any,
) -> Extreme:  # fmt: skip
    """Return a state that the oracle judges; the solver's name ends the name of its series.

    The plain reference's loops end by themselves within 12 s at the extremes.
    """
    run = partial(by_oracle, scene, elements, method, **options)
    return Extreme(f"{series}, {method}", at, x, run, seconds)


def by_oracle(scene: rf.Scene, elements: int, method: Method = "fft", **options: Any) -> Judged:
    """Judge pressure, approach and forces against the exact discrete state."""
    solution = tested(rf.solve, scene, elements, method=method, tolerance=TOLERANCE, **options)
    try:
        error, note = exact_error(scene, solution, **options)
    except NotSettled:
        if solution.status in GOOD:
            raise
        error, note = np.inf, ""
    if solution.status not in GOOD:
        note = sought(scene, elements, **options)
    return verdict(solution, error, EXACT, note)


def sought(scene: rf.Scene, M: int, **options: Any) -> str:
    """Return whether there is a state that no solver found, and that obeys the law everywhere."""
    try:
        Oracle(scene, M, **options).continued()
    except NotSettled as unsettled:
        if options.get("oblique", True):
            return f"{NOT_FOUND}: {unsettled}"
        half_space = options == {"oblique": False} and not scene.periodic
        proved = half_space and lawful_states.none_is_lawful(scene, M)
        return NO_STATE if proved else f"not decided: {unsettled}"
    return EXISTS


def verdict(
    solution: rf.Solution, error: float, oracle: str, note: str = "", limit: float = WRONG_FROM, **data: float
) -> Judged:
    """Return right or wrong of a claimed success, else a detected failure with its error; tau's share."""
    status = solution.status.value
    if solution.status in GOOD:
        return number(error, limit, status, oracle, note, **data)
    excluded = solution.details.excluded & solution.contact
    data["without tau"] = float(excluded.sum() / max(1, solution.contact.sum()))
    return Judged(Verdict.DETECTED, status, error if np.isfinite(error) else None, limit, oracle, note, data)


def change(solution: rf.Solution, other: rf.Solution) -> float:
    """Return the largest relative change of pressures, to the other solution's peak, and of the approach."""
    pressures = float(np.abs(solution.pressure - other.pressure).max()) / other.max_pressure
    return max(pressures, abs(solution.approach / other.approach - 1))


def exact_error(scene: rf.Scene, solution: rf.Solution, **options: Any) -> tuple[float, str]:
    """Return the largest relative error of a solution's pressure, approach, N and F; and a note.

    Pressures relative to the peak, approaches to their size or what one element's peak displaces, forces to
    N. Elements in contact on one side alone, further than rounding from its edge, count as an error of 1.
    """
    oracle = Oracle(scene, len(solution.pressure), **options)
    if not solution.contact.any():
        return _untouched(oracle, solution)
    tau = scene.friction.tau
    support = solution.traction > scene.friction.beta * solution.pressure if tau else solution.contact
    exact = oracle.solve(solution.pressure, support, (solution.slopes.tan_x, solution.slopes.tan_y))
    peak = max(exact.pressure)
    pressures = np.array([mp.mpf(float(f)) for f in solution.pressure.ravel()], dtype=object)
    compliance = sum(oracle.a) * peak * oracle.spacing
    approach = exact.approach - (sum(oracle.h) / len(oracle.h) if scene.periodic else 0)
    errors = {
        "pressure": max(abs(pressures - exact.pressure)) / peak,
        "approach": abs(solution.approach - approach) / max(abs(approach), compliance),
        "N": abs(mp.mpf(solution.normal_force) / exact.normal - 1),
        "F": abs(mp.mpf(solution.friction_force) - exact.friction)
        / (abs(exact.friction) + abs(exact.normal)),
    }
    worst = max(errors, key=lambda name: errors[name])
    strays = int(np.count_nonzero(exact.contact != solution.contact.ravel()))
    note = f"worst in {worst}"
    if strays:
        note += f"; {strays} elements differ in contact, margin {exact.margin:.1e}"
        if exact.margin > WRONG_FROM:
            return 1.0, note
    return float(errors[worst]), note


def _untouched(oracle: Oracle, solution: rf.Solution) -> tuple[float, str]:
    if oracle.approach is None:
        return 1.0, "no contact under a load"
    overlap = oracle.approach - min(oracle.h)
    return (0.0, "apart") if overlap <= 0 else (1.0, f"no contact at an overlap of {float(overlap):.1e} m")
