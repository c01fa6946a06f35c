"""Units: the same scene in lengths, moduli and loads scaled by 1e-12 ... 1e12; the solution must follow.

Scaling all lengths by s (the load by s^2), or stresses and load by e, changes no dimensionless number.
The load alone scales by s^3 where the side scales by s, heights by s^2 and stresses of friction by s, since
without slope terms Eq. (7) reads u = side f / E*: pressure scales by s. Powers of two change no bit of a
mantissa, so the scaled solution must be the same to the last bit; powers of ten round the input.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache, partial

import numpy as np

import refimpl as rf
from refimpl.planning.plan import Method
from refimpl.solution.quantities import error_bound
from verification.scenes.cross_checks import COPPER, STEEL
from verification.stress_tests.judge import tested, verdict
from verification.stress_tests.state import Extreme, Judged

TOLERANCE = 1e-12
LIMIT = 1e-12
"""Relative change allowed for powers of ten: rounding of the input, 1e-16, times what the solve amplifies."""
FLAT = 1e-4
"""Of heights and load where the load alone is scaled: 1e12 times the load has 1e4 times height / side."""
HEIGHTS = 0.3e-6 * np.random.default_rng(2001).standard_normal((24, 24))
TWOS, TENS = range(-40, 41, 4), range(-12, 13)
SIZES: dict[Method, int] = {"fft": 24, "dense": 12}
SETTINGS: tuple[tuple[Method, bool], ...] = (("fft", False), ("fft", True), ("dense", False))


def scene(
    length: float = 1.0, stress: float = 1.0, similar: float = 1.0, *, periodic: bool, oblique: bool = True
) -> rf.Scene:
    """Return a sphere (or, periodic, a flat) on a rough flat with lengths, stresses or load scaled."""
    flat = 1.0 if oblique else FLAT
    z = HEIGHTS[: SIZES["dense"], : SIZES["dense"]] * (length * similar**2 * flat)
    ball: rf.Surface = rf.Flat() if periodic else rf.Sphere(0.14 * length / flat)
    return rf.Scene(
        upper=rf.Body(rf.Material(STEEL.E * stress, STEEL.nu), ball),
        lower=rf.Body(rf.Material(COPPER.E * stress, COPPER.nu), z),
        friction=rf.Friction(15e6 * stress * similar * flat, 0.08),
        load=70.0 * length**2 * stress * similar**3 * flat,
        side=1.61e-3 * length * similar,
        sliding_direction=0.7,
        periodic=periodic,
    )


def solved(method: Method, periodic: bool, oblique: bool, *scales: float) -> rf.Solution:
    """Return the solution of a scene with lengths, stresses and load scaled."""
    scaled = scene(*scales, periodic=periodic, oblique=oblique)
    return rf.solve(scaled, SIZES[method], method=method, tolerance=TOLERANCE, oblique=oblique)


@cache
def unscaled(method: Method, periodic: bool, oblique: bool) -> rf.Solution:
    """Return the solution that all scaled ones are compared with."""
    found = solved(method, periodic, oblique)
    if found.status is not rf.Status.CONVERGED:
        raise ArithmeticError(f"the unscaled scene ended {found.status.value}")
    return found


def change(
    scaled: rf.Solution, base: rf.Solution, length: float, stress: float, similar: float, *, bars: bool
) -> tuple[float, str]:
    """Return the largest relative change of pressure field, approach, area, forces and friction coefficient.

    With ``bars``, of the grid's part of their error bars as well.
    """
    pressure, area = stress * similar, (length * similar) ** 2
    factors = {
        "approach": length * similar**2,
        "contact_area": area,
        "max_pressure": pressure,
        "normal_force": pressure * area,
        "friction_force": pressure * area,
        "friction_coefficient": 1.0,
    }
    found = {}
    for name, factor in factors.items():
        found[name] = abs(getattr(scaled, name) / factor / getattr(base, name) - 1)
        if bars and name != "normal_force":
            bar, base_bar = (error_bound(s, name) for s in (scaled, base))
            found[f"the bar of {name}"] = abs(bar / factor / base_bar - 1)
    found["pressure"] = float(np.abs(scaled.pressure / pressure - base.pressure).max()) / base.max_pressure
    worst = max(found, key=lambda name: found[name])
    return found[worst], f"worst in {worst}"


def run(method: Method, periodic: bool, length: float, stress: float, similar: float, limit: float) -> Judged:
    """Solve the scaled scene and compare."""
    oblique = similar == 1.0
    base = unscaled(method, periodic, oblique)
    scaled = tested(solved, method, periodic, oblique, length, stress, similar)
    # powers of ten round what a bar's root is sought from, and it is found to 1e-4
    error, note = change(scaled, base, length, stress, similar, bars=limit == 0)
    return verdict(scaled, error, "the scaling law", note, limit)


def scalings() -> Iterator[tuple[str, str, float, tuple[float, float, float], float]]:
    """Yield ``(what, at, factor, (length, stress, similar), limit)``."""
    for power, exponents, limit in ((2.0, TWOS, 0.0), (10.0, TENS, LIMIT)):
        for k in exponents:
            factor, at = power**k, f"{power:g}^{k}"
            yield "length", at, factor, (factor, 1.0, 1.0), limit
            yield "modulus", at, factor, (1.0, factor, 1.0), limit
            cube = round(k / 3) if power == 2 else k / 3
            yield "load", f"{power:g}^{3 * cube:g}", power ** (3 * cube), (1.0, 1.0, power**cube), limit
    for length in (-12, 12):
        for stress in (-12, 12):
            factors = (10.0**length, 10.0**stress, 1.0)
            yield "length and modulus", f"10^{length}, 10^{stress}", factors[0], factors, LIMIT


def units() -> Iterator[Extreme]:
    """Yield every scaling for the production solver (half-space and periodic) and for the dense one."""
    seen = set()
    for what, at, factor, parts, limit in scalings():
        for method, periodic in SETTINGS:
            series = f"{what}, {'periodic' if periodic else method}"
            if (series, at) in seen or (periodic and what == "load"):
                continue
            seen.add((series, at))
            kind = "twos" if at.startswith("2^") else "tens"
            yield Extreme(f"{series}, {kind}", at, factor, partial(run, method, periodic, *parts, limit))
