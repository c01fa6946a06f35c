"""Load: from one atom's worth to full contact and far beyond, until pressures exceed every modulus."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import partial

import numpy as np

import refimpl as rf
from verification.extremes.judge import SOLVERS, by_oracle
from verification.extremes.state import Extreme, axis
from verification.scenes.cross_checks import POLYMER, TABLE1, pressed

M = 5
PRESSURES = [10.0**k for k in range(-16, 3)]
"""Mean pressure over E*: 1e-16 is an atom's worth on this side, 1 and more is no elastic contact any more."""
WAVE = np.cos(2 * np.pi * np.arange(M) / M)


def ball() -> rf.Scene:
    """Table 1's ball on a rough polymer, Coulomb friction."""
    return pressed(lower=POLYMER, rms=0.5e-6, direction=0.7, friction=rf.Friction(0.0, 0.12))


def plane(periodic: bool) -> rf.Scene:
    """A steel flat on a polymer of rough, then of wavy form that is pressed flat at about 1e-3 E*."""
    rough = 2e-7 * np.random.default_rng(7).standard_normal((M, M)) + 5e-7 * np.add.outer(WAVE, WAVE)
    flat = pressed(lower=POLYMER, radius=None, rms=None, side=1e-3, direction=0.7, periodic=periodic)
    return replace(flat, lower=rf.Body(POLYMER, rough), friction=rf.Friction(0.0, 0.12))


def atoms() -> rf.Scene:
    """A tip of 10 nm on 5 x 5 elements of an atom's size, 0.25 nm."""
    return replace(pressed(radius=10e-9, rms=None, side=1.25e-9), friction=rf.Friction(0.0, 0.12))


@axis("load")
def loads() -> Iterator[Extreme]:
    """Mean pressures over E* on every kind of scene; atoms under piconewtons to micronewtons."""
    with_tau = replace(ball(), friction=TABLE1)
    scenes = {"ball": ball(), "ball with tau": with_tau, "plane": plane(False), "periodic plane": plane(True)}
    for series, scene in scenes.items():
        for pressure in PRESSURES:
            load = pressure * scene.materials.reduced_modulus * scene.lengths[0] ** 2
            for method in SOLVERS:
                yield Extreme(
                    "load", f"{series}, {method}", f"p/E* = {pressure:.0e}", pressure,
                    partial(by_oracle, replace(scene, load=load), M, method),
                )  # fmt: skip
    for load in (1e-15, 1e-12, 1e-10, 1e-9, 1e-8, 1e-7, 1e-6):
        yield Extreme(
            "load", "atoms, fft", f"{load:.0e} N", load,
            partial(by_oracle, replace(atoms(), load=load), M, "fft"),
            seconds=8.0,  # under a micronewton the oracle itself seeks slopes that do not settle, for 4 s
        )  # fmt: skip
