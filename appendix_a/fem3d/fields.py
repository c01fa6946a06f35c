"""Mesh and displacements as a file for ParaView and the like, through meshio."""

from __future__ import annotations

from pathlib import Path

import meshio
import numpy as np
from numpy.typing import NDArray

from appendix_a.fem3d.elasticity import mapped
from appendix_a.fem3d.space import Space
from appendix_a.fem3d.wavy import Waviness

Array = NDArray[np.float64]

# VTK's order of a hexahedron's corners: round the bottom, then round the top
CORNERS = ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1))


def write_fields(path: Path, body: Space, surface: Waviness, field: Array) -> None:
    """Write nodes (in a) and displacements (3, nx, ny, nz) (in p a / E); the suffix says the format.

    Every 27-node element is written as its eight octants, which every viewer reads.
    """
    index = np.arange(body.nodes).reshape(body.shape)
    nx, ny, nz = (n - 1 for n in body.shape)
    cells = [index[i : i + nx, j : j + ny, k : k + nz].ravel() for i, j, k in CORNERS]
    points = mapped(surface, body.points()).T
    displacement = field.reshape(3, -1).T
    mesh = meshio.Mesh(points, [("hexahedron", np.stack(cells, axis=1))], {"displacement": displacement})
    mesh.write(path)
