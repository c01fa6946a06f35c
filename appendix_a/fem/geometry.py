"""Rough boundaries and the bending of a reference half-plane onto them.

A `Boundary` is a profile y = s(x), y into the body, with the pressed strip's ends on it.  `bend` moves a
reference mesh: (xi, eta) -> (x(xi), eta + s(x) exp(-eta / depth)), with x(+-1) the strip's ends.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq
from skfem import MeshTri, MeshTri2

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Boundary:
    """Profile y = height(x), the strip's ends on it, and the depth over which a mesh forgets it.

    Lengths in units of the strip's half-width along the surface; `height(0) = 0` at the strip's centre.
    """

    height: Callable[[Array], Array]
    left: float
    right: float
    depth: float


def strip_end(slope: Callable[[Array], Array], direction: int) -> float:
    """Return the abscissa at arc length 1 from x = 0 along `direction`, for dy/dx = slope(x)."""
    nodes, weights = np.polynomial.legendre.leggauss(40)  # to rounding: the profile is smooth over 1

    def excess(x: float) -> float:
        return float(x / 2 * weights @ np.hypot(1.0, slope(x / 2 * (1.0 + nodes)))) * direction - 1.0

    return float(brentq(excess, 0.0, 1.001 * direction, xtol=1e-15, rtol=1e-14))


def flat() -> Boundary:
    """Return the half-plane itself."""
    return Boundary(height=np.zeros_like, left=-1.0, right=1.0, depth=1.0)


def sinusoid_boundary(slope_deg: float, wavelength: float, position: float, reach: float) -> Boundary:
    """Return the profile (A2), y = 2 h_a sin^2(pi x / lambda), about position * lambda, to `reach`.

    The slope's maximum is 2 pi h_a / lambda = tan(slope_deg).  Between reach / 2 and reach the waves fade
    to their mean level: beyond, the boundary is flat and the far field of a half-plane is exact to the
    leading order in 1 / radius.  What the fading costs is measured by changing `reach`.
    """
    amplitude = math.tan(math.radians(slope_deg)) * wavelength / (2 * math.pi)
    wavenumber, phase = 2 * math.pi / wavelength, 2 * math.pi * position

    def height(x: Array) -> Array:
        fade = _smooth_step(2.0 - 2.0 * np.abs(x) / reach)
        return amplitude * (math.cos(phase) - fade * np.cos(wavenumber * x + phase))

    def slope(x: Array) -> Array:
        return amplitude * wavenumber * np.sin(wavenumber * x + phase)

    return Boundary(height, strip_end(slope, -1), strip_end(slope, +1), depth=0.5 * wavelength)


def ridge_boundary(slope_deg: float, half_base: float) -> Boundary:
    """Return a wedge tip at x = 0 with faces at `slope_deg`, on a flat half-plane beyond |x| = half_base."""
    tangent, end = math.tan(math.radians(slope_deg)), math.cos(math.radians(slope_deg))

    def height(x: Array) -> Array:
        return tangent * np.minimum(np.abs(x), half_base)

    return Boundary(height, -end, end, depth=half_base)


def cap_boundary(slope_deg: float, half_base: float) -> Boundary:
    """Return a parabolic cap, of `slope_deg` at its rim |x| = half_base, on a flat body."""
    curvature = math.tan(math.radians(slope_deg)) / half_base

    def height(x: Array) -> Array:
        return curvature / 2 * np.minimum(np.abs(x), half_base) ** 2

    end = strip_end(lambda x: curvature * x, +1)
    return Boundary(height, -end, end, depth=half_base)


def _smooth_step(t: Array) -> Array:
    """Return 0 for t <= 0, 1 for t >= 1, twice continuously differentiable between."""
    t = np.clip(t, 0.0, 1.0)
    return t**3 * (10.0 - 15.0 * t + 6.0 * t**2)


def bend(mesh: MeshTri, boundary: Boundary) -> MeshTri2:
    """Return the reference mesh on the boundary's body: quadratic sides, nodes on the profile."""
    curved = MeshTri2.from_mesh(mesh)
    xi, eta = curved.doflocs
    # linear between vertices of the mesh: +-1 to the strip's ends, beyond +-4 nothing moves
    x = np.interp(xi, [-4.0, -1.0, 1.0, 4.0], [-4.0, boundary.left, boundary.right, 4.0])
    x = np.where(np.abs(xi) > 4.0, xi, x)
    y = eta + boundary.height(x) * np.exp(-eta / boundary.depth)
    return MeshTri2(np.array([x, y]), curved.t)
