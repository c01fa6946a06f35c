"""Meshes and fields on disk, through meshio."""

from __future__ import annotations

from pathlib import Path

import meshio
import numpy as np
from numpy.typing import NDArray
from skfem import Basis

from appendix_a.fem.body import ELEMENTS
from appendix_a.fem.elasticity import PlaneStrain, lame

Array = NDArray[np.float64]
# vertices and mid-sides of the reference triangle, in the order of VTK's six-node triangle
SIX_NODES = np.array([[0.0, 1.0, 0.0, 0.5, 0.5, 0.0], [0.0, 0.0, 1.0, 0.0, 0.5, 0.5]])


def write_fields(path: Path, body: PlaneStrain, nu: float, u: Array) -> None:
    """Write mesh, nodal displacements and element stresses in the format of the path's suffix.

    path: e.g. *.vtu.  u: (2, n) nodal displacements in units of p a / E, lengths in a, stresses in p.
    """
    element = ELEMENTS[body.order]()
    dofs = body.basis.element_dofs
    shapes = np.array([element.lbasis(SIX_NODES, i)[0] for i in range(len(dofs))])
    at_nodes = np.einsum("ik,cie->cke", shapes, u[:, dofs])
    six = body.mesh.dofs.element_dofs
    displacement = np.zeros((body.mesh.doflocs.shape[1], 3))
    displacement[six, :2] = np.moveaxis(at_nodes, 0, -1)
    points = np.column_stack([body.mesh.doflocs.T, np.zeros(body.mesh.doflocs.shape[1])])
    stress = {name: [values] for name, values in element_stresses(body, nu, u).items()}
    mesh = meshio.Mesh(points, [("triangle6", six.T)], {"displacement": displacement}, stress)
    mesh.write(path)


def element_stresses(body: PlaneStrain, nu: float, u: Array) -> dict[str, Array]:
    """Return the stress components at the elements' centroids, each (elements,), in units of the pressure."""
    centroid = (np.full((2, 1), 1.0 / 3.0), np.array([0.5]))
    basis = Basis(body.mesh, ELEMENTS[body.order](), quadrature=centroid)
    (xx, xy), (yx, yy) = (basis.interpolate(component).grad[:, :, 0] for component in u)
    lam, mu = lame(nu)
    return {
        "sigma_xx": lam * (xx + yy) + 2 * mu * xx,
        "sigma_yy": lam * (xx + yy) + 2 * mu * yy,
        "sigma_xy": mu * (xy + yx),
    }
