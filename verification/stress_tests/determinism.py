"""One scene solved in fresh processes with one or two threads, compared bit by bit."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from dataclasses import replace

import numpy as np

import refimpl as rf
from refimpl.planning.plan import Method

GRIDS: dict[Method, int] = {"fft": 384, "dense": 24}
"""384: transforms that get two threads, periodic or not; 24: matrices that BLAS factorises in parallel."""
TRANSFORMS, BLAS = "OMP_NUM_THREADS", ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
"""Where each reads its number of threads; BLAS from the first as well, unless its own says otherwise."""
CHILD = "from verification.stress_tests import determinism as d; d.write_solution({method!r}, {periodic!r})"
NUMBERS = ("approach", "normal_force", "friction_force", "contact_area", "max_pressure")


def solved(method: Method, periodic: bool) -> rf.Solution:
    """Return Table 1's rough scene; for the periodic one a rough flat."""
    scene = rf.read_scene("rough-planes" if periodic else "table1-rough")
    if method == "dense" and not periodic:
        scene = replace(scene, load=7.0)
    return rf.solve(scene, GRIDS[method], method=method)


def write_solution(method: Method, periodic: bool) -> None:
    """Print the solution of this process, exactly (hexadecimal)."""
    solution = solved(method, periodic)
    numbers = {name: float(getattr(solution, name)).hex() for name in NUMBERS}
    json.dump({"pressure": solution.pressure.tobytes().hex(), **numbers}, sys.stdout)


def in_a_process(method: Method, periodic: bool, *, transforms: int, blas: int) -> dict[str, str]:
    """Return the output of a fresh process with given threads for BLAS and transforms."""
    environment = os.environ | {TRANSFORMS: str(transforms), **dict.fromkeys(BLAS, str(blas))}
    code = CHILD.format(method=method, periodic=periodic)
    done = subprocess.run(
        [sys.executable, "-c", code], env=environment, capture_output=True, encoding="utf-8", check=True
    )
    answer: dict[str, str] = json.loads(done.stdout)
    return answer


def difference(one: dict[str, str], other: dict[str, str]) -> float:
    """Return the largest relative difference of the pressures (to the peak) and of the numbers; 0 for equal
    bits."""
    if one == other:
        return 0.0
    first, second = (np.frombuffer(bytes.fromhex(answer["pressure"])) for answer in (one, other))
    apart = [float(np.abs(first - second).max() / first.max())]
    for name in NUMBERS:
        a, b = float.fromhex(one[name]), float.fromhex(other[name])
        apart.append(abs(a - b) / max(abs(a), abs(b)) if a != b else 0.0)
    return max(apart)
