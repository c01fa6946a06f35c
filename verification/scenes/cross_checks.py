"""Scenes on which the two solvers are held against each other: each stresses one part of the model.

Small grids, as the dense reference is limited to them; odd, even, not only powers of two. SI units, rad.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import refimpl as rf

STEEL, COPPER = rf.Material(E=200e9, nu=0.30), rf.Material(E=118e9, nu=0.30)
POLYMER = rf.Material(E=2.5e9, nu=0.38)
TABLE1 = rf.Friction(tau=15e6, beta=0.08)


@dataclass(frozen=True, eq=False)
class Trial:
    """A scene, its grid and the options of `refimpl.solve`; ``stresses`` says what it is there for."""

    name: str
    stresses: str
    scene: rf.Scene
    M: int | tuple[int, int]
    options: Mapping[str, Any] = field(default_factory=dict)

    @cached_property
    def dense(self) -> rf.Solution:
        """The plain reference's solution."""
        return rf.solve(self.scene, self.M, method="dense", tolerance=TOLERANCE, **self.options)

    @cached_property
    def fft(self) -> rf.Solution:
        """The production solver's solution."""
        return rf.solve(self.scene, self.M, method="fft", tolerance=TOLERANCE, **self.options)


TOLERANCE = 1e-12
"""Tolerance of both solvers: a thousandth of the limit of their difference, and above rounding."""


def pressed(
    *,
    upper: rf.Material = STEEL,
    lower: rf.Material = COPPER,
    radius: float | None = 0.14,
    rms: float | None = 0.504e-6,
    seed: int = 2,
    correlation_length: float = 104e-6,
    friction: rf.Friction = TABLE1,
    load: float = 70.0,
    side: float = 1.61e-3,
    size: tuple[float, float] | None = None,
    direction: float = 0.0,
    offset: float = 0.0,
    periodic: bool = False,
) -> rf.Scene:
    """Return Table 1's sphere on a rough flat with changes; no ``radius`` or ``rms`` means flat or smooth."""
    return rf.Scene(
        upper=rf.Body(upper, rf.Flat() if radius is None else rf.Sphere(radius)),
        lower=rf.Body(
            lower, rf.Flat() if rms is None else rf.GaussianRoughness(rms, correlation_length, seed)
        ),
        friction=friction,
        load=load,
        side=side if size is None else None,
        size=size,
        sliding_direction=direction,
        sliding_offset=offset,
        periodic=periodic,
    )


def cross_checks() -> tuple[Trial, ...]:
    """Return the scenes, unsolved; a `Trial` solves itself on first use."""
    incompressible = pressed(upper=rf.Material(70e9, 0.5), lower=rf.Material(3e9, 0.1), load=8.0)
    soft_ball = pressed(upper=POLYMER, lower=STEEL, radius=0.05, rms=0.8e-6, seed=3, load=5.0, side=2e-3)
    rough_planes = rf.read_scene("rough-planes")
    plastic = rf.Friction(tau=0.35e6, beta=0.12)
    plane = pressed(radius=None, rms=0.05e-6, lower=POLYMER, side=1e-3, load=20.0, friction=plastic)
    strong = rf.Friction(tau=60e6, beta=0.3)
    return (
        Trial("smooth", "Table 1 without roughness", rf.read_scene("table1-smooth"), 32),
        Trial("rough", "Table 1 with both roughnesses", rf.read_scene("table1-rough"), 48),
        Trial("frictionless", "no shear at all", rf.read_scene("hertz"), 30),
        Trial("direction-0.7", "sliding askew of the grid", pressed(direction=0.7), 40),
        Trial("direction-2.0", "sliding askew, backwards", pressed(direction=2.0, rms=0.9e-6), 31),
        Trial("nu-0.5-on-0.1", "c of one body is zero", incompressible, 33),
        Trial("identical", "c cancels", pressed(upper=COPPER, friction=strong), 24),
        Trial("metal-polymer", "strong coupling", rf.read_scene("metal-polymer"), 40),
        Trial("soft-ball", "coupling of the other sign", soft_ball, 29),
        Trial("near-full", "rough plane pressed nearly flat", replace(plane, load=7.0), 20),
        Trial("full", "rough plane pressed flat", plane, 20),
        Trial("near-full-periodic", "periodic plane pressed nearly flat",
              replace(plane, load=3.2, periodic=True), 32),
        Trial("full-periodic", "full contact: a mean pressure displaces nothing",
              replace(plane, load=7.0, periodic=True), 21),
        Trial("single-point", "one element in contact", pressed(rms=2e-6, load=1e-4), 17),
        Trial("strong-tau", "alternating edge", pressed(lower=POLYMER, load=30.0, friction=strong), 23),
        Trial("large-tau-periodic", "tau as large as the pressure, periodic",
              replace(rough_planes, load=400.0, friction=rf.Friction(tau=400e6, beta=0.3)), 24),
        Trial("tau-only", "adhesion without a Coulomb part", pressed(friction=rf.Friction(tau=15e6)), 26),
        Trial("slope-correction", "exact facet tractions",
              pressed(direction=0.7, rms=1.68e-6, lower=POLYMER), 32, {"slope_correction": True}),
        Trial("periodic", "rough planes", rough_planes, 32),
        Trial("periodic-askew", "odd grid, sliding askew", replace(rough_planes, sliding_direction=2.0), 31),
        Trial("approach", "prescribed approach", pressed(), 32, {"approach": 1.5e-6}),
        Trial("approach-periodic", "prescribed approach from the mean planes",
              rough_planes, 27, {"approach": -0.9e-6}),
        Trial("flat-slopes", "every slope term forced out", pressed(rms=1.68e-6), 31, {"oblique": False}),
        Trial("slid", "the lower body sampled half a wave on", pressed(offset=50e-6, direction=0.7), 28),
        Trial("smallest", "sixteen elements a side", pressed(), 16),
    )  # fmt: skip
