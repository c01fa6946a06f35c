"""Theories of random rough planes beside the solver: Greenwood and Williamson's area, Persson's pressures.

Both are approximations, so the tolerances are the differences found: they guard against changes.
"""

from __future__ import annotations

import math

import numpy as np

import refimpl as rf
from verification.cases import Measured, case
from verification.exact import rough_plane
from verification.exact.greenwood_tripp import gaussian_summits

MODULUS = 1e9  # Pa, E* of a rigid flat on the rough body
RMS, CORRELATION, SIDE = 0.1e-6, 10e-6, 240e-6  # m
SEEDS = range(3)
"""Fixed beforehand; not selected."""


def pressed(reduced: float) -> list[rf.Solution]:
    """Return the surfaces' periodic contacts at a mean pressure over E* times the rms gradient."""
    flat, found = rf.Body(rf.Material(math.inf, 0.3), rf.Flat()), []
    for seed in SEEDS:
        rough = rf.GaussianRoughness(RMS, CORRELATION, seed)
        load = reduced * MODULUS * rough.rms_gradient * SIDE**2
        soft = rf.Body(rf.Material(MODULUS, 0.0), rough)
        scene = rf.Scene(flat, soft, rf.Friction(), load, SIDE, periodic=True)
        found.append(rf.solve(scene, grid=192, oblique=False))
    return found


@case("reference/greenwood-williamson-area", metric="relative", tolerance=0.12)
def greenwood_williamson_area() -> Measured:
    """Rough plane: area at a light load against Greenwood and Williamson.

    Claim: at a mean pressure of 0.02 E* h' the area is that of summits that do not interact
    Source: Greenwood and Williamson 1966; summits of Gaussian surfaces by Nayak 1971
    Tolerance: recorded: 8.6 % more than the theory, which neglects interaction and the spread of tip radii
    """
    gradient = rf.GaussianRoughness(RMS, CORRELATION, 1).rms_gradient
    summits = gaussian_summits(RMS, CORRELATION)
    theory = rough_plane.greenwood_williamson_area(np.array([0.02 * gradient]), *summits)
    area = np.mean([s.contact_area_corrected for s in pressed(0.02)]) / SIDE**2
    return Measured(float(area), float(theory[0]))


@case("reference/persson-pressures", metric="relative", tolerance=0.12)
def persson_pressures() -> Measured:
    """Rough plane: rms contact pressure against Persson's distribution.

    Claim: at a mean pressure of 0.2 E* h' the rms pressure is that of Persson's P(p)
    Source: Persson 2001; Manners and Greenwood 2006
    Tolerance: recorded: 6.4 % less than the theory, which is exact in full contact only
    """
    gradient = rf.GaussianRoughness(RMS, CORRELATION, 1).rms_gradient
    computed = np.mean([np.sqrt(np.mean(s.pressure**2)) for s in pressed(0.2)]) / (MODULUS * gradient)
    return Measured(float(computed), float(rough_plane.persson_rms_pressure([0.2])[0]))
