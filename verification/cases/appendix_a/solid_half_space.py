"""The half-space's stated error against finite elements in three dimensions.

As in `model_form_3d`, both sides are taken relative to themselves at a vanishing slope, on the same mesh or
grid: meshes put eight elements across the contact. The area, by whole nodes, is not judged.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

import refimpl as rf
from appendix_a.contact_fem.scene import WAVENUMBER, Material, WavyPair
from appendix_a.contact_fem.solid import asperity
from appendix_a.contact_fem.solid_contact import press
from refimpl.sensitivities.half_space import HalfSpaceError, half_space_error

BETA, SHARE, SLIGHT = 0.08, 0.05, 0.1
MESHES, M = (3, 4), 64
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


@dataclass(frozen=True)
class SolidJudged:
    """True and stated relative errors of approach, N and mu, and the finite elements' own."""

    true: dict[str, float]
    stated: dict[str, float]
    fem: dict[str, float]
    warned: bool


def _by_elements(pair: WavyPair, elements: int) -> tuple[float, float]:
    """(approach / amplitude, mu)."""
    crest = -pair.shift / 2
    lower = asperity(pair.amplitude, crest, pair.lower.nu, elements).of_modulus(pair.lower.E)
    upper = asperity(pair.amplitude, crest, pair.upper.nu, elements).mirrored().of_modulus(pair.upper.E)
    distance = pair.gap_amplitude + 2 * pair.amplitude
    found = press(lower, upper, distance, SHARE * pair.full_contact_pressure, pair.beta)
    return found.approach / pair.amplitude, found.friction_coefficient


@lru_cache(maxsize=16)
def _scene(pair: WavyPair) -> rf.Scene:
    x = (np.arange(M) + 0.5) / M - 0.5
    lower, upper = (
        pair.amplitude * np.add.outer(np.cos(WAVENUMBER * (x - crest)), np.cos(WAVENUMBER * x))
        for crest in (-pair.shift / 2, pair.shift / 2)
    )
    return rf.Scene(
        upper=rf.Body(rf.Material(pair.upper.E, pair.upper.nu), -upper),
        lower=rf.Body(rf.Material(pair.lower.E, pair.lower.nu), lower),
        friction=rf.Friction(beta=pair.beta),
        load=SHARE * pair.full_contact_pressure,
        side=1.0,
        periodic=True,
    )


def _by_model(pair: WavyPair) -> tuple[rf.Solution, HalfSpaceError, float]:
    """Solution, its error and its approach from first contact over the amplitude."""
    scene = _scene(pair)
    solution = rf.solve(scene, M, tolerance=1e-6)
    first = (solution.approach + solution.problem.datum) / pair.amplitude
    return solution, half_space_error(scene, solution), first


def judged(lower: Material, upper: Material, shift: float, slope_deg: float) -> SolidJudged:
    """One pair of asperities."""
    steep, slight = (WavyPair(s, shift, lower, upper, beta=BETA) for s in (slope_deg, SLIGHT))
    by_mesh = [np.array(_by_elements(steep, n)) / np.array(_by_elements(slight, n)) for n in MESHES]
    approach, mu = by_mesh[-1]
    spread = np.abs(by_mesh[-1] - by_mesh[0])
    (solution, error, first), (plain, _, flat) = _by_model(steep), _by_model(slight)
    datum = solution.problem.datum
    asked = approach * flat * steep.amplitude - datum
    at = rf.solve(_scene(steep), M, tolerance=1e-6, approach=asked)
    load = solution.problem.load or 0.0
    model_mu = solution.friction_coefficient / plain.friction_coefficient
    true = {
        "approach": approach * flat / first - 1,
        "normal_force": load / at.normal_force - 1,
        "friction_coefficient": mu / model_mu - 1,
    }
    size = {"approach": first * steep.amplitude, "normal_force": load}
    size["friction_coefficient"] = solution.friction_coefficient
    stated = {name: error.stated(name) / size[name] for name in true}
    fem = {"approach": float(spread[0] / approach), "friction_coefficient": float(spread[1] / mu)}
    fem["normal_force"] = 2 * fem["approach"]
    warned = any(getattr(w, "limit", None) == "half-space" for w in solution.warnings)
    return SolidJudged(true, stated, fem, warned)
