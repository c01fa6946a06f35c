"""Sliding over a surface with a lay: elastic friction over the direction."""

from __future__ import annotations

import math

import numpy as np

import refimpl as rf
from refimpl.grid import Grid
from verification.cases import Measured, case
from verification.exact.hertz import Sphere

STEEL = rf.Material(E=200e9, nu=0.3)
LAY = 0.5  # rad
WEAK_RMS = 4e-9  # m; the indentation is 1.2 um


def weak_forces(seed: int, direction: float) -> tuple[float, float]:
    """Return the friction force (N) of a ball on a weakly rough flat without friction, and its first order in
    the rms: ``int p dz/ds dA`` with Hertz' pressure p, s along the sliding direction."""
    ball = Sphere(load=70.0, radius=0.14, modulus=STEEL.E / (1 - STEEL.nu**2) / 2)
    a = ball.contact_radius
    side = 3 * a
    roughness = rf.GaussianRoughness(WEAK_RMS, (a, a / 4), seed, lay=LAY)
    bodies = rf.Body(STEEL, rf.Sphere(ball.radius)), rf.Body(STEEL, roughness)
    scene = rf.Scene(*bodies, rf.Friction(), ball.load, side, sliding_direction=direction)
    solution = rf.solve(scene, grid=128)
    grid, step = Grid.square(side, 256), 1e-3 * a
    pressure = ball.pressure(np.hypot(grid.x[:, None] - side / 2, grid.y[None, :] - side / 2))
    shift = step * math.cos(direction), step * math.sin(direction)
    ahead, behind = (roughness.sample(grid, (sign * shift[0], sign * shift[1])) for sign in (1, -1))
    first_order = float((pressure * (ahead - behind)).sum()) * grid.element_area / (2 * step)
    return solution.friction_force, first_order


@case("reference/lay-elastic-friction", metric="at_most", tolerance=0.02)
def weak_lay() -> Measured:
    """Ball on a weakly rough lay: elastic friction over the direction.

    Claim: without friction the force along any direction is int p dz/ds dA with Hertz' pressure, to first
    order in the rms height: the work that the roughness does on the pressure
    Source: reciprocity; Johnson 1985, section 4.2; paper Eq. (9) with lx = 4 ly
    Tolerance: rms difference over the rms force, of four seeds in four directions; the next order in the rms,
    1.0 %, 2.2 % and 4.4 % for 4, 8 and 16 nm, and the sampling of Hertz' pressure; measured 1.3 %
    """
    directions = (0.0, LAY, 0.5 * math.pi, LAY + 0.5 * math.pi)
    forces = np.array([[weak_forces(seed, phi) for phi in directions] for seed in range(1, 5)])
    found, exact = forces[..., 0], forces[..., 1]
    off = math.sqrt(float(np.mean((found - exact) ** 2) / np.mean(exact**2)))
    return Measured(off)
