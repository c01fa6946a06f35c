"""Shapes of maps: lines, thin elements, waves at the Nyquist length, equal asperities; and hardness."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from itertools import product

import numpy as np

import refimpl as rf
from refimpl.grid import Array
from verification.scenes.cross_checks import POLYMER
from verification.stress_tests.axes.contacts import SIDE, on
from verification.stress_tests.axes.grids import against_dense
from verification.stress_tests.judge import SOLVERS, state
from verification.stress_tests.state import Extreme

ROW, COLUMN = np.indices((6, 6))
LINES = ((1, 2), (1, 16), (1, 64), (1, 512), (512, 1), (2, 256))
ASPECTS = [10.0**k for k in (-3, -2, -1, 0, 1, 2, 3)]
RMS_SLOPES = (0.1, 0.3, 1.0, 2.0, 3.0)
HARDNESS = [10.0**k for k in (-6, -3, -1, 0.1, 0.3, 1, 2, 3, 6)]
"""Over the mean pressure."""
HEIGHTS: dict[str, Array] = {
    "stripes at the Nyquist length": np.asarray((-1.0) ** ROW),
    "checkerboard at the Nyquist length": np.asarray((-1.0) ** (ROW + COLUMN)),
    "equal asperities": -((ROW % 3 - 1.0) ** 2) - (COLUMN % 3 - 1.0) ** 2,
    "equal punches": np.where((ROW % 3 < 2) & (COLUMN % 3 < 2), 1.0, 0.0),
    "all but one element": -10.0 * ((ROW == 2) & (COLUMN == 3)),
}
"""In units of 1e-7 m."""


def pressed_on(heights: Array, pressure: float, width: float = SIDE, *, periodic: bool = False) -> rf.Scene:
    """Press a steel flat on heights at a mean pressure over E*; ``width`` (m) is the domain's along y."""
    scene = on(heights, periodic=periodic)
    pixel = SIDE / heights.shape[0], width / heights.shape[1]
    lower = rf.Body(POLYMER, rf.ArraySurface(heights, pixel=pixel))
    load = pressure * scene.materials.reduced_modulus * SIDE * width
    return replace(scene, side=None, size=(SIDE, width), load=load, lower=lower)


def hardened(ratio: float, *, periodic: bool) -> rf.Scene:
    """Return a rough flat of a hardness over the mean pressure, on slopes of about 1e-2."""
    scene = pressed_on(1e-6 * noise(6, 6), 1e-4, periodic=periodic)
    hardness = ratio * scene.load / SIDE**2
    return replace(scene, lower=replace(scene.lower, material=replace(POLYMER, hardness=hardness)))


def noise(m: int, n: int) -> Array:
    """Return heights of variance 1 without correlation."""
    return np.random.default_rng(m + n).standard_normal((m, n))


def steep(slope: float) -> Array:
    """Return noise of 24 x 24 elements with an rms slope."""
    z = noise(24, 24)
    return np.asarray(z * (slope / np.sqrt(np.mean(np.square(np.gradient(z, SIDE / 24))))))


def shapes() -> Iterator[Extreme]:
    """Yield lines, aspects, slopes, hardness by the dense solver; others, of both solvers, by the oracle."""
    heights = [
        *(("line", f"{m} x {n}", n / m, 1e-7 * noise(m, n), 1e-4, SIDE * n / m) for m, n in LINES),
        *(("aspect", f"{aspect:g}", aspect, 1e-7 * noise(6, 6), 1e-4, SIDE * aspect) for aspect in ASPECTS),
        *(("rms slope", f"{slope:g}", slope, steep(slope), 1e-2, SIDE) for slope in RMS_SLOPES),
    ]
    for name, periodic in (("half-space", False), ("periodic", True)):
        for series, at, x, z, pressure, width in heights:
            scene = pressed_on(z, pressure, width, periodic=periodic)
            run = partial(against_dense, scene, z.shape)
            yield Extreme(f"{series}, {name}, fft", at, x, run, 20.0)
        for ratio in HARDNESS:
            run = partial(against_dense, hardened(ratio, periodic=periodic), 6)
            yield Extreme(f"hardness, {name}, fft", f"H/p = {ratio:.3g}", ratio, run)
        for pressure, (series, z), method in product((1e-8, 1e-5, 1e-2), HEIGHTS.items(), SOLVERS):
            scene = pressed_on(1e-7 * z, pressure, periodic=periodic)
            yield state(f"{series}, {name}", f"p/E* = {pressure:.0e}", pressure, scene, method, 6)
