"""Solve a state and judge the solution: by the oracle, by a scaling law, or by a known answer."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from functools import partial, wraps
from typing import Any, ParamSpec

import mpmath as mp
import numpy as np

import refimpl as rf
from refimpl.planning.plan import Method
from verification.stress_tests.oracle import NotSettled, Oracle
from verification.stress_tests.state import Extreme, Judged, Verdict, number

TOLERANCE = 1e-10
"""Tolerance of every solve, a hundredth of the default: larger errors belong to the state."""
WRONG_FROM = 1e-6
"""Relative error of a number that counts as wrong although the certificate met `TOLERANCE`. The certificate's
gap bounds the square of the error in energy, so 1e-5 would be lawful; measured errors stay below 1e-7."""
M = 5
"""Elements a side of states that the oracle judges, unless an axis varies them."""
SOLVERS: tuple[Method, ...] = ("fft", "dense")
GOOD = (rf.Status.CONVERGED, rf.Status.CYCLED, rf.Status.NO_CONTACT)
P = ParamSpec("P")


def caught(judge: Callable[P, Judged]) -> Callable[P, Judged]:
    """Return the judge with a verdict on exceptions: a refusal is a detected failure, all else a crash."""

    @wraps(judge)
    def judged(*args: P.args, **kwargs: P.kwargs) -> Judged:
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                return judge(*args, **kwargs)
        # Exceptions of any kind are what the stress tests look for: here they are found, named and counted.
        except Exception as error:
            refused, unjudged = isinstance(error, rf.InputError), isinstance(error, NotSettled)
            # documented: the frozen problem has no solution, or no approach carries the load
            detected = refused or type(error) is ArithmeticError
            status = "InputError" if refused else "unjudged" if unjudged else type(error).__name__
            verdict, oracle = (Verdict.DETECTED, "refused") if detected else (Verdict.CRASH, "none")
            return Judged(verdict, status, None, WRONG_FROM, oracle, str(error).partition("\n")[0])

    return judged


def state(
    series: str, at: str, x: float, scene: rf.Scene, method: Method,
    elements: int = M, seconds: float = 20.0, **options: Any,
) -> Extreme:  # fmt: skip
    """A state that the oracle judges; the solver's name ends the name of its series.

    The plain reference's loops end by themselves within 12 s at the extremes.
    """
    run = partial(by_oracle, scene, elements, method, **options)
    return Extreme(f"{series}, {method}", at, x, run, seconds)


@caught
def by_oracle(scene: rf.Scene, elements: int, method: Method = "fft", **options: Any) -> Judged:
    """Pressure, approach and forces against the exact discrete state."""
    solution = rf.solve(scene, elements, method=method, tolerance=TOLERANCE, **options)
    try:
        error, note = exact_error(scene, solution, **options)
    except NotSettled:
        if solution.status in GOOD:
            raise
        error, note = np.inf, ""
    if solution.status not in GOOD and error > WRONG_FROM and "approach" not in options:
        note = sought(oracle_of(scene, elements, **options))
    return verdict(solution, error, "the exact discrete state, 34 digits", note)


def oracle_of(scene: rf.Scene, M: int, **options: Any) -> Oracle:
    """Return the oracle of a scene by the options of `refimpl.solve`."""
    return Oracle(
        scene, M,
        approach=options.get("approach"),
        oblique=options.get("oblique", True) is not False,
        slope_correction=options.get("slope_correction", False),
    )  # fmt: skip


def sought(oracle: Oracle) -> str:
    """Return whether continuation finds a state that no solver found, and that obeys the law everywhere."""
    try:
        oracle.continued()
    except NotSettled as unsettled:
        return f"continuation finds no state: {unsettled}"
    return "a state exists: found by continuation"


def verdict(
    solution: rf.Solution, error: float, oracle: str, note: str = "", limit: float = WRONG_FROM, **data: float
) -> Judged:
    """Return right or wrong where the status claims success, else a detected failure with its error."""
    status = solution.status.value
    if solution.status in GOOD:
        return number(error, limit, status, oracle, note, **data)
    return Judged(Verdict.DETECTED, status, error if np.isfinite(error) else None, limit, oracle, note, data)


def change(solution: rf.Solution, other: rf.Solution) -> float:
    """Largest relative change of pressures, to the other solution's peak, and of the approach."""
    pressures = float(np.abs(solution.pressure - other.pressure).max()) / other.max_pressure
    return max(pressures, abs(solution.approach / other.approach - 1))


def exact_error(scene: rf.Scene, solution: rf.Solution, **options: Any) -> tuple[float, str]:
    """Largest relative error of a solution's pressure, approach, N and F; and a note.

    Pressures relative to the peak, approaches to their size or, where that nearly vanishes, to the
    displacement that one element's peak pressure makes; forces to N. A contact set that differs by elements
    further than rounding from the edge of contact counts as an error of 1.
    """
    oracle = oracle_of(scene, len(solution.pressure), **options)
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
    """Judge no contact: right where the exact gap is nowhere below the approach."""
    if oracle.approach is None:
        return 1.0, "no contact under a load"
    overlap = oracle.approach - min(oracle.h)
    return (0.0, "apart") if overlap <= 0 else (1.0, f"no contact at an overlap of {float(overlap):.1e} m")
