"""Determinism: fresh processes and repeated runs agree to the last bit; numbers of threads within a bound."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from dataclasses import replace

import numpy as np

import refimpl as rf
from refimpl.operators.transforms import Ducc, fourier
from refimpl.planning.plan import Method
from verification.cases import Measured, case

SETTINGS: tuple[tuple[Method, bool], ...] = (("fft", False), ("fft", True), ("dense", False))
SOURCE = "pressures and numbers compared in hexadecimal"
GRIDS: dict[Method, int] = {"fft": 384, "dense": 24}
"""384: transforms by ducc0 that get two threads, periodic or not; 24: matrices that BLAS factorises so."""
WITHOUT_DUCC0 = (
    "threads of ducc0: unavailable, it is not installed; compared are those of BLAS, and of SciPy's "
    "transforms of the free scene, as the periodic one's get one thread"
)
TRANSFORMS, BLAS = "OMP_NUM_THREADS", ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
"""Where each reads its number of threads; BLAS from the first as well, unless its own says otherwise."""
CHILD = "from verification.cases.solvers import determinism as d; d.write_solution({method!r}, {periodic!r})"
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
    """Return the largest relative difference of pressures (to the peak) and numbers; 0: equal bits."""
    if one == other:
        return 0.0
    first, second = (np.frombuffer(bytes.fromhex(answer["pressure"])) for answer in (one, other))
    apart = [float(np.abs(first - second).max() / first.max())]
    for name in NUMBERS:
        a, b = float.fromhex(one[name]), float.fromhex(other[name])
        apart.append(abs(a - b) / max(abs(a), abs(b)) if a != b else 0.0)
    return max(apart)


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

    Claim: two threads of BLAS, and two of the transforms as well, change the pressures of these scenes by
    less than 1e-12 of the peak
    Tolerance: sums by two threads differ by up to 6e-16, CG amplifies that: 3.75e-14 of the peak measured,
    by BLAS. Where rounding decides which iteration is the last, the solver's tolerance is the bound: 8e-9 of
    table1-smooth on 512 x 512

    ducc0's transforms round differently by threads, SciPy's do not: the note names what was compared.
    """
    blas, both = {}, {}
    for method, periodic in SETTINGS:
        name = f"{method}, periodic {periodic}"
        one = in_a_process(method, periodic, transforms=1, blas=1)
        blas[name] = difference(one, in_a_process(method, periodic, transforms=1, blas=2))
        both[name] = difference(one, in_a_process(method, periodic, transforms=2, blas=2))
    compared = isinstance(fourier, Ducc)
    library = "ducc0's transforms" if compared else "SciPy's transforms"
    return Measured(
        max([*blas.values(), *both.values()]),
        data={"BLAS alone": blas, f"BLAS and {library}": both},
        note="" if compared else WITHOUT_DUCC0,
    )


@case("extremes/determinism-repeated", metric="equal", tolerance=0.0, source=SOURCE)
def repeated() -> Measured:
    """Twice in one process.

    Claim: a second solve of the same scene gives the same bits: nothing is remembered that matters
    Tolerance: equal bits
    """
    first, second = (solved("dense", False) for _ in range(2))
    apart = float(np.abs(first.pressure - second.pressure).max())
    return Measured(value=apart, reference=0.0)
