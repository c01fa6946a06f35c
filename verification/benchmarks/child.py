"""One timed solve in a process of its own: ``python -m verification.benchmarks.child``, called by `rounds`.

A small solve comes first, so that imports and the first use of a library are nobody's seconds; what a solve
needs of kernels, plans and buffers at its own size is its own. A second solve then says what the next ones
of a sweep take, with whatever a code keeps.
"""

from __future__ import annotations

import argparse
import json
import resource
import statistics
import time
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path

import numpy as np
import scipy.fft as sfft

from verification.benchmarks.codes import Pressed, codes
from verification.benchmarks.judge import judged, padded_box
from verification.benchmarks.problems import problem
from verification.framework.files import to_json, write_text

_WARM_UP = (64, 1e-4)  # elements per side, tolerance
_AGAIN = 20.0  # seconds up to which a solve is repeated


def main() -> None:
    """Solve as told by the arguments and write what was found."""
    parser = argparse.ArgumentParser(prog="python -m verification.benchmarks.child", description=__doc__)
    parser.add_argument("--code", required=True)
    parser.add_argument("--kind", required=True)
    parser.add_argument("--grid", type=int, required=True)
    parser.add_argument("--tolerance", type=float, required=True)
    parser.add_argument("--json", type=Path, required=True)
    options = parser.parse_args()
    found = measured(options.code, options.kind, options.grid, options.tolerance)
    write_text(to_json(json.loads(json.dumps(found))), options.json)


def measured(name: str, kind: str, M: int, tolerance: float) -> dict[str, object]:
    """Seconds, memory, residuals and counts of one solve by the code of that name."""
    code = codes()[name]
    code.ready(kind, *_WARM_UP)()
    press = code.ready(kind, M, tolerance)
    before = peak_memory()
    wall, processor = time.perf_counter(), time.process_time()
    pressed = press()
    wall, processor = time.perf_counter() - wall, time.process_time() - processor
    memory = peak_memory()
    again = _seconds(code.ready(kind, M, tolerance)) if wall <= _AGAIN else None
    found: dict[str, object] = {
        "seconds": wall,
        "seconds again": again,
        "processor seconds": processor,
        "peak memory": memory,
        "memory before": before,
        "converged": pressed.converged,
        "operations": dict(pressed.operations),
        "residual": pressed.residual,
        **asdict(judged(problem(kind, M, tolerance), pressed.pressure)),
    }
    return found | _on_the_box(pressed)


def _seconds(press: Callable[[], Pressed]) -> float:
    started = time.perf_counter()
    press()
    return time.perf_counter() - started


def peak_memory() -> int:
    """Largest resident size of this process so far (bytes).

    Linux keeps that of a parent in ``ru_maxrss`` across exec, so its own account is asked for first.
    """
    status = Path("/proc/self/status")
    if status.is_file():
        for line in status.read_text(encoding="ascii", errors="replace").splitlines():
            if line.startswith("VmHWM:"):
                return 1024 * int(line.split()[1])
    return 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss


def _on_the_box(pressed: Pressed) -> dict[str, object]:
    """The padded bounding box of the contact, and the seconds of one FFT convolution on it."""
    shape = padded_box(pressed.pressure)
    field, hat = np.random.default_rng(0).random(shape), np.ones((shape[0], shape[1] // 2 + 1))
    seconds = []
    for _ in range(5):
        started = time.perf_counter()
        sfft.irfft2(sfft.rfft2(field) * hat, s=shape)
        seconds.append(time.perf_counter() - started)
    return {"padded box": list(shape), "convolution seconds": statistics.median(seconds)}


if __name__ == "__main__":
    main()
