"""One finite element solution: displacements at the centres of the loaded element and its neighbours."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from appendix_a.fem3d.elasticity import Operator, mapped, patch_load, stiffness
from appendix_a.fem3d.mesh import block
from appendix_a.fem3d.patch import far_field
from appendix_a.fem3d.solver import LinearSolution, solve
from appendix_a.fem3d.space import Space, space
from appendix_a.fem3d.wavy import Kind, Waviness

Array = NDArray[np.float64]

STEPS = (2.0, 4.0, 6.0)  # centres of the first three neighbours, in a
X = np.array([0.0, *STEPS, *(-s for s in STEPS), 0.0, 0.0, 0.0])
Y = np.array([0.0] * 7 + [*STEPS])


@dataclass(frozen=True)
class Sample:
    """Downward displacements (10,) at (X, Y): self, +x 1-3, -x 1-3, across 1-3; p = E = a = 1."""

    down: Array
    elements: int
    iterations: int
    residual: float


def solved(
    surface: Waviness, nu: float, radius: float, level: int, edges: tuple[float, float] = (-1.0, 1.0)
) -> tuple[Space, LinearSolution]:
    """Solve on one mesh, with the flat half-space's displacements on the outer boundary."""
    waves_across = surface.kind is Kind.EGG_BOX
    body = space(block(radius, surface.wavelength, level, waves_across=waves_across, edges=edges))
    held = outer_displacements(body, surface, nu, edges)
    operator = Operator(stiffness(body, surface, nu), body)
    return body, solve(operator, nu, patch_load(body, surface, edges), held)


def sample(
    surface: Waviness, nu: float, radius: float, level: int, edges: tuple[float, float] = (-1.0, 1.0)
) -> Sample:
    """Return displacements of `solved` at the centres of the loaded element and of its neighbours."""
    body, solution = solved(surface, nu, radius, level, edges)
    top = solution.field[2, :, :, -1]
    i, j = np.searchsorted(body.axes[0], X - 1e-9), np.searchsorted(body.axes[1], Y - 1e-9)
    return Sample(-top[i, j], body.element_nodes.shape[0], solution.iterations, solution.residual)


@cache
def flat_sample(wavelength: float, kind: Kind, nu: float, radius: float, level: int) -> Sample:
    """Return displacements on the flat surface, on the mesh that this waviness would have."""
    return sample(Waviness(0.0, wavelength, 0.0, kind), nu, radius, level)


def outer_displacements(body: Space, surface: Waviness, nu: float, edges: tuple[float, float]) -> Array:
    """Return the held displacements (3, nx, ny, nz): a flat half-space z < 0 under the element's tractions.

    4 x 4 Gauss point forces stand for the patch: at the boundary's 24 a or more they differ from it by
    less than 1e-12. The tractions along y cancel in pairs and are neglected.
    """
    nodes, weights = np.polynomial.legendre.leggauss(4)
    half, middle = 0.5 * (edges[1] - edges[0]), 0.5 * (edges[1] + edges[0])
    x, y = (c.ravel() for c in np.meshgrid(middle + half * nodes, nodes, indexing="ij"))
    area = half * np.outer(weights, weights).ravel()
    forces = np.stack([area * surface.gradient(x, y)[0], area], axis=1)
    outer = body.outer_boundary().ravel()
    held = np.zeros((3, body.nodes))
    points = mapped(surface, body.points()[:, outer])
    held[:, outer] = far_field(points, forces, np.stack([x, y], axis=1), nu)
    return held.reshape(3, *body.shape)
