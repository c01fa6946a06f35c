"""ASPHER (Yastrebov 2026), by nested grids where the grid allows, with its exact FFT operator.

Its default H2 operator approximates the influence coefficients to some 1e-6, beyond the tolerances here.
Its extra builds from source, with a C++17 compiler, CMake, and Eigen (Debian's libeigen3-dev).
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from verification.adapters.published_code import PublishedAnswer, PublishedCode, closure, imported
from verification.solver_suite.protocol import Abilities, ContactProblem

_COARSEST = 64  # its own default
_ITERATIONS = 5000


def press(problem: ContactProblem, **options: str) -> PublishedAnswer:
    """Return the pressures of ``solve_nested`` with its ``options``; of ``ContactSolver`` if M is not 64 2^k.

    Its Frank-Wolfe error is the mean gap under the pressure over the range of the gap, and over one unit of
    length where the gap is flat: the unit is ``P / (E* side)``, about the approach, to give that a meaning.
    """
    hc = imported("aspher")
    assert problem.load is not None  # by its abilities
    E, side = problem.reduced_modulus, problem.lengths[0]
    unit = problem.load / (E * side)
    backend = "periodic" if problem.periodic else "fft"
    common = {"domain_size": side / unit, "E_star": 1.0, "backend": backend}
    stop = {
        "p_nominal": problem.load / side**2 / E,
        "tol": closure(problem) / (float(problem.gap.max()) or unit),
        "max_iter": _ITERATIONS,
    }
    gap = problem.gap.ravel() / unit
    if _halves(problem.M):
        found = hc.solve_nested(problem.M, gap, coarsest=_COARSEST, **common, **stop, **options)
    else:
        found = hc.ContactSolver(problem.M, **common).solve(gap, precond="fourier", **stop)
    pressure = E * np.array(found.pressure, dtype=np.float64).reshape(problem.gap.shape)
    work = {"displacements": int(found.matvec_count), "preconditionings": int(found.precond_count)}
    return PublishedAnswer(pressure, str(found.status) == "converged", operations=work)


def _halves(M: int) -> bool:
    levels, rest = divmod(M, _COARSEST)
    return rest == 0 and levels > 0 and levels & (levels - 1) == 0


solve = PublishedCode(
    distribution="aspher",
    extra="aspher",
    setup="solve_nested from 64 x 64 with backend 'fft' or 'periodic', double precision, its other defaults",
    abilities=Abilities(approach=False),
    press=press,
    needs="it builds from source: a C++17 compiler, CMake and Eigen (Debian: apt-get install libeigen3-dev)",
)
"""Solver under test."""

fastest = replace(
    solve,
    setup="solve_nested with precond_engine 'fft' and precision 'float_then_double': quickest exact set-up "
    "found on Table 1's contact, 0.2 to 0.4 s instead of 0.7 s for the defaults at 512 x 512",
    press=partial(press, precond_engine="fft", precision="float_then_double"),
)
"""The same with the options that serve this project's benchmark best."""
