"""Surface compliance of a three-dimensional wavy body, periodic along x, mirror symmetric about y = 0.

A square of one wavelength, of which the half 0 < y < 1/2 is meshed by quadratic hexahedra; the base is
fixed, and u_y on both planes of symmetry.  As in two dimensions the uniform field of the load's resultant
is subtracted.  Lengths in wavelengths.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import bmat, csc_matrix, csr_matrix
from skfem import Basis, BilinearForm, ElementHex2, MeshHex, MeshHex2

from appendix_a.contact_fem.bodies import condensed
from appendix_a.contact_fem.scene import WAVENUMBER
from appendix_a.fem.body import Numbers
from appendix_a.fem.elasticity import lame

Array = NDArray[np.float64]
DEPTH = 1.0
ZONE = 0.1875  # half-width of the square where contact may be and the mesh is even


@dataclass(frozen=True, eq=False)
class Patch:
    """A surface where contact may be, on a grid of nodes: `at` (3, nx, ny), z upwards about the mean plane.

    An element's ends are two nodes apart.  `compliance` (3 n, 3 n), n = nx ny, component after component:
    for forces on the half body y > 0, with the other half loaded as its mirror image.
    """

    at: Array
    compliance: Array

    def mirrored(self) -> Patch:
        """Return the body turned upside down about the y axis' direction: x and z change sign."""
        sign = np.array([-1.0, 1.0, -1.0])
        _, nx, ny = self.at.shape
        order = np.arange(nx * ny).reshape(nx, ny)[::-1].ravel()
        everything = np.concatenate([order + c * nx * ny for c in range(3)])
        flip = np.repeat(sign, nx * ny)
        compliance = self.compliance[np.ix_(everything, everything)] * np.outer(flip, flip)
        return Patch(sign[:, None, None] * self.at[:, ::-1], compliance)

    def of_modulus(self, E: float) -> Patch:
        """Return the body of Young's modulus E instead of 1."""
        return Patch(self.at, self.compliance / E)


def nodes_along(elements: int) -> tuple[Array, Array, Array]:
    """Return element ends along x, y and depth; `elements` from 0 to ZONE, others in proportion."""
    even = np.linspace(0.0, ZONE, elements + 1)
    wide = 0.5 - ZONE
    steps = np.linspace(0.0, 1.0, max(2, round(2 * elements / 3)) + 1)[1:]
    half = np.concatenate([even, ZONE + wide * steps * (0.6 + 0.4 * steps)])
    layers = np.linspace(0.0, 1.0, round(5 * elements / 3) + 1)
    return np.concatenate([-half[:0:-1], half]), half, DEPTH * layers * (0.3 + 0.7 * layers)


@lru_cache(maxsize=4)
def asperity(amplitude: float, crest: float, nu: float, elements: int) -> Patch:
    """Return the body below z = amplitude (cos k (x - crest) + cos k y), E = 1."""
    ends = nodes_along(elements)
    mesh = MeshHex2.from_mesh(MeshHex.init_tensor(*ends))
    x, y, d = mesh.doflocs
    height = amplitude * (np.cos(WAVENUMBER * (x - crest)) + np.cos(WAVENUMBER * y))
    mesh = MeshHex2(np.array([x, y, -d + height * (1.0 - d / DEPTH) ** 3]), mesh.t)
    basis = Basis(mesh, ElementHex2(), intorder=5)
    # the reference places of the nodes, for telling sides apart
    # rounded: they are compared and sorted
    place = Basis(MeshHex.init_tensor(*ends), ElementHex2(), intorder=5).doflocs.round(9)
    top = np.flatnonzero((place[2] == 0.0) & (np.abs(place[0]) < ZONE + 1e-9) & (place[1] < ZONE + 1e-9))
    top = top[np.lexsort((place[1, top], place[0, top]))]
    ny = int(np.count_nonzero(place[0, top] == place[0, top[0]]))
    at = basis.doflocs[:, top].reshape(3, -1, ny)
    return Patch(at, _compliance(basis, place, top, nu))


def _stiffness(basis: Basis, nu: float) -> csc_matrix:
    """Return lambda div u div v + 2 mu eps(u) : eps(v), unknowns (u_x; u_y; u_z).

    From six scalar forms: scikit-fem's `linear_elasticity` on an `ElementVector` is equal to rounding, and
    needs twelve times as long on triquadratic hexahedra (12.3 s against 1.0 s at five elements).
    """
    lam, mu = lame(nu)

    def product(i: int, j: int) -> csc_matrix:
        return BilinearForm(lambda u, v, w: u.grad[i] * v.grad[j]).assemble(basis).tocsc()

    pairs = {(i, j): product(i, j) for i in range(3) for j in range(i, 3)}
    full = {(i, j): pairs[i, j] if i <= j else pairs[j, i].T for i in range(3) for j in range(3)}
    laplace = full[0, 0] + full[1, 1] + full[2, 2]
    # row v_a, column u_b: lambda u_b,b v_a,a + mu u_b,a v_a,b, and mu grad u_a . grad v_a
    blocks = [[lam * full[b, a] + mu * full[a, b] for b in range(3)] for a in range(3)]
    for a in range(3):
        blocks[a][a] = blocks[a][a] + mu * laplace
    return csc_matrix(bmat(blocks, format="csc"))


def _compliance(basis: Basis, place: Array, top: Numbers, nu: float) -> Array:
    """Return the displacements of the nodes `top` under unit forces on them, from the mean plane."""
    n = basis.N
    tie = _tie(place)
    kept = tie[np.concatenate([top, n + top, 2 * n + top])]
    free = np.flatnonzero(np.diff(kept.indptr))  # u_y at y = 0 is held and stays zero
    stiffness = condensed(csc_matrix(tie.T @ _stiffness(basis, nu) @ tie), kept.indices.astype(np.int64))
    m = len(top)
    compliance = np.zeros((3 * m, 3 * m))
    compliance[np.ix_(free, free)] = np.linalg.inv(stiffness)
    lam, mu = lame(nu)
    area = 0.5
    compliance[:m, :m] -= DEPTH / mu / area
    compliance[2 * m :, 2 * m :] -= DEPTH / (lam + 2.0 * mu) / area
    return compliance


def _tie(place: Array) -> csr_matrix:
    """Map from free unknowns to all: x periodic, base at rest, u_y = 0 on y = 0 and y = 1/2."""
    x, y, d = place
    n = place.shape[1]
    left, right = (np.flatnonzero(x == side) for side in (-0.5, 0.5))
    left, right = (side[np.lexsort((y[side], d[side]))] for side in (left, right))
    if not np.array_equal(place[1:, left], place[1:, right]):
        raise ArithmeticError("the mesh's left and right sides do not match")
    master = np.arange(n)
    master[right] = left
    base = d == DEPTH
    planes = (y == 0.0) | (y == 0.5)
    masters = np.concatenate([master, n + master, 2 * n + master])
    held = np.concatenate([base, base | planes, base])
    free = np.unique(masters[~held])
    number = np.full(3 * n, -1)
    number[free] = np.arange(len(free))
    column = np.where(held, -1, number[masters])
    rows = np.flatnonzero(column >= 0)
    return csr_matrix((np.ones(len(rows)), (rows, column[rows])), shape=(3 * n, len(free)))
