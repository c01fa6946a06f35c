"""Plane-strain elasticity on second-order triangles, E = 1.

The energy is a combination of three scalar matrices, integrals of u_,x v_,x, u_,x v_,y and u_,y v_,y,
which depend on the mesh alone: one assembly serves every Poisson ratio.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import bmat, csc_matrix
from scipy.sparse.linalg import splu
from skfem import Basis, BilinearForm, ElementTriP2, ElementTriP4, MeshTri, MeshTri2
from skfem.element import ElementTriP3

from appendix_a.fem.halfplane import point_force

Array = NDArray[np.float64]


ELEMENTS = {2: ElementTriP2, 3: ElementTriP3, 4: ElementTriP4}


def lame(nu: float) -> tuple[float, float]:
    """Lame's lambda and mu for E = 1."""
    return nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), 0.5 / (1.0 + nu)


@BilinearForm
def _xx(u, v, w):  # type: ignore[no-untyped-def]  # scikit-fem calls it with its own untyped fields
    return u.grad[0] * v.grad[0]


@BilinearForm
def _xy(u, v, w):  # type: ignore[no-untyped-def]  # as above
    return u.grad[0] * v.grad[1]


@BilinearForm
def _yy(u, v, w):  # type: ignore[no-untyped-def]  # as above
    return u.grad[1] * v.grad[1]


@dataclass(frozen=True)
class PlaneStrain:
    """A body under its bent surface, pressed with unit pressure along the local normal on a strip.

    `mesh` is the bent mesh, `surface` the facet numbers of the rough boundary from left to right, `strip`
    those of them under pressure, `outer` the facets of the artificial boundary.
    """

    mesh: MeshTri2
    surface: NDArray[np.int64]
    strip: NDArray[np.int64]
    outer: NDArray[np.int64]
    order: int = 2

    @cached_property
    def basis(self) -> Basis:
        return Basis(self.mesh, ELEMENTS[self.order](), intorder=2 * self.order)

    @cached_property
    def scalar_matrices(self) -> tuple[csc_matrix, csc_matrix, csc_matrix]:
        """Integrals of u_,x v_,x; u_,x v_,y; u_,y v_,y (row v, column u)."""
        return tuple(form.assemble(self.basis).tocsc() for form in (_xx, _xy, _yy))

    def edge_nodes(self, facets: NDArray[np.int64]) -> NDArray[np.int64]:
        """(order + 1, m) nodes of surface facets, from left to right, equally spaced in the parameter."""
        dofs = self.basis.dofs
        nodes = np.vstack([dofs.nodal_dofs[0][self.mesh.facets[:, facets]], dofs.facet_dofs[:, facets]])
        return np.take_along_axis(nodes, np.argsort(self.basis.doflocs[0][nodes], axis=0), axis=0)

    @cached_property
    def load(self) -> Array:
        """Consistent nodal forces (2, n) of the strip's pressure, exact on the mesh's quadratic sides.

        The inward normal times the length element is (-dy, dx) along the surface.
        """
        nodes = self.edge_nodes(self.strip)
        x, y = self.basis.doflocs[:, nodes]
        t, weights = np.polynomial.legendre.leggauss(self.order + 1)
        shape, slope = lagrange(self.order, (1.0 + t) / 2)
        shape_by_slope = (shape * weights / 2) @ slope.T
        forces = np.zeros((2, self.basis.N))
        np.add.at(forces[0], nodes, -shape_by_slope @ y)
        np.add.at(forces[1], nodes, shape_by_slope @ x)
        return forces

    def stiffness(self, nu: float) -> csc_matrix:
        """lambda div u div v + 2 mu eps(u) : eps(v), unknowns (u_x; u_y)."""
        lam, mu = lame(nu)
        xx, xy, yy = self.scalar_matrices
        blocks = [
            [(lam + 2 * mu) * xx + mu * yy, lam * xy.T + mu * xy],
            [lam * xy + mu * xy.T, (lam + 2 * mu) * yy + mu * xx],
        ]
        return bmat(blocks, format="csc")

    def far_field(self, nu: float) -> tuple[Array, NDArray[np.int64]]:
        """Displacements (2, m) of the load's resultant on a half-plane, and the outer boundary's m nodes.

        Flamant's point force carries the load's horizontal and vertical resultant and stands where
        its moment is the load's.
        """
        nodes = np.asarray(self.basis.get_dofs(self.outer).all(), dtype=np.int64)
        x, y = self.basis.doflocs
        push_x, push_y = self.load.sum(axis=1)
        moment = x @ self.load[1] - y @ self.load[0]
        level = self.surface_level
        x_force = (moment + level * push_x) / push_y
        u = point_force(x[nodes] - x_force, y[nodes] - level, (float(push_x), float(push_y)), nu)
        return np.array(u), nodes

    @property
    def surface_level(self) -> float:
        """Mean level y of the flat surface far from the load."""
        return float(self.basis.doflocs[1, self.edge_nodes(self.surface[:1])[0, 0]])

    def displacements(self, nu: float) -> Array:
        """(2, n) nodal displacements, in units of pressure times length / E."""
        n = self.basis.N
        prescribed, nodes = self.far_field(nu)
        u = np.zeros(2 * n)
        fixed = np.concatenate([nodes, n + nodes])
        u[fixed] = prescribed.ravel()
        free = np.setdiff1d(np.arange(2 * n), fixed)
        stiffness = self.stiffness(nu)
        rest = self.load.ravel() - stiffness @ u
        factor = splu(
            stiffness[free][:, free],
            permc_spec="MMD_AT_PLUS_A",
            diag_pivot_thresh=0.0,
            options={"SymmetricMode": True},
        )
        u[free] = factor.solve(rest[free])
        return u.reshape(2, n)

    def surface_values(self, u: Array, x: Array) -> Array:
        """Values of a nodal field u (n,) on the rough boundary at abscissae x (m,)."""
        nodes = self.edge_nodes(self.surface)
        where = self.basis.doflocs[0][nodes]
        edge = np.clip(np.searchsorted(where[0], x, side="right") - 1, 0, len(self.surface) - 1)
        # quadratic sides: x(t) = x0 + (x2 - x0) t + bow t (1 - t); the root in [0, 1] without cancellation
        x0, x2 = where[0, edge], where[-1, edge]
        bow = 4.0 * (self._middle(where[:, edge]) - (x0 + x2) / 2)
        b, c = x2 - x0 + bow, x - x0
        shape, _ = lagrange(self.order, 2 * c / (b + np.sqrt(b**2 - 4 * bow * c)))
        values: Array = np.sum(shape * u[nodes[:, edge]], axis=0)
        return values

    def _middle(self, edge_values: Array) -> Array:
        shape, _ = lagrange(self.order, np.array([0.5]))
        return shape[:, 0] @ edge_values


def lagrange(order: int, t: Array) -> tuple[Array, Array]:
    """Lagrange polynomials on equally spaced nodes of [0, 1] and their derivatives, (order + 1, len(t))."""
    nodes = np.linspace(0.0, 1.0, order + 1)
    coefficients = np.linalg.inv(np.vander(nodes, increasing=True)).T
    powers = np.vander(t, order + 1, increasing=True).T
    derivatives = np.vstack([np.zeros_like(t), np.arange(1, order + 1)[:, None] * powers[:-1]])
    return coefficients @ powers, coefficients @ derivatives


def plane_strain(reference: MeshTri, bent: MeshTri2, order: int = 2) -> PlaneStrain:
    """The body, its facets told apart on the reference mesh: surface eta = 0, strip |xi| < 1, outer rest."""
    facets = reference.boundary_facets()
    xi, eta = reference.p[:, reference.facets[:, facets]].mean(axis=1)
    on_surface = eta == 0.0
    left_to_right = np.argsort(xi[on_surface])
    surface = facets[on_surface][left_to_right]
    strip = facets[on_surface & (np.abs(xi) < 1.0)]
    return PlaneStrain(bent, surface, strip, facets[~on_surface], order)
