"""Random roughness: Greenwood and Tripp's rough sphere, and the area-load line of a rough plane."""

from __future__ import annotations

import numpy as np

import refimpl as rf
from refimpl.grid import Array
from verification.cases import Measured, case
from verification.cases.contact.scenes import MODULUS, press
from verification.exact import greenwood_tripp, rough_plane
from verification.exact.greenwood_tripp import RoughSphere, gaussian_summits
from verification.solver_suite.gaps import centres, waves

STEEL, COPPER = rf.Material(E=200e9, nu=0.3), rf.Material(E=118e9, nu=0.3)
RADIUS, LOAD, SIDE = 0.14, 70.0, 2e-3
RMS, CORRELATION = 0.511e-6, 40e-6
SEEDS = tuple(range(8))
"""Drawn once; 0 to 7, not selected."""


@case("reference/greenwood-tripp-radius", metric="relative", tolerance=0.05)
def greenwood_tripp_radius() -> Measured:
    """Rough sphere: effective contact radius against Greenwood and Tripp.

    Claim: Averaged over realisations, a* = (3 pi/4) int r p dr / int p dr is the summit model's
    Source: Greenwood and Tripp 1967; Johnson 1985, section 13.5; summits by Nayak 1971
    Tolerance: three standard errors of eight realisations (1.5 % each); the model's own omission, elastic
    interaction of neighbouring summits, is not seen above that. Measured 0.8 %
    """
    # the paper's sphere and load on a flat of 0.511 um, with more summits than its correlation length gives
    modulus = 1 / ((1 - 0.3**2) / 200e9 + (1 - 0.3**2) / 118e9)
    sphere = RoughSphere(LOAD, RADIUS, modulus, *gaussian_summits(RMS, CORRELATION))
    model = greenwood_tripp.solve(sphere)
    M = 192
    r = np.hypot(*centres(SIDE, M))
    radii = []
    for seed in SEEDS:
        flat = rf.Body(COPPER, rf.GaussianRoughness(RMS, CORRELATION, seed))
        scene = rf.Scene(rf.Body(STEEL, rf.Sphere(RADIUS)), flat, rf.Friction(), LOAD, SIDE)
        p = rf.solve(scene, grid=M, oblique=False).pressure
        radii.append(3 * np.pi / 4 * np.sum(p) / np.sum(p / r))
    uncertainty = model.effective_radius * greenwood_tripp.UNCERTAINTY
    return Measured(float(np.mean(radii)), model.effective_radius, uncertainty, "m")


LOADS = (0.02, 0.04, 0.08)
"""Mean pressure over E* times rms gradient."""


def area_curves(M: int) -> Array:
    """Return five self-affine planes' perimeter-corrected contact fractions ``(seeds, loads)``."""
    curves = []
    for seed in range(5):
        heights = 1e-3 * waves(M, seed, longest=4, shortest=16)
        slope = rough_plane.spectral_rms_gradient(heights, 1.0)
        gap = heights.max() - heights

        def plane(x: Array, y: Array, gap: Array = gap) -> Array:
            return gap

        curve = [
            press(plane, 1.0, M, load=p * MODULUS * slope, periodic=True).contact_area_corrected
            for p in LOADS
        ]
        curves.append(curve)
    return np.asarray(curves)


@case("reference/rough-plane-slope", metric="absolute", tolerance=0.3)
def rough_plane_slope() -> Measured:
    """Rough plane: slope of the area-load line.

    Claim: kappa = (A/A0) E* h'/p at light load lies between Persson's 1.596 and Bush, Gibson and Thomas'
    2.507, in the 2.0 to 2.6 of simulations
    Source: Bush, Gibson and Thomas 1975; Persson 2001; Yastrebov, Anciaux and Molinari 2017
    Tolerance: the published range is 2.3 +- 0.3; standard error of five realisations 0.05, measured 2.2
    """
    curves = area_curves(192)
    kappa = np.mean(curves, axis=0) / np.asarray(LOADS)
    low, high = rough_plane.KAPPA_PUBLISHED
    data = {
        "p/(E* h')": list(LOADS),
        "A/A0": np.mean(curves, axis=0),
        "Persson": rough_plane.persson_area(LOADS),
    }
    return Measured(float(kappa[1]), (low + high) / 2, 0.0, "", data)
