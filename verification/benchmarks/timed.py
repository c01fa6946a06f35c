"""One timed solve in a process of its own: ``python -m verification.benchmarks.timed``, called by `rounds`.

A small solve comes first, so that imports and the first use of a library are not timed; kernels, plans and
buffers of the problem's own size are. A second solve gives the warm-run time, with whatever a code keeps.
"""

from __future__ import annotations

import json
import math
import sys
import time
from collections.abc import Callable

import numpy as np
import scipy.fft as sfft

from refimpl.grid import Array, Grid, Window
from refimpl.operating_system import peak_memory
from refimpl.operators.fft import FFTInfluence
from verification.benchmarks.codes import Pressed, codes
from verification.benchmarks.problems import problem
from verification.solver_suite.protocol import ContactProblem

_WARM_UP = (64, 1e-4)  # elements per side, tolerance
_AGAIN = 20.0  # seconds up to which a solve is repeated


def main() -> None:
    """Solve by the arguments CODE KIND M TOLERANCE, and print the result as the last line."""
    code, kind, M, tolerance = sys.argv[1:]
    print("\n" + json.dumps(timed_solve(code, kind, int(M), float(tolerance))))


def timed_solve(name: str, kind: str, M: int, tolerance: float) -> dict[str, object]:
    """Return seconds, memory, residuals and counts of one solve by the code of that name."""
    code = codes()[name]
    code.ready(kind, *_WARM_UP)()
    press, before, processor = code.ready(kind, M, tolerance), peak_memory(), time.process_time()
    seconds, pressed = _seconds(press)
    processor, memory = time.process_time() - processor, peak_memory()
    return {
        "seconds": seconds,
        "seconds again": _seconds(code.ready(kind, M, tolerance))[0] if seconds <= _AGAIN else None,
        "processor seconds": processor,
        "peak memory": memory,
        "memory before": before,
        "converged": pressed.converged,
        "operations": dict(pressed.operations),
        "residual": pressed.residual,
        **residuals_of(problem(kind, M, tolerance), pressed.pressure),
        "padded box": list(padded_box(pressed.pressure)),
    }


def _seconds(press: Callable[[], Pressed]) -> tuple[float, Pressed]:
    started = time.perf_counter()
    pressed = press()
    return time.perf_counter() - started, pressed


def residuals_of(problem: ContactProblem, pressure: Array) -> dict[str, float]:
    """Return residuals of pressures (Pa), recomputed on the whole grid, and what all codes must agree on.

    gap : ``sum f (v - min v) dA`` over the elastic energy
    balance : ``|N - P| / P``
    penetration : over the approach
    tension : largest negative pressure over the peak
    area : m^2
    peak : Pa

    Raises ValueError for problems that are not frictionless, under a load, in free space.
    """
    if problem.load is None or problem.periodic or problem.coupling is not None:
        raise ValueError("only frictionless problems under a load, in free space")
    operator = FFTInfluence(Grid(problem.shape, problem.lengths), direction=0.0)
    u = operator.normal(pressure) / (math.pi * problem.reduced_modulus)
    v, dA, peak = u + problem.gap, problem.element_area, float(pressure.max())
    approach, lowest = float(np.vdot(pressure, v) / pressure.sum()), float(v.min())
    return {
        "gap": float(np.vdot(pressure, v - lowest)) / (0.5 * float(np.vdot(pressure, u))),
        "balance": abs(float(pressure.sum()) * dA / problem.load - 1),
        "penetration": max(0.0, approach - lowest) / approach,
        "tension": max(0.0, -float(pressure.min())) / peak,
        "area": float(np.count_nonzero(pressure > 0)) * dA,
        "peak": peak,
    }


def padded_box(pressure: Array) -> tuple[int, int]:
    """Return the shape of the FFT that convolves over the contact's bounding box."""
    rows, columns = (2 * n for n in Window.around(pressure > 0, margin=0).shape)
    return sfft.next_fast_len(rows), sfft.next_fast_len(columns, real=True)


if __name__ == "__main__":
    main()
