"""The displacement of a rough boundary minus that of the flat one, both solved on one reference mesh.

Three devices make a small mesh accurate:

- the stresses of a plane body under given tractions do not depend on nu (Michell 1899), so
  2 mu u = kappa A + B with kappa = 3 - 4 nu and A, B free of nu: solves at two Poisson ratios give every
  other, 1/2 included, and nothing can lock;
- rough and flat boundary share the reference mesh; their difference is free of the error they share, and
  the exact flat solution is added back;
- far from the strip the roughness fades to a flat boundary, where Flamant's field is exact to leading order.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from skfem import MeshTri

from appendix_a.fem.elasticity import PlaneStrain
from appendix_a.fem.geometry import Boundary, bend, flat
from appendix_a.fem.halfplane import pressed_strip
from appendix_a.fem.mesh import Source, graded_mesh
from appendix_a.fem.result import WavyResult

Array = NDArray[np.float64]
SOLVED_NU = (0.0, 0.3)  # kappa = 3 and 1.8; nu = 1/2 (kappa = 1) is extrapolated with a gain of 7/3
# (cell size over distance to the next source, fans about centres); each level has about twice the unknowns
LEVELS = ((1.0, False), (1.0, True), (0.5, False), (0.5, True), (0.25, False), (0.25, True), (0.125, True))
ORDER = 3  # at equal error quadratics need five times the unknowns; the sides are quadratic


@dataclass(frozen=True)
class Setup:
    """Fine region of the coarsest mesh (sizes scale with the level), and the half-side of its outline."""

    sources: tuple[Source, ...]
    radius: float
    order: int = ORDER

    def mesh(self, level: int) -> MeshTri:
        """Return the reference mesh of LEVELS[level]."""
        return _mesh(self, level)


@lru_cache(maxsize=24)
def _mesh(setup: Setup, level: int) -> MeshTri:
    scale, centred = LEVELS[level]
    sources = [Source(s.left, s.right, scale * s.size, scale * s.growth) for s in setup.sources]
    return graded_mesh(sources, setup.radius, centred=centred)


def body_of(setup: Setup, level: int, boundary: Boundary) -> PlaneStrain:
    """Return the elastic body under `boundary` on the reference mesh of `level`."""
    mesh = setup.mesh(level)
    return PlaneStrain.on(mesh, bend(mesh, boundary), setup.order)


@lru_cache(maxsize=24)
def _flat_solves(setup: Setup, level: int) -> tuple[Array, tuple[Array, Array]]:
    """Return the nodal x of the flat body and its nodal u_y at both of SOLVED_NU."""
    body = body_of(setup, level, flat())
    return body.basis.doflocs[0], (body.displacements(SOLVED_NU[0])[1], body.displacements(SOLVED_NU[1])[1])


@dataclass(frozen=True)
class Departure:
    """u_y (m,), rough minus flat, for every nu, from the solves at SOLVED_NU; units of pressure a / E."""

    first: Array
    second: Array

    def at(self, nu: float) -> Array:
        """Return (1 + nu) times the line through the two solves' u / (1 + nu), which is linear in kappa."""
        share = (nu - SOLVED_NU[0]) / (SOLVED_NU[1] - SOLVED_NU[0])
        first, second = self.first / (1.0 + SOLVED_NU[0]), self.second / (1.0 + SOLVED_NU[1])
        return (1.0 + nu) * ((1.0 - share) * first + share * second)


@dataclass(frozen=True)
class Departures:
    """Rough minus flat displacement of one geometry, for every nu: three meshes, three outer radii."""

    offsets: Array
    meshes: tuple[Departure, ...]
    radii: tuple[Departure, ...]

    def result(self, nu: float) -> WavyResult:
        """Return the displacements at one Poisson ratio and their error."""
        meshes, radii = [d.at(nu) for d in self.meshes], [d.at(nu) for d in self.radii]
        return WavyResult.of(self.offsets, pressed_strip(self.offsets, nu), meshes, radii)


def departure(setup: Setup, level: int, boundary: Boundary, offsets: Array) -> Departure:
    """Return rough minus flat displacement at `offsets` (m,), each relative to its centre's.

    What is interpolated along the boundary is smooth: the two solves' difference at equal reference
    points, with the exact flat solution's share of their shift in x put right.
    """
    body = body_of(setup, level, boundary)
    flat_x, solved = _flat_solves(setup, level)
    x = body.basis.doflocs[0]
    points = np.append(offsets, 0.0)
    found = []
    for nu, flat_u in zip(SOLVED_NU, solved, strict=True):
        smooth = body.displacements(nu)[1] - flat_u + pressed_strip(flat_x, nu) - _own_strip(boundary, x, nu)
        u = body.surface_values(smooth, points) + _own_strip(boundary, points, nu)
        found.append(u[:-1] - u[-1] - pressed_strip(offsets, nu))
    return Departure(found[0], found[1])


def _own_strip(boundary: Boundary, x: Array, nu: float) -> Array:
    """Return the flat half-plane's displacement under a strip between the boundary's own strip ends."""
    middle, half = (boundary.right + boundary.left) / 2, (boundary.right - boundary.left) / 2
    return pressed_strip(x - middle, nu, half)
