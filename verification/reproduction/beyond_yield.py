"""Section 8 with pressures capped at the hardness: friction and area over roughness, elastic and capped."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache
from typing import Literal

import numpy as np

import refimpl as rf
from refimpl.grid import Array
from refimpl.model.friction import friction_coefficient_at
from verification.framework.certified import certified
from verification.reproduction.ensemble import Estimate, estimate
from verification.reproduction.fig8 import plasticity
from verification.reproduction.printed import HARDNESS, LOADS, SPHERE_RMS, TABLE3
from verification.reproduction.table1 import SMOOTH, rough

Model = Literal["elastic", "capped", "flat"]
"""Elastic; capped at the hardness; capped without slope terms."""
MODELS: tuple[Model, ...] = ("elastic", "capped", "flat")

LOWEST = friction_coefficient_at(SMOOTH.friction, HARDNESS)
"""Eq. (11): ``tau / H + beta``."""
FLATS = {
    "quick": (0.252e-6, 0.504e-6, 1.008e-6, 1.680e-6),
    "full": (0.084e-6, 0.252e-6, 0.378e-6, 0.504e-6, 0.756e-6, 1.008e-6, 1.260e-6, 1.680e-6, 2.520e-6),
}
"""Roughnesses of the flat (m); the last one of the full tier is beyond the paper's range."""
MESH = {"quick": 128, "full": 256}
REALISATIONS = {"quick": 3, "full": 16}
CELL_MESH, CELL_REALISATIONS = {"quick": 128, "full": 512}, {"quick": 3, "full": 12}


@dataclass(frozen=True)
class Found:
    """Numbers of one solution; area in m^2, pressures in Pa."""

    friction: float
    area: float
    mean_pressure: float
    plastic_share: float


@dataclass(frozen=True)
class Point:
    """One roughness of the flat (m) under one load (N): the solutions of all realisations, by model."""

    load: float
    flat_rms: float
    found: dict[Model, tuple[Found, ...]]

    @property
    def rms(self) -> float:
        """sigma_e (m)."""
        return float(np.hypot(self.flat_rms, SPHERE_RMS))

    @property
    def psi(self) -> float:
        """Eq. (12) with the correlation length for its epsilon."""
        return float(plasticity(np.array([self.rms]))[0])

    def values(self, model: Model, name: str) -> Array:
        """Return a number of `Found` by realisation."""
        return np.array([getattr(one, name) for one in self.found[model]])

    def mean(self, model: Model, name: str) -> Estimate:
        """Return the mean over realisations, with its interval."""
        return estimate(self.values(model, name).tolist())

    @property
    def above_lowest(self) -> Array:
        """``mu / (tau / H + beta) - 1`` of the capped contact, by realisation."""
        return self.values("capped", "friction") / LOWEST - 1

    @property
    def slope_effect(self) -> Array:
        """Change of mu by slopes, relative, in capped contact, by realisation."""
        return self.values("capped", "friction") / self.values("flat", "friction") - 1

    def elastic_error(self, name: str) -> Estimate:
        """Return the elastic over capped number, less 1: mean over realisations, with its interval."""
        return estimate(list(self.values("elastic", name) / self.values("capped", name) - 1))


def hard(scene: rf.Scene) -> rf.Scene:
    """Return the scene with the hardness of section 8 on its lower body, the copper."""
    copper = replace(scene.lower.material, hardness=HARDNESS)
    return replace(scene, lower=rf.Body(copper, scene.lower.surface))


def solved(scene: rf.Scene, mesh: int, model: Model) -> Found:
    """Solve one realisation. Raises RuntimeError for a solution that is not converged."""
    oblique = False if model == "flat" else None
    s = certified(rf.solve(hard(scene), mesh, plastic=model != "elastic", oblique=oblique))
    mean = s.normal_force / s.contact_area
    return Found(s.friction_coefficient, s.contact_area, mean, s.plastic_share)


def point(load: float, flat_rms: float, mesh: int, realisations: int) -> Point:
    """Solve all realisations of one roughness under one load by all models."""
    scenes = [rough(flat_rms, SPHERE_RMS, k, load=load) for k in range(realisations)]
    return Point(load, flat_rms, {m: tuple(solved(s, mesh, m) for s in scenes) for m in MODELS})


@cache
def points(tier: str) -> tuple[Point, ...]:
    """Return the scenes of Fig. 8: loads and roughnesses, roughness by roughness under each load."""
    mesh, n = MESH[tier], REALISATIONS[tier]
    return tuple(point(load, flat, mesh, n) for load in LOADS for flat in FLATS[tier])


@cache
def cells(tier: str) -> tuple[Point, ...]:
    """Return the rough columns of Table 3."""
    mesh, n = CELL_MESH[tier], CELL_REALISATIONS[tier]
    return tuple(point(SMOOTH.load, printed.flat_rms, mesh, n) for printed in TABLE3[1:])


def crossing(found: Sequence[Point], values: Sequence[float], level: float) -> float:
    """Return psi from which a quantity that falls is below the level, between neighbours; NaN if it never is.

    >>> p = [Point(1.0, s * 1e-6, {}) for s in (0.5, 1.0)]
    >>> bool(p[0].psi < crossing(p, [0.3, 0.1], 0.2) < p[1].psi)
    True
    """
    psi, v = [p.psi for p in found], np.asarray(values)
    if v[-1] > level:
        return float("nan")
    return float(np.interp(-level, -v, psi))
