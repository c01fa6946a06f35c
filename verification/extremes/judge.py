"""Solve a state and judge what came back: by the oracle, by a scaling law, or by a known answer."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from typing import Any

import mpmath as mp
import numpy as np

import refimpl as rf
from refimpl.planning.plan import Method
from verification.extremes.oracle import NotSettled, Oracle
from verification.extremes.state import Judged, Verdict, number

TOLERANCE = 1e-10
"""Asked of every solve, hundred times below the default: what a state loses beyond that is its own."""
WRONG_FROM = 1e-6
"""Relative error of a number that counts as wrong although the certificate met `TOLERANCE`. The certificate's
gap bounds the square of the error in energy, so 1e-5 would be lawful; measured errors stay below 1e-7."""
SOLVERS: tuple[Method, ...] = ("fft", "dense")
GOOD = (rf.Status.CONVERGED, rf.Status.CYCLED, rf.Status.NO_CONTACT)


def guarded(run: Callable[[], Judged]) -> Judged:
    """The run's verdict; a refusal is an honest failure, an exception nobody foresaw is a crash."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return run()
    except rf.InputError as refused:
        return Judged(Verdict.HONEST, "InputError", None, WRONG_FROM, "refused", str(refused))
    except NotSettled as unsettled:
        return Judged(Verdict.CRASH, "unjudged", None, WRONG_FROM, "none", str(unsettled))
    except ArithmeticError as hopeless:
        if type(hopeless) is not ArithmeticError:  # a division by zero was not foreseen
            return Judged(Verdict.CRASH, type(hopeless).__name__, None, WRONG_FROM, "none", str(hopeless))
        # documented: the frozen problem has no solution, or no approach carries the load
        return Judged(Verdict.HONEST, "ArithmeticError", None, WRONG_FROM, "refused", str(hopeless))
    # A study of extremes is after exceptions of any kind: this is where they are found, named and counted.
    except Exception as broken:
        return Judged(
            Verdict.CRASH, type(broken).__name__, None, WRONG_FROM, "none", str(broken).splitlines()[0]
        )


def by_oracle(scene: rf.Scene, M: int, method: Method = "fft", **options: Any) -> Judged:
    """Pressure, approach and forces against the exact discrete state."""

    def run() -> Judged:
        solution = rf.solve(scene, M, method=method, tolerance=TOLERANCE, **options)
        try:
            error, note = exact_error(scene, solution, **options)
        except NotSettled as unsettled:
            if solution.status in GOOD:
                raise
            error, note = np.inf, f"the oracle found no state either: {unsettled}"
        return verdict(solution, error, "the exact discrete state, 34 digits", note)

    return guarded(run)


def verdict(
    solution: rf.Solution, error: float, oracle: str, note: str = "", limit: float = WRONG_FROM, **data: float
) -> Judged:
    """Right or wrong where the status claims success, else an honest failure with its error beside it."""
    status = solution.status.value
    if solution.status in GOOD:
        return number(error, limit, status, oracle, note, **data)
    return Judged(Verdict.HONEST, status, error if np.isfinite(error) else None, limit, oracle, note, data)


def exact_error(scene: rf.Scene, solution: rf.Solution, **options: Any) -> tuple[float, str]:
    """Largest relative error of a solution's pressure, approach, N and F; and a note.

    Pressures relative to the peak, approaches to their size or, where that nearly vanishes, to the
    displacement that one element's peak pressure makes; forces to N. A contact set that differs by elements
    further than rounding from the edge of contact counts as an error of 1.
    """
    M = len(solution.pressure)
    oracle = Oracle(
        scene, M,
        approach=options.get("approach"),
        oblique=options.get("oblique", True) is not False,
        slope_correction=options.get("slope_correction", False),
    )  # fmt: skip
    if not solution.contact.any():
        return _untouched(oracle, solution)
    tau = scene.friction.tau
    support = solution.traction > scene.friction.beta * solution.pressure if tau else solution.contact
    exact = oracle.solve(solution.pressure, support)
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
    """No contact is right where the exact gap is nowhere below the approach."""
    if oracle.approach is None:
        return 1.0, "no contact under a load"
    overlap = oracle.approach - min(oracle.h)
    return (0.0, "apart") if overlap <= 0 else (1.0, f"no contact at an overlap of {float(overlap):.1e} m")
