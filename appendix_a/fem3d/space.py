"""The triquadratic displacement space on a block, with its nodes numbered as a three-dimensional array."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from skfem import Basis, Dofs, ElementHex2, FacetBasis, MeshHex

from appendix_a.fem3d.mesh import Block

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
CHUNK = 1000  # elements tabulated at once: about 150 MB of work space; 250 takes a third longer


@dataclass(frozen=True)
class Space:
    """Nodes in C order of (x, y, zeta); `axes` are their coordinates along each, midpoints included.

    `element_nodes` (elements, 27) and `tensor_index` (nodes,) lead from scikit-fem's numbering to this one.
    """

    mesh: MeshHex
    dofs: Dofs
    axes: tuple[Array, Array, Array]
    tensor_index: Indices
    element_nodes: Indices

    @property
    def shape(self) -> tuple[int, int, int]:
        """Nodes along x, y, zeta."""
        return self.axes[0].size, self.axes[1].size, self.axes[2].size

    @property
    def nodes(self) -> int:
        """Number of nodes, each with three displacements."""
        return self.tensor_index.size

    def points(self) -> Array:
        """Return the block coordinates (3, nodes)."""
        return np.array(np.meshgrid(*self.axes, indexing="ij")).reshape(3, -1)

    def outer_boundary(self) -> NDArray[np.bool_]:
        """Return the nodes (nx, ny, nz) on both x ends, the far y end and the bottom."""
        outer = np.zeros(self.shape, dtype=np.bool_)
        outer[[0, -1]], outer[:, -1], outer[:, :, 0] = True, True, True
        return outer

    def tabulated(self) -> Iterator[tuple[slice, Basis]]:
        """Return the elements in chunks, with their basis at 3 x 3 x 3 Gauss points."""
        for start in range(0, self.element_nodes.shape[0], CHUNK):
            part = slice(start, min(start + CHUNK, self.element_nodes.shape[0]))
            elements = np.arange(part.start, part.stop)
            yield part, Basis(self.mesh, ElementHex2(), intorder=5, elements=elements, dofs=self.dofs)

    def top(self, edges: tuple[float, float]) -> FacetBasis:
        """Return the basis on the loaded part of the surface: `edges` in x, up to 1 in y."""
        above = 1e-9 * self.axes[2][0]

        def loaded(x: Array) -> NDArray[np.bool_]:
            inside: NDArray[np.bool_] = (x[2] > above) & (x[0] > edges[0]) & (x[0] < edges[1]) & (x[1] < 1.0)
            return inside

        return FacetBasis(self.mesh, ElementHex2(), facets=self.mesh.facets_satisfying(loaded), intorder=7)


def space(block: Block) -> Space:
    """Return the displacement space of a block."""
    mesh = MeshHex.init_tensor(block.x, block.y, block.zeta)
    # scikit-fem numbers all nodes whichever elements are tabulated; one is enough here
    basis = Basis(mesh, ElementHex2(), intorder=5, elements=np.array([0]))
    axes = (with_midpoints(block.x), with_midpoints(block.y), with_midpoints(block.zeta))
    places = tuple(np.searchsorted(0.5 * (a[1:] + a[:-1]), basis.doflocs[i]) for i, a in enumerate(axes))
    tensor_index = np.ravel_multi_index(places, tuple(a.size for a in axes))
    return Space(mesh, basis.dofs, axes, tensor_index, tensor_index[basis.dofs.element_dofs.T])


def with_midpoints(ends: Array) -> Array:
    """Return the nodes of a line of quadratic elements, from the elements' ends."""
    nodes = np.empty(2 * ends.size - 1)
    nodes[::2], nodes[1::2] = ends, 0.5 * (ends[1:] + ends[:-1])
    return nodes
