"""Rectangular scenes, with square and oblong elements, on which both solvers are compared."""

from __future__ import annotations

from dataclasses import replace

import refimpl as rf
from verification.scenes.cross_checks import COPPER, POLYMER, STEEL, Trial, pressed

SIDE = 1.61e-3


def rectangles() -> tuple[Trial, ...]:
    """Return the scenes, unsolved; a `Trial` solves itself on first use."""
    double, half = (2 * SIDE, SIDE), (SIDE, 0.5 * SIDE)
    soft = pressed(lower=POLYMER, rms=0.4e-6, load=2.0, size=(1.2 * SIDE, 0.8 * SIDE), direction=0.7)
    plane = pressed(
        radius=None, rms=0.05e-6, lower=POLYMER, size=(1e-3, 0.6e-3), friction=rf.Friction(0.35e6, 0.12)
    )
    repeated = replace(rf.read_scene("rough-planes"), side=None, size=(1e-3, 0.55e-3), load=30.0)
    strip = pressed(radius=None, rms=0.3e-6, size=(60e-5, 5e-5), correlation_length=60e-6, load=0.5)
    rigid = rf.Material(E=float("inf"), nu=0.3)
    return (
        Trial("wide", "twice as long as wide, square elements", pressed(size=double), (48, 24)),
        Trial("tall", "half as long, sliding askew", pressed(size=half[::-1], direction=0.7), (21, 42)),
        Trial("oblong", "square domain, elements 2 : 1", pressed(direction=2.0), (20, 40)),
        Trial("oblong-3", "elements 1 : 3, odd numbers", pressed(size=half, direction=0.7), (45, 15)),
        Trial("coupled", "strong coupling on oblong elements", soft, (36, 18)),
        Trial("rigid", "a rigid ball", pressed(upper=rigid, lower=POLYMER, load=2.0, size=half), (40, 20)),
        Trial("strip", "60 x 5 elements, sliding along", strip, (60, 5)),
        Trial("strip-across", "sliding across",
              replace(strip, sliding_direction=1.5707963267948966), (60, 5)),
        Trial("line", "one element wide", replace(strip, size=(60e-5, 1e-5), load=0.02), (60, 1)),
        Trial("near-full", "pressed nearly flat", replace(plane, load=5.0), (20, 24)),
        Trial("periodic", "rough planes, oblong elements", repeated, (40, 33)),
        Trial("periodic-askew", "sliding askew", replace(repeated, sliding_direction=2.0), (24, 36)),
        Trial("near-full-periodic", "periodic plane pressed nearly flat",
              replace(plane, load=1.9, periodic=True), (32, 16)),
        Trial("approach", "prescribed approach", pressed(size=double), (40, 30), {"approach": 1.5e-6}),
        Trial("approach-periodic", "approach from the mean planes",
              repeated, (27, 18), {"approach": -0.9e-6}),
        Trial("slope-correction", "exact facet tractions",
              pressed(direction=0.7, rms=1.68e-6, lower=POLYMER, load=5.0, size=double),
              (40, 18), {"slope_correction": True}),
        Trial("frictionless", "no shear at all",
              pressed(friction=rf.Friction(), size=half, upper=STEEL, lower=COPPER), (32, 36)),
        Trial("slid", "the lower body half a wave on",
              pressed(offset=50e-6, size=half, direction=0.7), (28, 20)),
    )  # fmt: skip
