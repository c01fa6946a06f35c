"""The one-file reference: known answers, and the production solver on random scenes over all parameters."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import refimpl as rf
from refimpl import plain
from refimpl.grid import Shape
from refimpl.surfaces import ArraySurface

# Scenes of 300 compared: 297 agree. 272 is refused (approach of 1e-22 m); in 53, with facet tractions,
# production excludes two elements more (CYCLED); 291 (mu above 4) has two certified states.
RANDOM_SCENES = 40


@dataclass(frozen=True)
class Case:
    """Arguments of `plain.solve`."""

    heights: tuple[np.ndarray, np.ndarray]
    lengths: tuple[float, float]
    bodies: tuple[tuple[float, float], tuple[float, float]]
    tau: float
    beta: float
    options: dict[str, Any]

    def plain(self, **changes: Any) -> SimpleNamespace:
        return plain.solve(
            *self.heights, self.lengths, *self.bodies, self.tau, self.beta, **(self.options | changes)
        )

    def production(self, tolerance: float = 1e-11, **changes: Any) -> rf.Solution:
        chosen = self.options | changes
        hard = chosen["hardness"]
        ratio = {"lower": (1.0, 1.5), "upper": (1.5, 1.0), None: (1.0, 1.0)}[chosen["softer"]]
        lower, upper = (
            rf.Material(E, nu, hard * r if hard < math.inf else None)
            for (E, nu), r in zip(self.bodies, ratio, strict=True)
        )
        shape = self.heights[0].shape
        pixel = (self.lengths[0] / shape[0], self.lengths[1] / shape[1])
        z_lower, z_upper = (ArraySurface(z, pixel=pixel) for z in self.heights)
        scene = rf.Scene(
            upper=rf.Body(upper, z_upper),
            lower=rf.Body(lower, z_lower),
            friction=rf.Friction(tau=self.tau, beta=self.beta),
            load=chosen["load"] or 1.0,
            size=self.lengths,
            sliding_direction=chosen["direction"],
            periodic=chosen["periodic"],
        )
        return rf.solve(
            scene,
            shape,
            approach=chosen["approach"],
            oblique=chosen["slopes"],
            slope_correction=chosen["facets"],
            plastic=hard < math.inf,
            tolerance=tolerance,
        )


def rough(random: np.random.Generator, X: np.ndarray, Y: np.ndarray, rms: float) -> np.ndarray:
    """Sum of 24 waves of periods that fit into the domain, with random phases."""
    z = np.zeros_like(X)
    for a in range(-3, 4):
        for b in range(4):
            if a or b:
                phase = 2 * np.pi * (a * X + b * Y) + 6.28 * random.random()
                z += random.normal() * np.cos(phase) / (a * a + b * b)
    return z * rms / z.std()


def drawn(seed: int, shape: Shape | None = None) -> Case:
    """A scene drawn over all parameters: grid, elements, bodies, law, load or approach, direction, terms.

    In place of the grid drawn it may have another one.
    """
    random = np.random.default_rng(seed)
    mx = int(random.integers(4, 25))
    my = int(random.integers(4, 25)) if random.random() < 0.5 else mx
    mx, my = shape or (mx, my)
    dx = 1e-6 * 10 ** random.uniform(0, 1)
    dy = dx * random.uniform(0.4, 2.5) if random.random() < 0.4 else dx
    lengths = (mx * dx, my * dy)
    x, y = ((np.arange(m) + 0.5) / m - 0.5 for m in (mx, my))
    X, Y = np.meshgrid(x, y, indexing="ij")
    periodic, slope = random.random() < 0.25, 10 ** random.uniform(-3, -0.8)
    rms = slope * lengths[0] / 8
    z_lower, z_upper = rough(random, X, Y, rms), rough(random, X, Y, rms * random.random())
    if not periodic and random.random() < 0.6:
        curvature = slope / (2 * lengths[0] * random.uniform(0.3, 3))
        z_upper += curvature * ((X * lengths[0]) ** 2 + (Y * lengths[1]) ** 2) / 2
    bodies = [(10 ** random.uniform(8, 11.5), random.uniform(0, 0.49)) for _ in range(2)]
    if random.random() < 0.15:
        bodies[0] = (math.inf, 0.3)
    elif random.random() < 0.15:
        bodies[1] = bodies[0]
    stiffness = slope / sum((1 - nu**2) / E for E, nu in bodies)
    load = stiffness * lengths[0] * lengths[1] * 10 ** random.uniform(-3, 0.3)
    tau = stiffness * 10 ** random.uniform(-3, 0) if random.random() < 0.7 else 0.0
    beta = float(random.choice([0, 0.05, 0.2, 0.6]))
    slopes = bool(random.random() < 0.75)
    facets = slopes and bool(random.random() < 0.2)
    hardness = math.inf
    if not facets and random.random() < 0.35:
        hardness = max(stiffness * 10 ** random.uniform(-1.2, 0.3), 1.1 * load / (lengths[0] * lengths[1]))
    options = {
        "load": load,
        "approach": None,
        "direction": float(random.choice([0, 0.3, math.pi / 2, 2.0, -2.5])),
        "hardness": hardness,
        "softer": ["lower", "upper", None][random.integers(3)] if hardness < math.inf else None,
        "periodic": bool(periodic),
        "slopes": slopes,
        "facets": facets,
    }
    case = Case((z_lower, z_upper), lengths, (bodies[0], bodies[1]), tau, beta, options)
    if random.random() < 0.3:
        level = replace(case, tau=0.0, beta=0.0)
        depth = level.plain(slopes=False, facets=False, hardness=math.inf, softer=None).approach
        options |= {"load": None, "approach": depth * (1.1 if depth < 0 else 0.9)}
    return case


NARROW = [(60, 5), (24, 1), (2, 30)]
OTHER = [(seed, shape) for shape in (*NARROW, (48, 32)) for seed in (42, 48)]
"""On strips and rows, and with coarser grids: a periodic scene with facet tractions, and a free one."""


@pytest.mark.parametrize(("seed", "shape"), [*((seed, None) for seed in range(RANDOM_SCENES)), *OTHER])
def test_production_finds_the_same_state(seed: int, shape: Shape | None) -> None:
    case = drawn(seed, shape)
    expected, found = case.plain(), case.production()
    assert expected.ended == "converged"
    if not expected.pressure.any():
        assert found.status is rf.Status.NO_CONTACT
        return
    excluded = (expected.pressure > 0) & ~expected.active
    assert found.status is (rf.Status.CYCLED if case.tau and excluded.any() else rf.Status.CONVERGED)
    assert np.abs(found.pressure - expected.pressure).max() <= 1e-8 * expected.p_max
    assert np.array_equal(found.details.excluded & found.contact, excluded & (case.tau > 0))
    assert found.friction_coefficient == pytest.approx(expected.mu, abs=1e-8)
    assert found.binormal_force == pytest.approx(expected.transverse, abs=1e-8 * expected.normal)
    assert found.approach == pytest.approx(expected.approach, rel=1e-7)
    assert found.plastic_area == pytest.approx(expected.plastic_area, rel=1e-12)


def test_hertz() -> None:
    """A paraboloid on a flat: approach a^2/R, p_max 3P/(2 pi a^2); whole elements of a/6 leave per cents."""
    M, side, R, P, E, nu = 33, 1e-3, 0.02, 20.0, 200e9, 0.3
    x = (np.arange(M) + 0.5) * side / M - side / 2
    ball = (x[:, None] ** 2 + x[None, :] ** 2) / (2 * R)
    flat, bodies = np.zeros((M, M)), ((E, nu), (math.inf, nu))
    s = plain.solve(flat, ball, (side, side), *bodies, 0.0, 0.0, load=P, slopes=False)
    a = (3 * P * R * (1 - nu**2) / (4 * E)) ** (1 / 3)
    assert s.approach == pytest.approx(a**2 / R, rel=0.005)
    assert s.p_max == pytest.approx(1.5 * P / (math.pi * a**2), rel=0.005)
    assert s.normal == pytest.approx(P, rel=1e-12)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"load": None, "approach": None}, "expected one"),
        ({"load": 1.0, "approach": 1e-6}, "expected one"),
        ({"load": 2.0, "hardness": 1.0}, "load <= hardness"),
    ],
)
def test_refusals(change: dict[str, Any], words: str) -> None:
    z = np.zeros((2, 2))
    with pytest.raises(ValueError, match=words):
        plain.solve(z, z, (1.0, 1.0), (1e9, 0.3), (1e9, 0.3), 0.0, 0.0, **change)


def test_the_largest_grid() -> None:
    z = np.zeros((65, 64))
    with pytest.raises(ValueError, match="64 x 64 at most"):
        plain.solve(z, z, (1.0, 1.0), (1e9, 0.3), (1e9, 0.3), 0.0, 0.0, load=1.0)
