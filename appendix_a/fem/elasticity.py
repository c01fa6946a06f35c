"""Plane-strain elasticity, E = 1, the far field that of the load's resultant on a half-plane.

The energy is a combination of three scalar matrices, integrals of u_,x v_,x, u_,x v_,y and u_,y v_,y,
which depend on the mesh alone: one assembly serves every Poisson ratio.  scikit-fem's `linear_elasticity`
on an `ElementVector` gives the same matrix to rounding and needs 0.32 s for each ratio, on a mesh where
these three need 0.10 s once and 0.03 s for each.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import bmat, csc_matrix
from skfem import BilinearForm

from appendix_a.fem.body import Body, Numbers, solve_fixed
from appendix_a.fem.halfplane import point_force

Array = NDArray[np.float64]


def lame(nu: float) -> tuple[float, float]:
    """Return Lame's lambda and mu for E = 1."""
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
class PlaneStrain(Body):
    """A body in plane strain under unit pressure on its strip."""

    @cached_property
    def scalar_matrices(self) -> tuple[csc_matrix, csc_matrix, csc_matrix]:
        """Integrals of u_,x v_,x; u_,x v_,y; u_,y v_,y (row v, column u)."""
        xx, xy, yy = (form.assemble(self.basis).tocsc() for form in (_xx, _xy, _yy))
        return xx, xy, yy

    @cached_property
    def load(self) -> Array:
        """Consistent nodal forces (2, n) of the strip's pressure."""
        return self.pressed()

    def stiffness(self, nu: float) -> csc_matrix:
        """Return lambda div u div v + 2 mu eps(u) : eps(v), unknowns (u_x; u_y)."""
        lam, mu = lame(nu)
        xx, xy, yy = self.scalar_matrices
        blocks = [
            [(lam + 2 * mu) * xx + mu * yy, lam * xy.T + mu * xy],
            [lam * xy + mu * xy.T, (lam + 2 * mu) * yy + mu * xx],
        ]
        return bmat(blocks, format="csc")

    def far_field(self, nu: float) -> tuple[Numbers, Array]:
        """Return unknowns on the outer boundary, with values under the resultant on a half-plane.

        Flamant's point force carries the load's horizontal and vertical resultant and stands where
        its moment is the load's.
        """
        nodes = self.nodes_of(self.outer)
        x, y = self.basis.doflocs
        push_x, push_y = self.load.sum(axis=1)
        moment, level = x @ self.load[1] - y @ self.load[0], self.surface_level
        x_force = (moment + level * push_x) / push_y
        u_x, u_y = point_force(x[nodes] - x_force, y[nodes] - level, (float(push_x), float(push_y)), nu)
        return np.concatenate([nodes, self.basis.N + nodes]), np.concatenate([u_x, u_y])

    def displacements(self, nu: float) -> Array:
        """Return (2, n) nodal displacements, in units of pressure times length / E."""
        return solve_fixed(self.stiffness(nu), self.load.ravel(), *self.far_field(nu)).reshape(2, -1)
