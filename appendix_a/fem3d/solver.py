"""Conjugate gradients, preconditioned by exact inverses of the flat body's three separable diagonal blocks.

On the flat block the (i, i) part of the elastic operator is (lambda + 2 mu) d_i^2 + mu (the other two), a
sum of Kronecker products of one-dimensional matrices, whose inverse takes three small eigenproblems
(Lynch, Rice and Thomas 1964). Korn's inequality bounds the condition number by a number that neither the
grading nor the mesh size enters.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh
from skfem import Basis, ElementLineP2, MeshLine
from skfem.models.poisson import laplace
from skfem.models.poisson import mass as mass_form

from appendix_a.fem3d.elasticity import Operator, lame_constants

Array = NDArray[np.float64]
TOLERANCE = 1e-8  # residual over right-hand side; 1e-10 moves no displacement by more than 3e-9 of itself
ITERATION_LIMIT = 400  # 80 are needed at nu = 0.45 and a slope of 30 degrees, 25 at nu = 0.3 and 10 degrees


def line_matrices(nodes: Array) -> tuple[Array, Array]:
    """Return (stiffness, mass) of quadratic line elements on `nodes` (2 n + 1,), ends and midpoints."""
    basis = Basis(MeshLine(nodes[::2]), ElementLineP2())
    order = np.argsort(basis.doflocs[0])
    stiff, mass = (form.assemble(basis).toarray()[np.ix_(order, order)] for form in (laplace, mass_form))
    return stiff, mass


@dataclass(frozen=True)
class SeparableInverse:
    """The inverse of one component's separable block on its free nodes."""

    free: tuple[slice, slice, slice]
    modes: tuple[Array, Array, Array]
    inverse_sum: Array

    def __call__(self, residual: Array) -> Array:
        """Apply to nodal forces (nx, ny, nz); zero on the held nodes."""
        vx, vy, vz = self.modes
        r = residual[self.free]
        nx, ny, nz = r.shape
        r = (vx.T @ r.reshape(nx, -1)).reshape(nx, ny, nz)
        r = (vy.T @ r) @ vz
        r *= self.inverse_sum
        r = (vy @ r) @ vz.T
        result = np.zeros_like(residual)
        result[self.free] = (vx @ r.reshape(nx, -1)).reshape(nx, ny, nz)
        return result

    def clear_held(self, force: Array) -> None:
        """Set to zero the forces (nx, ny, nz) on the held nodes, in place."""
        kept = force[self.free].copy()
        force[:] = 0.0
        force[self.free] = kept


def separable_inverse(axes: tuple[Array, Array, Array], component: int, nu: float) -> SeparableInverse:
    """Invert the block (component, component): held outside; y on the symmetry plane as well."""
    lame, shear = lame_constants(nu)
    free = (slice(1, -1), slice(1 if component == 1 else 0, -1), slice(1, None))
    modes, total = [], np.zeros((1, 1, 1))
    for axis in range(3):
        stiff, mass = line_matrices(axes[axis])
        values, vectors = eigh(stiff[free[axis], free[axis]], mass[free[axis], free[axis]])
        modulus = lame + 2 * shear if axis == component else shear
        total = total + modulus * values.reshape([-1 if i == axis else 1 for i in range(3)])
        modes.append(vectors)
    return SeparableInverse(free, (modes[0], modes[1], modes[2]), 1 / total)


class NotConverged(RuntimeError):
    """The linear solver stopped short of its tolerance."""


@dataclass(frozen=True)
class LinearSolution:
    """Displacements (3, nx, ny, nz), iterations, and |b - K u| / |b| over the free unknowns, recomputed."""

    field: Array
    iterations: int
    residual: float


def solve(operator: Operator, nu: float, load: Array, held: Array) -> LinearSolution:
    """Solve K u = load with u = `held` on the outer boundary (zero elsewhere); all fields (3, nx, ny, nz).

    Raises NotConverged when the recomputed residual misses TOLERANCE.
    """
    blocks = [separable_inverse(operator.space.axes, component, nu) for component in range(3)]

    def apply(field: Array) -> Array:
        forces = operator(field)
        for block, force in zip(blocks, forces, strict=True):
            block.clear_held(force)
        return forces

    right = load - operator(held)
    for block, force in zip(blocks, right, strict=True):
        block.clear_held(force)
    goal = TOLERANCE * float(np.linalg.norm(right))
    u, r = np.zeros_like(held), right.copy()
    p, rz = np.zeros_like(held), np.inf
    iterations = 0
    while np.linalg.norm(r) > goal and iterations < ITERATION_LIMIT:
        iterations += 1
        z = np.array([block(force) for block, force in zip(blocks, r, strict=True)])
        rz, previous = float(np.vdot(r, z)), rz
        p = z + (rz / previous) * p
        q = apply(p)
        step = rz / float(np.vdot(p, q))
        u += step * p
        r -= step * q
    residual = float(np.linalg.norm(right - apply(u)) / np.linalg.norm(right))
    if residual > 1.1 * TOLERANCE:  # the recursion's residual and the true one part at the level of rounding
        raise NotConverged(f"residual {residual:.1e} after {iterations} iterations, wanted {TOLERANCE:.1e}")
    return LinearSolution(u + held, iterations, residual)
