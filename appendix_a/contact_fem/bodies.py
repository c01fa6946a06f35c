"""Surface compliance of a wavy body in plane strain, periodic along x, by second-order finite elements.

The body lies below its profile, one wavelength wide and some wavelengths deep, fixed at its base.  Every
field but the uniform one decays as exp(-2 pi depth): what the base adds is the uniform strain of the load's
resultant, which is subtracted, so that displacements count from the mean plane (as in a periodic half-plane).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import block_diag, csc_matrix, csr_matrix
from scipy.sparse.linalg import splu
from skfem import MeshTri, MeshTri2

from appendix_a.contact_fem.scene import WAVENUMBER, Material
from appendix_a.fem.body import Numbers
from appendix_a.fem.elasticity import PlaneStrain, lame
from appendix_a.fem.mesh import Source, graded_mesh

Array = NDArray[np.float64]
Profile = Callable[[Array], Array]
Harmonics = tuple[tuple[int, float, float], ...]  # (order, amplitude over the first one's, phase in rad)
FINER = 8  # cells at the contact's ends against those between


@dataclass(frozen=True)
class MeshPlan:
    """Reference mesh: cells of 1/`cells` on the surface where |x| < `zone`, `level` times refined uniformly.

    Cells shrink to 1/(cells FINER) towards the `marks` and their mirror images; `depth` of the body below
    its mean plane; all lengths in wavelengths.
    """

    cells: int
    zone: float
    level: int = 0
    marks: tuple[float, ...] = ()
    depth: float = 1.5

    def reference(self) -> MeshTri:
        """Return triangles over xi in [-1, 1] (one wavelength) and eta in [0, 1], mirror symmetric in xi."""
        size, reach = 2.0 / self.cells, 2.0 * self.zone
        sources = [Source(-reach, reach, size, 1.0), Source(-1.0, 1.0, 1.0 / 8.0, 1.0)]
        sources += [Source(2.0 * m, 2.0 * m, size / FINER, 0.5) for mark in self.marks for m in (-mark, mark)]
        return graded_mesh(sources, 1.0, centred=False).refined(self.level)


@dataclass(frozen=True, eq=False)
class Surface:
    """A body's surface where contact may be: nodes, edges and compliance, z upwards.

    `at`: (2, n) nodes (x, z about the mean plane), `edges`: (3, m) their numbers by edge from left to right,
    `compliance`: (2n, 2n) displacements (u_x; u_z) under nodal forces (F_x; F_z) per unit thickness.
    """

    at: Array
    edges: Numbers
    compliance: Array


def wavy_surface(
    amplitude: float,
    crest: float,
    material: Material,
    plan: MeshPlan,
    *,
    upper: bool,
    straight: bool = False,
    harmonics: Harmonics = (),
) -> Surface:
    """Return the surface of a body with a sinusoidal profile whose asperity has its top at x = `crest`.

    `harmonics` add shorter waves: `amplitude share cos(order k (x - crest) + phase)` each.

    The lower body's z is -y of the body's own frame (y into the body), the `upper` one's is y.  `straight`:
    the compliance of a flat body instead, as influence coefficients have it, under the same wavy surface.
    """
    unit = _unit_surface(amplitude, crest, material.nu, plan, straight, harmonics)
    sign = np.array([1.0, 1.0 if upper else -1.0])
    flip = np.repeat(sign, unit.at.shape[1])
    return Surface(sign[:, None] * unit.at, unit.edges, unit.compliance * np.outer(flip, flip) / material.E)


@lru_cache(maxsize=8)
def _unit_surface(
    amplitude: float, crest: float, nu: float, plan: MeshPlan, straight: bool, harmonics: Harmonics
) -> Surface:
    """Return the surface for E = 1 in the body's own frame."""
    reference = plan.reference()

    def profile(x: Array) -> Array:
        return -wave_height(x - crest, amplitude, harmonics)

    body = PlaneStrain.on(reference, _bent(reference, profile, plan.depth), order=2)
    elastic = body
    if straight:
        elastic = PlaneStrain.on(reference, _bent(reference, np.zeros_like, plan.depth), order=2)
    middle = body.mesh.p[0][body.mesh.facets[:, body.surface]].mean(axis=0)
    columns = body.edge_nodes(body.surface[np.abs(middle) < plan.zone])
    nodes = np.unique(columns)
    nodes = nodes[np.argsort(body.basis.doflocs[0, nodes])]
    rank = np.empty(body.basis.N, dtype=np.int64)
    rank[nodes] = np.arange(len(nodes))
    return Surface(body.basis.doflocs[:, nodes], rank[columns], _compliance(elastic, nodes, nu, plan.depth))


def wave_height(x: Array, amplitude: float, harmonics: Harmonics = ()) -> Array:
    """Return the height above the mean plane, out of the body, at x from the crest (wavelengths)."""
    waves = np.cos(WAVENUMBER * x)
    for order, share, phase in harmonics:
        waves = waves + share * np.cos(order * WAVENUMBER * x + phase)
    height: Array = amplitude * waves
    return height


def _bent(reference: MeshTri, profile: Profile, depth: float) -> MeshTri2:
    """Return the reference mesh on the profile, with quadratic sides; depth stretched, the base plane."""
    curved = MeshTri2.from_mesh(reference)
    xi, eta = curved.doflocs
    x, y = xi / 2.0, eta / 2.0 + (depth - 0.5) * eta**3
    return MeshTri2(np.array([x, y + profile(x) * (1.0 - y / depth) ** 3]), curved.t)


def _compliance(body: PlaneStrain, nodes: Numbers, nu: float, depth: float) -> Array:
    """Return the displacements of `nodes` under unit forces on them, counted from the mean plane (E = 1)."""
    tie = _periodic_and_fixed(body, depth)
    kept = tie[np.concatenate([nodes, body.basis.N + nodes])].indices
    stiffness = condensed(csc_matrix(tie.T @ body.stiffness(nu) @ tie), kept)
    compliance = np.asarray(np.linalg.inv(stiffness), dtype=np.float64)
    lam, mu = lame(nu)
    m = len(nodes)
    compliance[:m, :m] -= depth / mu
    compliance[m:, m:] -= depth / (lam + 2.0 * mu)
    return compliance


def condensed(matrix: csc_matrix, kept: Numbers) -> Array:
    """Return the Schur complement of a symmetric positive definite matrix on the `kept` unknowns.

    With those numbered last, it is what elimination of the others leaves: the last block of L times U.
    """
    options = {"SymmetricMode": True}
    rest = np.setdiff1d(np.arange(matrix.shape[0]), kept)
    inner = splu(matrix[rest][:, rest], permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=options)
    order = np.concatenate([rest[np.argsort(inner.perm_c)], kept])
    factor = splu(matrix[order][:, order], permc_spec="NATURAL", diag_pivot_thresh=0.0, options=options)
    natural = np.arange(len(order))
    if not (np.array_equal(factor.perm_r, natural) and np.array_equal(factor.perm_c, natural)):
        raise ArithmeticError("the elimination did not keep its order")
    last = slice(len(rest), None)
    block: Array = (factor.L[last, last] @ factor.U[last, last]).toarray()
    return block


def _periodic_and_fixed(body: PlaneStrain, depth: float) -> csr_matrix:
    """Map from free unknowns to all (u_x; u_y): right side tied to the left one, the base at rest."""
    x, y = body.basis.doflocs
    outer = body.nodes_of(body.outer)
    left, right = (outer[np.abs(x[outer] - side) < 1e-12] for side in (-0.5, 0.5))
    left, right = (side[np.argsort(y[side])] for side in (left, right))
    if len(left) != len(right) or not np.allclose(y[left], y[right], rtol=0, atol=1e-12):
        raise ArithmeticError("the mesh's left and right sides do not match")
    master = np.arange(body.basis.N)
    master[right] = left
    free = np.setdiff1d(master, np.flatnonzero(np.abs(y - depth) < 1e-12))
    number = np.full(body.basis.N, -1)
    number[free] = np.arange(len(free))
    column = number[master]
    rows = np.flatnonzero(column >= 0)
    one = csr_matrix((np.ones(len(rows)), (rows, column[rows])), shape=(body.basis.N, len(free)))
    return csr_matrix(block_diag([one, one]))
