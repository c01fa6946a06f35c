"""One timed solve in a process of its own: ``python -m verification.benchmarks.timed``, called by `rounds`.

A small solve comes first, so that imports and the first use of a library are not timed; kernels, plans and
buffers of the problem's own size are. A second solve gives the warm-run time, with whatever a code keeps.
"""

from __future__ import annotations

import argparse
import json
import math
import statistics
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import scipy.fft as sfft

from refimpl.grid import Array, Grid, Window
from refimpl.operating_system import peak_memory
from refimpl.operators.fft import FFTInfluence
from verification.benchmarks.codes import Pressed, codes
from verification.benchmarks.problems import problem
from verification.framework.files import to_json, write_text
from verification.solver_suite.protocol import ContactProblem

_WARM_UP = (64, 1e-4)  # elements per side, tolerance
_AGAIN = 20.0  # seconds up to which a solve is repeated
_CONVOLUTIONS = 5  # timed, of which the median counts


def main() -> None:
    """Solve by the arguments and write the result."""
    parser = argparse.ArgumentParser(prog="python -m verification.benchmarks.timed", description=__doc__)
    parser.add_argument("--code", required=True)
    parser.add_argument("--kind", required=True)
    parser.add_argument("--grid", type=int, required=True)
    parser.add_argument("--tolerance", type=float, required=True)
    parser.add_argument("--json", type=Path, required=True)
    options = parser.parse_args()
    found = timed_solve(options.code, options.kind, options.grid, options.tolerance)
    write_text(to_json(json.loads(json.dumps(found))), options.json)


def timed_solve(name: str, kind: str, M: int, tolerance: float) -> dict[str, object]:
    """Return seconds, memory, residuals and counts of one solve by the code of that name."""
    code = codes()[name]
    code.ready(kind, *_WARM_UP)()
    press, before, processor = code.ready(kind, M, tolerance), peak_memory(), time.process_time()
    seconds, pressed = _seconds(press)
    processor, memory = time.process_time() - processor, peak_memory()
    shape = padded_box(pressed.pressure)
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
        "padded box": list(shape),
        "convolution seconds": _convolution_seconds(shape),
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


def _convolution_seconds(shape: tuple[int, int]) -> float:
    """Seconds of one convolution by FFT on a shape."""
    field, hat = np.random.default_rng(0).random(shape), np.ones((shape[0], shape[1] // 2 + 1))
    seconds = []
    for _ in range(_CONVOLUTIONS):
        started = time.perf_counter()
        sfft.irfft2(sfft.rfft2(field) * hat, s=shape)
        seconds.append(time.perf_counter() - started)
    return statistics.median(seconds)


if __name__ == "__main__":
    main()
