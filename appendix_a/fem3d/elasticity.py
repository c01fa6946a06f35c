"""Isotropic elasticity of a body mapped from a block onto the wavy surface, z = zeta + h(x, y) exp(zeta / l).

The map enters through the pulled-back gradient, so the surface is exact at the quadrature points, and the
mesh, its numbering and its one-dimensional factors stay those of the block. E = 1, lengths in a, pressure
1.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from skfem import Basis, LinearForm

from appendix_a.fem3d.space import Space
from appendix_a.fem3d.wavy import Waviness

Array = NDArray[np.float64]
Indices = NDArray[np.int64]


def lame_constants(nu: float) -> tuple[float, float]:
    """Return (lambda, mu) for E = 1."""
    return nu / ((1 + nu) * (1 - 2 * nu)), 0.5 / (1 + nu)


def depth_scale(surface: Waviness) -> float:
    """Return the depth l of the map's waviness; half a wave keeps |h| / l = tan(slope) / pi < 1."""
    return 0.5 * surface.wavelength


def mapped(surface: Waviness, points: Array) -> Array:
    """Return the body coordinates (3, n) of block points (3, n)."""
    x, y, zeta = points
    return np.array([x, y, zeta + surface.height(x, y) * np.exp(zeta / depth_scale(surface))])


def body_gradients(basis: Basis, surface: Waviness) -> tuple[Array, Array]:
    """Return gradients (3, elements, points, 27) of shape functions, weights (elements, points)."""
    x, y, zeta = np.asarray(basis.global_coordinates())
    decay = np.exp(zeta / depth_scale(surface))
    stretch = 1 + surface.height(x, y) * decay / depth_scale(surface)
    slope_x, slope_y = surface.gradient(x, y)
    grad = np.stack([shape[0].grad for shape in basis.basis], axis=-1)
    vertical = grad[2] / stretch[..., None]
    along = grad[0] - (slope_x * decay)[..., None] * vertical
    across = grad[1] - (slope_y * decay)[..., None] * vertical
    return np.stack([along, across, vertical]), basis.dx * stretch


def stiffness(space: Space, surface: Waviness, nu: float) -> Array:
    """Return the element matrices (elements, 81, 81); unknowns run component by component, 27 nodes each."""
    lame, shear = lame_constants(nu)
    count = space.element_nodes.shape[0]
    matrices, laplacians = np.empty((count, 3, 27, 3, 27)), np.zeros((count, 27, 27))
    for part, basis in space.tabulated():
        grad, weight = body_gradients(basis, surface)
        weighted = np.swapaxes(grad * weight[..., None], -1, -2)
        for i in range(3):
            for j in range(i, 3):
                # product[:, a, b] = integral of d_i phi_a d_j phi_b
                product = weighted[i] @ grad[j]
                swapped = np.swapaxes(product, -1, -2)
                matrices[part, i, :, j, :] = lame * product + shear * swapped
                matrices[part, j, :, i, :] = lame * swapped + shear * product
                if i == j:
                    laplacians[part] += shear * product
    for i in range(3):
        matrices[:, i, :, i, :] += laplacians
    return matrices.reshape(-1, 81, 81)


@dataclass(frozen=True)
class Operator:
    """The stiffness of the whole body, applied element by element to fields (3, nx, ny, nz)."""

    matrices: Array
    space: Space

    def __call__(self, field: Array) -> Array:
        nodes = self.space.element_nodes
        local = field.reshape(3, -1)[:, nodes].transpose(1, 0, 2).reshape(-1, 81, 1)
        forces = (self.matrices @ local).reshape(-1, 3, 27)
        total = [np.bincount(nodes.ravel(), forces[:, i].ravel(), self.space.nodes) for i in range(3)]
        return np.array(total, dtype=np.float64).reshape(field.shape)


def patch_load(space: Space, surface: Waviness, edges: tuple[float, float]) -> Array:
    """Return the nodal forces (3, nx, ny, nz) of unit pressure along the normal on `edges` x (-1, 1).

    Pressure on a facet passes (dz/dx, dz/dy, -1) per projected area.
    """
    basis = space.top(edges)
    tractions = (
        lambda x, y: surface.gradient(x, y)[0],
        lambda x, y: surface.gradient(x, y)[1],
        lambda x, y: -np.ones_like(x),
    )
    forces = np.zeros((3, space.nodes))
    for direction, traction in enumerate(tractions):
        form = LinearForm(lambda v, w, traction=traction: traction(w.x[0], w.x[1]) * v)
        forces[direction, space.tensor_index] = form.assemble(basis)
    return forces.reshape(3, *space.shape)
