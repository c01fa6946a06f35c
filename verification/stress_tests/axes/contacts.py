"""Loads, contact sets, materials and friction: from an atom's worth of load to where no solution exists."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

import refimpl as rf
from refimpl.grid import Array
from refimpl.planning.plan import Method
from verification.scenes.cross_checks import POLYMER, STEEL, TABLE1, pressed
from verification.stress_tests.judge import SOLVERS, M, by_oracle, state, tested
from verification.stress_tests.state import Extreme, Judged

SIDE = 1e-3
COULOMB = rf.Friction(0.0, 0.3)
PRESSURES = [10.0**k for k in range(-16, 3)]
"""Mean pressure over E*: 1e-16 is an atom's worth on this side, 1 and more is no elastic contact any more."""
ATOMIC_LOADS = (1e-15, 1e-12, 1e-10, 1e-9, 1e-8, 1e-7, 1e-6)
APPROACHES = (-1.0, -1e-300, 0.0, 5e-324, 1e-300, 1e-160, 1e-30, 1e-18, 1e-12, 1e-9, 1e-7, 1e-6, 1e-5, 1e-4)
RATIOS = (
    -1.0, -1 + 2**-53, -1 + 1e-12, -1 + 1e-6, -1 + 1e-3, -0.9, -0.5, -1e-300, 0.0, 1e-300, 0.25,
    0.49, 0.4999, 0.5 - 1e-9, 0.5 - 2**-54, 0.5, 0.5 + 2**-53,
)  # fmt: skip
TAUS = [10.0**k for k in (-12, -6, -3, -2, -1, -0.5, 0, 0.25, 0.5, 0.75, 1, 1.5, 2, 3, 6)]
"""tau over the peak pressure without it."""
BETAS = (1e-12, 1e-3, 0.1, 0.5, 1.0, 2.0, 5.0, 10.0, 100.0, 1e3, 1e6)


def plane(periodic: bool) -> rf.Scene:
    """Return steel on a polymer with 0.2 um rms noise on one wave a side, pressed at about 1e-3 E*."""
    wave = np.cos(2 * np.pi * np.arange(M) / M)
    rough = 2e-7 * np.random.default_rng(7).standard_normal((M, M)) + 5e-7 * np.add.outer(wave, wave)
    return on(rough, periodic=periodic, friction=rf.Friction(0.0, 0.12))


def on(
    heights: Array, load: float = 1.0, *, periodic: bool = False, friction: rf.Friction = COULOMB
) -> rf.Scene:
    """Return a steel flat on a polymer with the given heights."""
    flat = pressed(radius=None, rms=None, side=SIDE, load=load, direction=0.7, periodic=periodic)
    return replace(flat, lower=rf.Body(POLYMER, heights), friction=friction)


def loads() -> Iterator[Extreme]:
    """Yield mean pressures over E* on every kind of scene; atoms under femtonewtons to micronewtons."""
    smooth = rf.Friction(0.0, 0.12)
    ball = pressed(lower=POLYMER, rms=0.5e-6, direction=0.7, friction=smooth)
    with_tau = replace(ball, friction=TABLE1)
    scenes = {"ball": ball, "ball with tau": with_tau, "plane": plane(False), "periodic plane": plane(True)}
    for series, scene in scenes.items():
        for pressure in PRESSURES:
            loaded = replace(scene, load=pressure * scene.materials.reduced_modulus * scene.lengths[0] ** 2)
            for method in SOLVERS:
                yield state(series, f"p/E* = {pressure:.0e}", pressure, loaded, method)
    # a tip of 10 nm on 5 x 5 elements of an atom's size, 0.25 nm
    atoms = replace(pressed(radius=10e-9, rms=None, side=1.25e-9), friction=smooth)
    for load in ATOMIC_LOADS:
        yield state("atoms", f"{load:.0e} N", load, replace(atoms, load=load), "fft")


def peak(i: int, j: int, height: float = 1e-7) -> Array:
    """Return one high element on a flat."""
    z = np.zeros((M, M))
    z[i, j] = height
    return z


def at_the_border() -> dict[str, Array]:
    """Return heights whose contact begins at the border of the domain."""
    x = (np.arange(M) + 0.5) / M
    ramp = 1e-6 * np.add.outer(x, 0 * x)
    bowl = 1e-6 * np.add.outer((x - 0.5) ** 2, (x - 0.5) ** 2)
    return {
        "corner": peak(0, 0), "edge": peak(0, 3), "far corner": peak(M - 1, M - 1),
        "ramp": ramp, "tilted": ramp + ramp.T, "bowl": bowl,
        "one row": 1e-7 * (x[:, None] < 0.2) * np.ones(M),
    }  # fmt: skip


def contact_sets() -> Iterator[Extreme]:
    """Yield prescribed approaches from apart to deep; peaks that alone carry the load; flats; borders."""
    for method in SOLVERS:
        for approach in APPROACHES:
            for series, law in (("approach", COULOMB), ("approach with tau", TABLE1)):
                scene = pressed(rms=None, lower=POLYMER, friction=law)
                yield state(series, f"{approach:g} m", approach, scene, method, approach=approach)
        for load in (1e-12, 1e-6, 1e-3, 1e-2):
            yield state("one element", f"{load:g} N", load, on(peak(2, 3, 1e-5), load), method)
        for exponent in (-12, -6, 0, 3):
            load = 10.0**exponent
            for series, periodic in (("flat on flat", False), ("flat on flat, periodic", True)):
                yield state(
                    series, f"1e{exponent} N", load, on(np.zeros((M, M)), load, periodic=periodic), method
                )
        for k, (name, heights) in enumerate(at_the_border().items()):
            for load in (1e-4, 1.0, 100.0):
                place = k + math.log10(load) / 10
                yield state("border", f"{name}, {load:g} N", place, on(heights, load), method)


def pair(upper: rf.Material, lower: rf.Material, beta: float = 0.3) -> rf.Scene:
    """Return the ball on a rough flat, high friction, at a mean pressure of 1e-4 of the modulus."""
    scene = pressed(upper=upper, lower=lower, rms=0.5e-6, direction=0.7)
    load = 1e-4 * scene.materials.reduced_modulus * scene.lengths[0] ** 2
    tau = 1e-2 * load / scene.lengths[0] ** 2
    return replace(scene, load=load, friction=replace(TABLE1, tau=tau, beta=beta))


def of_ratios(upper: float, lower: float, method: Method) -> Judged:
    """Judge the ball of 200 GPa on the flat of 3 GPa with their Poisson's ratios, which may be refused."""
    ball, flat = (tested(rf.Material, E, nu) for E, nu in ((2e11, upper), (3e9, lower)))
    return by_oracle(pair(ball, flat), M, method)


def materials() -> Iterator[Extreme]:
    """Yield balls on flats of two materials, by both solvers.

    Poisson's ratio of the flat alone under a ball of steel's; of both bodies at once; the flat's modulus over
    the steel ball's, from 1e-40 to 1e80.
    """
    for method in SOLVERS:
        of_one = [("nu of the lower body", STEEL.nu, nu) for nu in RATIOS]
        for series, upper, nu in (*of_one, *(("nu of both", nu, nu) for nu in RATIOS[1:-1])):
            run = partial(of_ratios, upper, nu, method)
            yield Extreme(f"{series}, {method}", f"{nu!r}", nu, run)
        for exponent in (-40, -20, *range(-6, 7), 20, 40, 80):
            scene = pair(STEEL, rf.Material(STEEL.E * 10.0**exponent, 0.1))
            yield state("modulus ratio", f"1e{exponent}", 10.0**exponent, scene, method)


def sheared(tau: float, beta: float, *, soft_below: bool = True) -> rf.Scene:
    """Return a ball on a rough flat; tau in units of 40 MPa, about the peak pressure."""
    upper, lower = (STEEL, POLYMER) if soft_below else (POLYMER, STEEL)
    law = rf.Friction(40e6 * tau, beta)
    return pressed(upper=upper, lower=lower, rms=0.5e-6, load=30.0, direction=0.7, friction=law)


def friction() -> Iterator[Extreme]:
    """Yield either sign of the coupling, half-space and periodic, slope terms kept, dropped and corrected."""
    flat: dict[str, Any] = {"oblique": False}
    corrected: dict[str, Any] = {"slope_correction": True}
    for method in SOLVERS:
        for tau in TAUS:
            at, scene = f"tau/f = {tau:.3g}", sheared(tau, 0.0)
            yield state("tau", at, tau, scene, method)
            yield state("tau, soft ball", at, tau, sheared(tau, 0.0, soft_below=False), method)
            yield state("tau without slopes", at, tau, scene, method, seconds=150.0, **flat)
        for beta in BETAS:
            at, scene = f"beta = {beta:g}", sheared(0.0, beta)
            yield state("beta", at, beta, scene, method)
            yield state("beta without slopes", at, beta, scene, method, **flat)
            yield state("beta, periodic", at, beta, replace(scene, periodic=True), method, **flat)
            yield state("beta, slope correction", at, beta, scene, method, **corrected)
