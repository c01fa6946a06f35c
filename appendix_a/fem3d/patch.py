"""Exact displacements of a flat half-space under a uniformly loaded rectangle (Love 1929; Johnson 1985, 3.2).

Axes: x, y in the surface, z upwards, body z <= 0. E = 1, unit traction, lengths in a; the loaded rectangle is
centred at the origin and square with half-edge 1 unless stated otherwise.
"""

from __future__ import annotations

from math import cos, pi, radians, sin, tan

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Size = float | Array


def normal_integral(x: Array, y: Array, half_x: Size = 1.0, half_y: Size = 1.0) -> Array:
    """Return the integral of 1/rho over rectangles: X asinh(Y/|X|) + Y asinh(X/|Y|) at corners.

    >>> float(normal_integral(np.zeros(1), np.zeros(1))[0] / np.arcsinh(1.0))
    8.0
    """
    total = np.zeros_like(x)
    for sx in (-1.0, 1.0):
        for sy in (-1.0, 1.0):
            u, v = x + sx * half_x, y + sy * half_y
            total += sx * sy * (_times_asinh(u, v) + _times_asinh(v, u))
    return total


def _times_asinh(u: Array, v: Array) -> Array:
    """Return u asinh(v / |u|), zero at u = 0."""
    return np.where(u == 0, 0.0, u * np.arcsinh(v / np.where(u == 0, 1.0, np.abs(u))))


def tangential_integral(x: Array, y: Array, half_x: float = 1.0, half_y: float = 1.0) -> Array:
    """Return the integral of (x - x') / rho^2: Y ln(rho) + X atan(Y/X) at the rectangle's corners."""
    total = np.zeros_like(x)
    for sx in (-1.0, 1.0):
        for sy in (-1.0, 1.0):
            u, v = x + sx * half_x, y + sy * half_y
            squared = u * u + v * v
            angle = np.where(u == 0, 0.0, np.arctan(v / np.where(u == 0, 1.0, u)))
            total += sx * sy * (0.5 * v * np.log(np.where(squared == 0, 1.0, squared)) + u * angle)
    return total


def normal_coefficient(x: Array, y: Array, nu: float, half_x: float = 1.0, half_y: float = 1.0) -> Array:
    """Return a: displacement of the surface into the body under unit pressure on the rectangle."""
    return (1 - nu * nu) / pi * normal_integral(x, y, half_x, half_y)


def tangential_coefficient(x: Array, y: Array, nu: float, half_x: float = 1.0, half_y: float = 1.0) -> Array:
    """Return c: displacement of the surface into the body under unit traction along +x on the rectangle."""
    return (1 + nu) * (1 - 2 * nu) / (2 * pi) * tangential_integral(x, y, half_x, half_y)


def tilted_plane(x: Array, y: Array, nu: float, slope_deg: float, *, projected: bool) -> Array:
    """Return the exact downward displacement on a plane of `slope_deg`, +x downhill.

    The flat solution in the plane's own frame: offsets along it are x / cos, the loaded rectangle is 2 /
    cos long if its edge is 2 in projection and 2 if it is 2 along the facet, and down is cos times the
    normal part plus sin times the downhill part (a pressed surface moves towards the load, by c seen the
    other way round).
    """
    slope = radians(slope_deg)
    along, half = x / cos(slope), 1 / cos(slope) if projected else 1.0
    downhill = -tangential_coefficient(along, y, nu, half)
    return cos(slope) * normal_coefficient(along, y, nu, half) + sin(slope) * downhill


def facet_prediction(x: Array, y: Array, nu: float, slope_deg: float) -> Array:
    """Return [a] f + [c_s] f tan(theta): a flat half-space under the tractions of a facet, +x downhill."""
    return normal_coefficient(x, y, nu) - tan(radians(slope_deg)) * tangential_coefficient(x, y, nu)


def boussinesq(x: Array, y: Array, z: Array, nu: float) -> Array:
    """Return displacements (3, ...) of a unit force pressing down at the origin (Johnson 1985, 3.18)."""
    depth, rho = -z, np.sqrt(x * x + y * y + z * z)
    radial = depth / rho**3 - (1 - 2 * nu) / (rho * (rho + depth))
    down = depth * depth / rho**3 + 2 * (1 - nu) / rho
    return (1 + nu) / (2 * pi) * np.array([x * radial, y * radial, -down])


def cerruti(x: Array, y: Array, z: Array, nu: float) -> Array:
    """Return displacements (3, ...) of a unit force along +x at the origin (Johnson 1985, 3.75)."""
    depth, rho = -z, np.sqrt(x * x + y * y + z * z)
    s = rho + depth
    along = 1 / rho + x * x / rho**3 + (1 - 2 * nu) * (1 / s - x * x / (rho * s * s))
    across = x * y / rho**3 - (1 - 2 * nu) * x * y / (rho * s * s)
    down = x * depth / rho**3 + (1 - 2 * nu) * x / (rho * s)
    return (1 + nu) / (2 * pi) * np.array([along, across, -down])


def far_field(points: Array, forces: Array, sources: Array, nu: float) -> Array:
    """Return displacements (3, n) at `points` (3, n) of forces (m, 2), along x and down, on z = 0."""
    total = np.zeros_like(points)
    for (along, down), (sx, sy) in zip(forces, sources, strict=True):
        x, y, z = points[0] - sx, points[1] - sy, points[2]
        total += down * boussinesq(x, y, z, nu) + along * cerruti(x, y, z, nu)
    return total
