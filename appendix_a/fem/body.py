"""A meshed body: its boundary's parts, values along its surface, the solve under given displacements."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Self

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_matrix
from scipy.sparse.linalg import splu
from skfem import Basis, ElementTriP2, ElementTriP4, FacetBasis, LinearForm, MeshTri, MeshTri2, condense
from skfem.element import ElementTriP3

Array = NDArray[np.float64]
Numbers = NDArray[np.int64]
ELEMENTS = {2: ElementTriP2, 3: ElementTriP3, 4: ElementTriP4}


@dataclass(frozen=True)
class Body:
    """A body under its rough surface, with unit pressure along the local normal on a strip.

    `mesh` is the bent mesh, `surface` the facet numbers of the rough boundary from left to right, `strip`
    those of them under pressure, `axis` those on x = 0 where that bounds the body, `outer` those of the
    artificial boundary.  `order` is the polynomial degree of the displacements; the sides are quadratic.
    """

    mesh: MeshTri2
    surface: Numbers
    strip: Numbers
    axis: Numbers
    outer: Numbers
    order: int

    @classmethod
    def on(cls, reference: MeshTri, bent: MeshTri2, order: int) -> Self:
        """Distinguish facets on the reference mesh: surface eta = 0, strip |xi| < 1, axis xi = 0, outer."""
        facets = reference.boundary_facets()
        xi, eta = reference.p[:, reference.facets[:, facets]].mean(axis=1)
        on_surface, on_axis = eta == 0.0, xi == 0.0
        surface = facets[on_surface][np.argsort(xi[on_surface])]
        strip = facets[on_surface & (np.abs(xi) < 1.0)]
        return cls(bent, surface, strip, facets[on_axis], facets[~on_surface & ~on_axis], order)

    @cached_property
    def basis(self) -> Basis:
        """Scalar basis, one per displacement component."""
        return Basis(self.mesh, ELEMENTS[self.order](), intorder=2 * self.order)

    def pressed(self, weight: Callable[[Array], Array] = np.ones_like) -> Array:
        """Return nodal forces (2, n) of unit pressure on the strip, times `weight` of the abscissae.

        Pressure acts against the outward normal; exact on the mesh's quadratic sides.
        """
        sides = FacetBasis(
            self.mesh,
            ELEMENTS[self.order](),
            facets=self.strip,
            intorder=2 * self.order,
            dofs=self.basis.dofs,
        )
        forms = [LinearForm(lambda v, w, i=i: -w.n[i] * v * weight(w.x[0])) for i in (0, 1)]
        return np.array([form.assemble(sides) for form in forms])

    def edge_nodes(self, facets: Numbers) -> Numbers:
        """Return (order + 1, m) nodes of surface facets, left to right, equally spaced."""
        dofs = self.basis.dofs
        nodes = np.vstack([dofs.nodal_dofs[0][self.mesh.facets[:, facets]], dofs.facet_dofs[:, facets]])
        return np.take_along_axis(nodes, np.argsort(self.basis.doflocs[0][nodes], axis=0), axis=0)

    @property
    def surface_level(self) -> float:
        """Level y of the flat surface far from the load."""
        return float(self.basis.doflocs[1, self.edge_nodes(self.surface[-1:])[-1, 0]])

    def nodes_of(self, facets: Numbers) -> Numbers:
        """Return the scalar nodes on the given facets."""
        return np.asarray(self.basis.get_dofs(facets).all(), dtype=np.int64)

    def surface_values(self, u: Array, x: Array) -> Array:
        """Return the values of a nodal field u (n,) on the rough boundary at abscissae x (m,).

        By the sides' own parameter: scikit-fem's `interpolator` and `probes` refuse curved meshes.
        """
        nodes = self.edge_nodes(self.surface)
        where = self.basis.doflocs[0][nodes]
        edge = np.clip(np.searchsorted(where[0], x, side="right") - 1, 0, len(self.surface) - 1)
        # quadratic sides: x(t) = x0 + (x2 - x0) t + bow t (1 - t); the root in [0, 1] without cancellation
        x0, x2 = where[0, edge], where[-1, edge]
        half, _ = lagrange(self.order, np.array([0.5]))
        bow = 4.0 * (half[:, 0] @ where[:, edge] - (x0 + x2) / 2)
        b, c = x2 - x0 + bow, x - x0
        shape, _ = lagrange(self.order, 2 * c / (b + np.sqrt(b**2 - 4 * bow * c)))
        values: Array = np.sum(shape * u[nodes[:, edge]], axis=0)
        return values


def lagrange(order: int, t: Array) -> tuple[Array, Array]:
    """Return Lagrange polynomials on equal steps of [0, 1], and derivatives, (order + 1, len(t)).

    >>> [values.round(12).tolist() for values in lagrange(1, np.array([0.25]))]
    [[[0.75], [0.25]], [[-1.0], [1.0]]]
    """
    nodes = np.linspace(0.0, 1.0, order + 1)
    coefficients = np.linalg.inv(np.vander(nodes, increasing=True)).T
    powers = np.vander(t, order + 1, increasing=True).T
    derivatives = np.vstack([np.zeros_like(t), np.arange(1, order + 1)[:, None] * powers[:-1]])
    return coefficients @ powers, coefficients @ derivatives


def solve_fixed(
    matrix: csc_matrix, load: Array, fixed: Numbers, values: Array, *, definite: bool = True
) -> Array:
    """Solve matrix u = load with u[fixed] = values; a `definite` matrix needs no pivoting."""
    start = np.zeros(matrix.shape[0])
    start[fixed] = values
    inner, right, u, free = condense(matrix, load, x=start, D=fixed)
    if definite:
        options = {"SymmetricMode": True}
        factor = splu(csc_matrix(inner), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=options)
    else:
        factor = splu(csc_matrix(inner))
    u[free] = factor.solve(right)
    return np.asarray(u, dtype=np.float64)
