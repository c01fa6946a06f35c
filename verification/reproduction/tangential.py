"""Tangential surface displacements of a solution, which the paper neglects, and what they do to the gap.

For a half-space under a traction q along s and a pressure p (Johnson 1985, Eqs 3.18-3.25 and 3.75-3.76; Love,
Cerruti), with G = E / 2(1 + nu) and rho the distance:

    u_s = 1/(2 pi G) [((1 - nu)/rho + nu s^2/rho^3) q] - (1 - 2 nu)/(4 pi G) [s/rho^2 p],
    u_t = 1/(2 pi G) [nu s t/rho^3 q]                  - (1 - 2 nu)/(4 pi G) [t/rho^2 p],

integrated over each element. The element integrals are second differences over its corners of

    1/rho: x log(y + rho) + y log(x + rho),   x^2/rho^3: y log(x + rho),   x y/rho^3: -rho,
    x/rho^2: y log(rho) + x atan(y/x).

They lose digits with the distance as n^2 eps: 1e-11 at the 256 elements used here.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from scipy.signal import fftconvolve

import refimpl as rf
from refimpl.grid import Array


def element_integrals(M: int, spacing: float) -> dict[str, Array]:
    """Return the integrals at all offsets -(M-1) ... M-1 of an M x M grid, shapes ``(2M - 1, 2M - 1)``."""
    corner = np.asarray((np.arange(2 * M) - M + 0.5) * spacing, dtype=np.float64)
    x: Array = corner[:, None]
    y: Array = corner[None, :]
    rho: Array = np.hypot(x, y)
    primitives = {
        "1/rho": x * _log_sum(y, x, rho) + y * _log_sum(x, y, rho),
        "x^2/rho^3": y * _log_sum(x, y, rho),
        "y^2/rho^3": x * _log_sum(y, x, rho),
        "xy/rho^3": -rho,
        "x/rho^2": y * np.log(rho) + x * np.arctan(y / x),
        "y/rho^2": x * np.log(rho) + y * np.arctan(x / y),
    }
    return {name: np.diff(np.diff(values, axis=0), axis=1) for name, values in primitives.items()}


def _log_sum(a: Array, b: Array, rho: Array) -> Array:
    """Return ``log(a + rho)``, free of cancellation for a < 0: ``a + rho = b^2 / (rho - a)``."""
    reach = np.abs(a) + rho
    return np.log(np.where(a < 0, b * b / reach, reach))


@dataclass(frozen=True)
class Tangential:
    """Displacements (m) ``[x and y][i, j]`` of the lower and the upper surface, about their means over the
    contact weighted by pressure (a rigid shift is sliding); ``gap_change`` (m) is what they do to the gap.
    """

    lower: Array
    upper: Array
    gap_change: Array


def displacements(scene: rf.Scene, found: rf.Solution) -> Tangential:
    """Return displacements by the solution's tractions; along x, ValueError otherwise.

    The deformed surface shows the height that was a displacement away: the gap changes by ``-u_upper . grad
    z_upper + u_lower . grad z_lower``.
    """
    if scene.sliding_direction != 0:
        raise ValueError("written for sliding along x")
    h = found.grid.spacings[0]
    kernels = element_integrals(found.grid.shape[0], h)
    lower = _relative(_of_body(scene.lower.material, kernels, found.pressure, found.traction), found)
    upper = _relative(_of_body(scene.upper.material, kernels, found.pressure, -found.traction), found)
    z_lower, z_upper = scene.heights(found.grid)
    change = np.zeros_like(z_lower)
    for u, z, sign in ((lower, z_lower, 1.0), (upper, z_upper, -1.0)):
        change += sign * (u[0] * np.gradient(z, h, axis=0) + u[1] * np.gradient(z, h, axis=1))
    return Tangential(lower, upper, change)


def _of_body(material: rf.Material, kernels: dict[str, Array], pressure: Array, traction: Array) -> Array:
    nu, G = material.nu, material.E / (2 * (1 + material.nu))
    radial = (1 - 2 * nu) / 2

    def by(kernel: Array, load: Array) -> Array:
        return np.asarray(fftconvolve(kernel, load, mode="valid"))

    along = (1 - nu) * kernels["1/rho"] + nu * kernels["x^2/rho^3"]
    u_x = by(along, traction) - radial * by(kernels["x/rho^2"], pressure)
    u_y = nu * by(kernels["xy/rho^3"], traction) - radial * by(kernels["y/rho^2"], pressure)
    return np.array([u_x, u_y]) / (2 * math.pi * G)


def _relative(u: Array, found: rf.Solution) -> Array:
    weight = found.pressure / found.pressure.sum()
    return np.asarray(u - np.sum(u * weight, axis=(1, 2), keepdims=True))


def with_tangential(scene: rf.Scene, found: rf.Solution) -> rf.Scene:
    """Return the scene with the solution's tangential displacements worked into both undeformed surfaces."""
    moved = displacements(scene, found)
    h = found.grid.spacings[0]
    bodies = []
    heights = scene.heights(found.grid)
    for body, u, z in ((scene.lower, moved.lower, heights[0]), (scene.upper, moved.upper, heights[1])):
        shifted = z - u[0] * np.gradient(z, h, axis=0) - u[1] * np.gradient(z, h, axis=1)
        bodies.append(rf.Body(body.material, rf.ArraySurface(shifted)))
    return replace(scene, lower=bodies[0], upper=bodies[1])
