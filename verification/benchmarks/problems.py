"""Problems of the benchmark: Table 1's paraboloid on a smooth and on a rough flat, in free space."""

from __future__ import annotations

from functools import cache

import refimpl as rf
from refimpl.grid import Array, Grid
from refimpl.model.materials import Pair
from verification.solver_suite.protocol import ContactProblem

SIDE = 1.61e-3  # m
LOAD = 70.0  # N
STEEL, COPPER = rf.Material(E=200e9, nu=0.30), rf.Material(E=118e9, nu=0.30)
FRICTION = rf.Friction(tau=15e6, beta=0.08)
SPHERE = rf.Sphere(radius=0.14)
FLATS: dict[str, rf.Surface] = {
    "smooth": rf.Flat(),
    "rough": rf.GaussianRoughness(rms=0.5e-6, correlation_length=104e-6, seed=1),
}


@cache
def heights(kind: str, M: int) -> tuple[Array, Array]:
    """Return the heights of flat and paraboloid at the element centres, each ``(M, M)`` (m)."""
    grid = Grid.square(SIDE, M)
    return FLATS[kind].heights(grid), SPHERE.heights(grid)


def problem(kind: str, M: int, tolerance: float) -> ContactProblem:
    """Return the frictionless problem, as every code gets it."""
    lower, upper = heights(kind, M)
    gap = upper - lower
    modulus = Pair(lower=COPPER, upper=STEEL).reduced_modulus
    return ContactProblem(gap - gap.min(), SIDE / M, modulus, load=LOAD, tolerance=tolerance)


def scene(kind: str, M: int, friction: rf.Friction) -> rf.Scene:
    """Return the contact as a scene, with friction or without."""
    lower, upper = heights(kind, M)
    return rf.Scene(
        upper=rf.Body(STEEL, upper),
        lower=rf.Body(COPPER, lower),
        friction=friction,
        load=LOAD,
        side=SIDE,
    )
