"""Grids: 1 x 1, 2 x 2, primes, one of 2048; and contacts as long and narrow as the grid allows."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import partial

import numpy as np

import refimpl as rf
from verification.exact import hertz
from verification.scenes.cross_checks import POLYMER, STEEL, pressed
from verification.stress_tests.judge import GOOD, SOLVERS, TOLERANCE, change, state, tested, verdict
from verification.stress_tests.state import Extreme, Judged

TINY, PRIMES, LARGEST = (1, 2, 3, 5, 7), (11, 13, 17, 19, 23), 2048
LINES = (1, 2, 4, 8, 16)


def against_dense(scene: rf.Scene, M: int | tuple[int, int]) -> Judged:
    """Judge the production solver against the dense one, whose certificate is at rounding.

    Where that one fails too, the failure is a detected one without a reference; a good status is not judged.
    """
    found = tested(rf.solve, scene, M, tolerance=TOLERANCE)
    exact = rf.solve(scene, M, method="dense", tolerance=TOLERANCE)
    apart = change(found, exact)
    if exact.status in GOOD:
        return verdict(found, apart, "the dense solver")
    if found.status in GOOD:
        raise ArithmeticError(f"the dense solver ended {exact.status.value}")
    return verdict(found, np.inf, "none", f"the dense solver fails too, {apart:.0e} apart")


def against_hertz(M: int) -> Judged:
    """Judge a smooth ball, frictionless: peak and approach within 2 (spacing / a)^2, the elements' cost."""
    scene = replace(pressed(rms=None), friction=rf.Friction())
    found = tested(rf.solve, scene, M, oblique=False)
    exact = hertz.Sphere(scene.load, 0.14, scene.materials.reduced_modulus)
    error = max(abs(found.max_pressure / exact.peak_pressure - 1), abs(found.approach / exact.approach - 1))
    flipped = max(np.abs(found.pressure - p).max() for p in (found.pressure[::-1], found.pressure.T))
    symmetry = float(flipped) / found.max_pressure
    limit = 2 * (found.grid.element_size / exact.contact_radius) ** 2 + 1e-7
    return verdict(found, error, "Hertz", f"asymmetry {symmetry:.0e}", limit, symmetry=symmetry)


def ridge(M: int, across: int) -> rf.Scene:
    """Return a parabolic ridge along x that touches ``across`` elements or so of M."""
    y = (np.arange(M) + 0.5) / M - 0.5
    z = -1e-6 * np.outer(np.ones(M), (y * M / across) ** 2)
    flat = pressed(upper=STEEL, lower=POLYMER, radius=None, rms=None, side=1e-3, load=1.0, direction=0.7)
    return replace(flat, lower=rf.Body(POLYMER, z))


def grids() -> Iterator[Extreme]:
    """Yield tiny grids by the oracle, primes by the dense solver, large by Hertz, ridges of any aspect."""
    scene = pressed(lower=POLYMER, load=30.0, direction=0.7)
    flat = replace(scene, upper=rf.Body(STEEL, rf.Flat()), periodic=True)
    scenes = {"half-space": scene, "periodic": flat}
    for M in TINY:
        for method in SOLVERS:
            for name, what in scenes.items():
                yield state(name, f"{M}", float(M), what, method, elements=M)
    for M in PRIMES:
        for name, what in scenes.items():
            yield Extreme(f"{name} primes, fft", f"{M}", float(M), partial(against_dense, what, M))
    for M in (31, 61, 127, 257, 509, LARGEST):
        yield Extreme("Hertz, fft", f"{M}", float(M), partial(against_hertz, M), seconds=300.0)
    for across in LINES:
        run = partial(against_dense, ridge(24, across), 24)
        yield Extreme("ridge of 24 elements, fft", f"{across} across", float(across), run, seconds=30.0)
