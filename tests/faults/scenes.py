"""Scenes over all modes, their numbers by the one-page reference, and by whichever `refimpl` is imported."""

from __future__ import annotations

import json
import math
import sys
from typing import Any

import numpy as np

import refimpl as rf
from refimpl.surfaces import ArraySurface, Sphere
from tests.refimpl.test_plain import Case, drawn, rough

SEEDS = {
    "periodic": 16,
    "periodic approach": 64,
    "periodic facets": 42,
    "periodic strong coupling": 110,
    "periodic cap": 154,
    "cap of the upper body": 61,
    "cap of the lower body": 98,
    "cap at an approach": 129,
    "steep": 113,
    "facets": 131,
    "facets, oblique direction": 101,
    "cycled": 102,
    "cycled, large tau": 229,
    "cycled approach without slopes": 234,
    "approach": 221,
    "without slopes": 27,
}
"""Seeds of `drawn`."""

OFFSET = "sliding offset"
Record = dict[str, Any]


class Moved(Case):
    """A ball with waves on a ball that has slid, with nested grids and windows; sampled by hand."""

    offset, radius = 4e-6, 100e-6

    def production(self, tolerance: float = 1e-11, **changes: Any) -> rf.Solution:
        lower, upper = (rf.Material(E, nu) for E, nu in self.bodies)
        shape = self.heights[0].shape
        pixel = (self.lengths[0] / shape[0], self.lengths[1] / shape[1])
        scene = rf.Scene(
            upper=rf.Body(upper, Sphere(self.radius) + ArraySurface(self.waves(), pixel=pixel)),
            lower=rf.Body(lower, Sphere(-self.radius)),
            friction=rf.Friction(tau=self.tau, beta=self.beta),
            load=self.options["load"],
            size=self.lengths,
            sliding_direction=self.options["direction"],
            sliding_offset=self.offset,
        )
        return rf.solve(scene, shape, oblique=True, tolerance=tolerance)

    def waves(self) -> np.ndarray:
        """Heights of the upper body's waves (m)."""
        return rough(np.random.default_rng(7), *_unit_square(*self.heights[0].shape), 3e-8)


def _unit_square(mx: int, my: int) -> tuple[np.ndarray, np.ndarray]:
    x, y = ((np.arange(m) + 0.5) / m - 0.5 for m in (mx, my))
    return tuple(np.meshgrid(x, y, indexing="ij"))


def moved() -> Moved:
    """The scene with a sliding offset."""
    lengths, direction, R = (36e-6, 40e-6), 0.7, Moved.radius
    X, Y = (L * s for L, s in zip(lengths, _unit_square(36, 32), strict=True))
    x, y = X + Moved.offset * math.cos(direction), Y + Moved.offset * math.sin(direction)
    options = {"load": 0.02, "direction": direction}
    bodies = ((5e9, 0.2), (100e9, 0.4))
    flat = Moved((X * 0, X * 0), lengths, bodies, 1e8, 0.1, options)
    heights = -(x**2 + y**2) / (2 * R), (X**2 + Y**2) / (2 * R) + flat.waves()
    return Moved(heights, lengths, bodies, 1e8, 0.1, options)


def case(name: str) -> Case:
    """The scene of that name."""
    return moved() if name == OFFSET else drawn(SEEDS[name])


NAMES = (*SEEDS, OFFSET)


def expected(name: str) -> Record:
    """Numbers by the one-page reference, with the status that production should end with."""
    scene = case(name)
    s = scene.plain()
    assert s.ended == "converged"
    cycled = scene.tau > 0 and bool(((s.pressure > 0) & ~s.active).any())
    numbers = {key: getattr(s, key) for key in SCALES}
    return {"status": "cycled" if cycled else "converged"} | numbers


def found(name: str) -> Record:
    """Numbers by production."""
    try:
        s = case(name).production()
    except Exception as raised:  # whatever a fault makes of the solver
        return {"status": f"{type(raised).__name__}: {raised}"[:200]}
    return {
        "status": s.status.value,
        "pressure": s.pressure.tolist(),
        "traction": s.traction.tolist(),
        "mu": s.friction_coefficient,
        "normal": s.normal_force,
        "friction": s.friction_force,
        "transverse": s.binormal_force,
        "area": s.contact_area,
        "plastic_area": s.plastic_area,
        "approach": s.approach,
        "p_max": s.max_pressure,
    }


SCALES = {
    "pressure": "p_max",
    "traction": "p_max",
    "mu": "mu",
    "normal": "normal",
    "friction": "normal",
    "transverse": "normal",
    "area": "area",
    "plastic_area": "area",
    "approach": "approach",
    "p_max": "p_max",
}
"""Numbers compared, and what their differences are relative to."""


def difference(record: Record, reference: Record) -> tuple[float, str]:
    """Largest relative difference, and the number that has it; infinite if a number is missing or NaN."""
    if "mu" not in record:
        return math.inf, "status"
    largest, where = 0.0, ""
    for key, scale in SCALES.items():
        error = np.abs(np.subtract(record[key], reference[key])).max() / abs(reference[scale])
        error = float(error) if np.isfinite(error) else math.inf
        largest, where = max((largest, where), (error, key))
    return largest, where


if __name__ == "__main__":
    json.dump({name: found(name) for name in sys.argv[1:] or NAMES}, sys.stdout)
