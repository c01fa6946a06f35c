"""Topography: roughness from 1e-12 of the gap to slopes of 45 degrees, data far from zero, exact ties."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from functools import partial

import numpy as np

import refimpl as rf
from refimpl.grid import Array
from refimpl.planning.plan import Method
from verification.scenes.cross_checks import POLYMER, STEEL, TABLE1, pressed
from verification.stress_tests.judge import GOOD, SOLVERS, TOLERANCE, M, change, state, tested, verdict
from verification.stress_tests.state import NO_DIGITS, Extreme, Judged, Verdict

SIDE = 1e-3
NOISE = np.random.default_rng(45).standard_normal((M, M))
SLOPES = [math.radians(d) for d in (0.01, 0.1, 1, 3, 6.5, 10, 15, 20, 25, 30, 35, 40, 45)]
AMPLITUDES = [10.0**k for k in range(-18, -6)]
OFFSETS = [2.0**k for k in range(0, 61, 6)]
"""Offset of the heights, over their range; 2^20 is the required million."""
AMPLIFIED = 30.0
"""Error allowed over the data's own, the rounding of heights at an offset over their range. Heights off by e
change the M^2 pressures by up to M e / (1.82 u) of the peak: 1.82 is the least eigenvalue of the flexibility,
u the displacement by one element under the peak, a tenth of the range here: 27. At most 3.6 is
measured above rounding."""


def rough_ball(heights: Array, radius: float = 0.14, load: float = 1.0) -> rf.Scene:
    """Return a ball on a polymer with the given heights."""
    law = replace(TABLE1, tau=1e5)
    ball = pressed(radius=radius, rms=None, friction=law, load=load, side=SIDE, direction=0.7)
    return replace(ball, lower=rf.Body(POLYMER, heights))


def sloped(angle: float) -> Array:
    """Return noise whose largest central difference is the tangent of an angle."""
    step = np.abs(np.gradient(NOISE, SIDE / M, axis=0)).max()
    return np.asarray(NOISE * (math.tan(angle) / step))


def shifted(offset: float, *, dyadic: bool, method: Method) -> Judged:
    """Judge heights plus an offset against the same heights without one: no more is lost than the data lost.

    Where these lost more than `NO_DIGITS`, nothing is right; larger errors than theirs are wrong.
    """
    z = np.round(NOISE * 2**8) * 2.0**-28 if dyadic else 1e-6 * NOISE
    far = z + offset * float(np.ptp(z))
    lost = float(np.abs((far - far.min()) - (z - z.min())).max()) / float(np.ptp(z))
    near, away = (replace(rough_ball(heights), upper=rf.Body(STEEL, rf.Flat())) for heights in (z, far))
    here = rf.solve(near, M, method=method, tolerance=TOLERANCE)
    there = tested(rf.solve, away, M, method=method, tolerance=TOLERANCE)
    if here.status not in GOOD:
        raise ArithmeticError(f"without an offset: {here.status.value}")
    limit = AMPLIFIED * lost + (0.0 if lost == 0 else 1e-9)
    judged = verdict(there, change(there, here), "the same heights without an offset", limit=limit, lost=lost)
    undecided = judged.verdict is Verdict.RIGHT and lost > NO_DIGITS
    return replace(judged, verdict=Verdict.UNJUDGED) if undecided else judged


def ties() -> dict[str, Array]:
    """Return heights with exact ties: equal steps, duplicates, symmetries."""
    i, j = np.indices((M, M))
    return {
        "checkerboard": 1e-7 * ((i + j) % 2),
        "two levels": 1e-7 * (i < 2),
        "stripes": 1e-7 * (i % 2),
        "four towers": 1e-7 * ((i % 4 == 0) & (j % 4 == 0)),
        "ring": 1e-7 * (np.maximum(np.abs(i - 2), np.abs(j - 2)) == 1),
        "staircase": 1e-7 * (i + j),
        "whole numbers": 1e-7 * np.random.default_rng(3).integers(0, 3, (M, M)),
        "all equal": np.full((M, M), 0.1),
    }


def topography() -> Iterator[Extreme]:
    """Yield amplitudes, slopes, offsets and ties for both solvers."""
    for method in SOLVERS:
        for amplitude in AMPLITUDES:
            yield state("rms", f"{amplitude:.0e} m", amplitude, rough_ball(amplitude * NOISE), method)
        for angle in SLOPES:
            degrees, scene = math.degrees(angle), rough_ball(sloped(angle), load=1e3)
            for series, correction in (("largest slope", False), ("largest slope, corrected", True)):
                yield state(series, f"{degrees:.3g} deg", degrees, scene, method, slope_correction=correction)
        for offset in OFFSETS:
            for kind, dyadic in (("dyadic heights", True), ("heights", False)):
                run = partial(shifted, offset, dyadic=dyadic, method=method)
                yield Extreme(f"offset, {kind}, {method}", f"{offset:.3g}", offset, run)
        for k, (name, heights) in enumerate(ties().items()):
            for body, radius in (("ball", 0.14), ("flat", 1e300)):
                yield state(f"ties, {body}", name, float(k), rough_ball(heights, radius), method)
