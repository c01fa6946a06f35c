"""Contact sets: none, one element, all of them, and contact at the border of the domain."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from functools import partial

import numpy as np

import refimpl as rf
from refimpl.grid import Array
from verification.extremes.judge import SOLVERS, by_oracle
from verification.extremes.state import Extreme, axis
from verification.scenes.cross_checks import POLYMER, TABLE1, pressed

M = 5
SIDE = 1e-3
COULOMB = rf.Friction(0.0, 0.3)
APPROACHES = (-1.0, -1e-300, 0.0, 5e-324, 1e-300, 1e-160, 1e-30, 1e-18, 1e-12, 1e-9, 1e-7, 1e-6, 1e-5, 1e-4)


def on(
    heights: Array, load: float = 1.0, *, periodic: bool = False, friction: rf.Friction = COULOMB
) -> rf.Scene:
    """A steel flat on a polymer with the given heights."""
    flat = pressed(radius=None, rms=None, side=SIDE, load=load, direction=0.7, periodic=periodic)
    return replace(flat, lower=rf.Body(POLYMER, heights), friction=friction)


def peak(i: int, j: int, height: float = 1e-7) -> Array:
    """One high element on a flat."""
    z = np.zeros((M, M))
    z[i, j] = height
    return z


def at_the_border() -> dict[str, Array]:
    """Heights whose contact begins at the border of the domain."""
    x = (np.arange(M) + 0.5) / M
    ramp = 1e-6 * np.add.outer(x, 0 * x)
    bowl = 1e-6 * np.add.outer((x - 0.5) ** 2, (x - 0.5) ** 2)
    return {
        "corner": peak(0, 0), "edge": peak(0, 3), "far corner": peak(M - 1, M - 1),
        "ramp": ramp, "tilted": ramp + ramp.T, "bowl": bowl,
        "one row": 1e-7 * (x[:, None] < 0.2) * np.ones(M),
    }  # fmt: skip


@axis("contact set")
def contact_sets() -> Iterator[Extreme]:
    """Prescribed approaches from apart to deep; peaks that alone carry the load; flats; borders."""
    for method in SOLVERS:
        for approach in APPROACHES:
            for series, law in (("approach", COULOMB), ("approach with tau", TABLE1)):
                scene = pressed(rms=None, lower=POLYMER, friction=law)
                yield Extreme(
                    "contact set", f"{series}, {method}", f"{approach:g} m", approach,
                    partial(by_oracle, scene, M, method, approach=approach),
                )  # fmt: skip
        for load in (1e-12, 1e-6, 1e-3, 1e-2):
            yield Extreme(
                "contact set", f"one element, {method}", f"{load:g} N", load,
                partial(by_oracle, on(peak(2, 3, 1e-5), load), M, method),
            )  # fmt: skip
        for exponent in (-12, -6, 0, 3):
            for periodic in (False, True):
                series = f"flat on flat, {'periodic ' * periodic}{method}"
                scene = on(np.zeros((M, M)), 10.0**exponent, periodic=periodic)
                yield Extreme(
                    "contact set", series, f"1e{exponent} N", 10.0**exponent,
                    partial(by_oracle, scene, M, method),
                )  # fmt: skip
        for k, (name, heights) in enumerate(at_the_border().items()):
            for load in (1e-4, 1.0, 100.0):
                yield Extreme(
                    "contact set", f"border, {method}", f"{name}, {load:g} N", k + math.log10(load) / 10,
                    partial(by_oracle, on(heights, load), M, method),
                )  # fmt: skip
