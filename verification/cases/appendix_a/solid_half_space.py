"""Pairs of asperities in three dimensions: by finite elements, as a scene, and the half-space's stated error.

Bumps amplitude (cos k x + cos k y) whose crests lie a shift apart. Six to ten elements across the contact, so
both sides are taken relative to themselves at a vanishing slope. The area, by whole nodes, is not judged.
"""

from __future__ import annotations

import numpy as np

import refimpl as rf
from appendix_a.contact_fem.scene import WAVENUMBER, Material, WavyPair
from appendix_a.contact_fem.solid import asperity
from appendix_a.contact_fem.solid_contact import press
from refimpl.sensitivities.half_space import HalfSpaceError, half_space_error
from verification.cases.appendix_a.undeformed_study import Judged

BETA, SHARE, SLIGHT = 0.08, 0.05, 0.1
ELEMENTS, M = 4, 64
COPPER, STEEL = Material(118e9, 0.3), Material(200e9, 0.3)
SOFT, RIGID = Material(1e9, 0.0), Material(1e13, 0.0)
SCENES = (  # lower, upper, shift, steepest slope (degrees)
    (COPPER, STEEL, 0.0, 6.5),
    (COPPER, STEEL, -0.2, 12.0),
    (SOFT, RIGID, 0.0, 4.0),
    (SOFT, RIGID, 0.0, 12.0),
    (SOFT, RIGID, -0.2, 8.0),
    (COPPER, STEEL, 0.0, 18.0),
)


def distance_of(pair: WavyPair) -> float:
    """Return the mean planes' distance at first contact."""
    return pair.gap_amplitude + 2 * pair.amplitude


def by_elements(pair: WavyPair, elements: int) -> tuple[float, float]:
    """Return (approach / amplitude, mu) by finite elements."""
    crest = -pair.shift / 2
    lower = asperity(pair.amplitude, crest, pair.lower.nu, elements).of_modulus(pair.lower.E)
    upper = asperity(pair.amplitude, crest, pair.upper.nu, elements).mirrored().of_modulus(pair.upper.E)
    found = press(lower, upper, distance_of(pair), SHARE * pair.full_contact_pressure, pair.beta)
    return found.approach / pair.amplitude, found.friction_coefficient


def scene_of(pair: WavyPair, M: int) -> rf.Scene:
    """Return the pair on M x M elements of one wavelength, under `SHARE` of p*."""
    x = (np.arange(M) + 0.5) / M - 0.5
    lower, upper = (
        pair.amplitude * np.add.outer(np.cos(WAVENUMBER * (x - crest)), np.cos(WAVENUMBER * x))
        for crest in (-pair.shift / 2, pair.shift / 2)
    )
    above, below = (
        rf.Body(rf.Material(body.E, body.nu), z) for body, z in ((pair.upper, -upper), (pair.lower, lower))
    )
    load = SHARE * pair.full_contact_pressure
    return rf.Scene(above, below, rf.Friction(beta=pair.beta), load, side=1.0, periodic=True)


def by_model(pair: WavyPair) -> tuple[rf.Solution, HalfSpaceError, float]:
    """Return the solution, its error and its approach from first contact over the amplitude."""
    scene = scene_of(pair, M)
    solution = rf.solve(scene, M, tolerance=1e-6)
    first = (solution.approach + solution.details.problem.datum) / pair.amplitude
    return solution, half_space_error(scene, solution), first


def judged(lower: Material, upper: Material, shift: float, slope_deg: float) -> Judged:
    """Solve one pair of asperities."""
    steep, slight = (WavyPair(s, shift, lower, upper, beta=BETA) for s in (slope_deg, SLIGHT))
    approach, mu = np.array(by_elements(steep, ELEMENTS)) / np.array(by_elements(slight, ELEMENTS))
    (solution, error, first), (plain, _, flat) = by_model(steep), by_model(slight)
    datum = solution.details.problem.datum
    asked = approach * flat * steep.amplitude - datum
    at = rf.solve(scene_of(steep, M), M, tolerance=1e-6, approach=asked)
    load = solution.details.problem.load or 0.0
    model_mu = solution.friction_coefficient / plain.friction_coefficient
    true = {
        "approach": approach * flat / first - 1,
        "normal_force": load / at.normal_force - 1,
        "friction_coefficient": mu / model_mu - 1,
    }
    size = {"approach": first * steep.amplitude, "normal_force": load}
    size["friction_coefficient"] = solution.friction_coefficient
    stated = {name: error.stated(name) / size[name] for name in true}
    warned = any(getattr(w, "limit", None) == "half-space" for w in solution.warnings)
    return Judged(true, stated, warned)
