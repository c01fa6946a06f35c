"""The three-dimensional elements and their solver, each against another way of doing the same."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse as sp
from scipy.sparse.linalg import spsolve
from skfem import Basis, ElementHex2, ElementVector, MeshHex2
from skfem.models.elasticity import lame_parameters, linear_elasticity

from appendix_a.fem3d import solver
from appendix_a.fem3d.elasticity import Operator, mapped, patch_load, stiffness
from appendix_a.fem3d.mesh import Block
from appendix_a.fem3d.space import Space, space
from appendix_a.fem3d.wavy import Kind, Waviness

NU = 0.3
FLAT = Waviness(0.0, 20.0, 0.0)
EDGES = (-1.0, 1.0)


def small_space() -> Space:
    """Graded, with the loaded element's half -1..1 by 0..1 made of whole intervals."""
    x, y = np.array([-6.0, -2.5, -1.0, 0.0, 1.0, 2.5, 6.0]), np.array([0.0, 1.0, 2.0, 6.0])
    return space(Block(x, y, np.array([-6.0, -2.5, -1.0, 0.0])))


def assembled(operator: Operator) -> sp.csr_matrix:
    """The matrix whose product the operator is; unknowns component by component."""
    nodes = operator.space.element_nodes
    rows = np.concatenate([nodes + i * operator.space.nodes for i in range(3)], axis=1)
    i, j = np.repeat(rows, 81, axis=1), np.tile(rows, (1, 81))
    size = 3 * operator.space.nodes
    return sp.coo_matrix((operator.matrices.ravel(), (i.ravel(), j.ravel())), (size, size)).tocsr()


def energy_by_scikit_fem(body: Space, surface: Waviness, field: np.ndarray) -> float:
    """u . K u with scikit-fem's own elasticity on curved 27-node hexahedra through the same nodes."""
    plain = Basis(body.mesh, ElementHex2(), intorder=5)
    curved = MeshHex2(mapped(surface, plain.doflocs), plain.element_dofs)
    basis = Basis(curved, ElementVector(ElementHex2()), intorder=5)
    matrix = linear_elasticity(*lame_parameters(1.0, NU)).assemble(basis)
    owner = np.zeros(basis.N)
    for component in range(3):
        # unknowns of a vector element follow each other node by node
        owner[basis.element_dofs[component::3]] = field[component].ravel()[body.element_nodes.T]
    return float(owner @ matrix @ owner)


def test_flat_energy_equals_scikit_fems() -> None:
    body = small_space()
    field = np.random.default_rng(1).standard_normal((3, *body.shape))
    ours = float(np.vdot(field, Operator(stiffness(body, FLAT, NU), body)(field)))
    # random nodal values: sums of 1e4 terms of order one
    assert ours == pytest.approx(energy_by_scikit_fem(body, FLAT, field), rel=1e-12)


@pytest.mark.parametrize("kind", list(Kind))
def test_load_is_pressure_times_projected_area(kind: Kind) -> None:
    """Down: area of the half element, 2. Along x: the integral of dz/dx, a difference of heights."""
    surface = Waviness(20.0, 16.0, 0.2, kind)
    load = patch_load(small_space(), surface, EDGES).sum(axis=(1, 2, 3))
    across = np.linspace(0.0, 1.0, 2001)
    middle = 0.5 * (across[1:] + across[:-1])
    rise = surface.height(np.ones_like(middle), middle) - surface.height(-np.ones_like(middle), middle)
    assert load[2] == pytest.approx(-2.0, rel=1e-13)
    assert load[0] == pytest.approx(rise.mean(), rel=1e-6)  # midpoint rule on 2000 intervals


@pytest.mark.parametrize("nu", [0.45])
def test_solver_against_a_direct_one(nu: float) -> None:
    body = small_space()
    surface = Waviness(25.0, 16.0, 0.2)
    operator = Operator(stiffness(body, surface, nu), body)
    load = patch_load(body, surface, EDGES)
    held = np.where(body.outer_boundary(), np.random.default_rng(2).standard_normal((3, *body.shape)), 0.0)
    held[1, :, 0] = 0.0  # the plane of symmetry
    solution = solver.solve(operator, nu, load, held)

    free = np.broadcast_to(~body.outer_boundary(), held.shape).copy()
    free[1, :, 0] = False
    matrix, kept = assembled(operator), np.flatnonzero(free)
    direct = held.ravel().copy()
    direct[kept] = spsolve(matrix[kept][:, kept].tocsc(), (load.ravel() - matrix @ held.ravel())[kept])
    assert solution.residual < 1.1e-8
    # the error is at most the condition number, about 1e3 here, times the residual; measured 1e-8
    assert solution.field.ravel() == pytest.approx(direct, abs=1e-6 * np.abs(direct).max())


def test_a_solver_that_stops_short_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(solver, "ITERATION_LIMIT", 3)
    body = small_space()
    operator = Operator(stiffness(body, FLAT, NU), body)
    with pytest.raises(solver.NotConverged, match="after 3 iterations"):
        solver.solve(operator, NU, patch_load(body, FLAT, EDGES), np.zeros((3, *body.shape)))
