"""Displacement and pressure apart (Taylor-Hood): a second formulation, accurate as nu -> 1/2."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import bmat
from skfem import Basis, BilinearForm, ElementTriP1, ElementTriP2
from skfem.element import ElementTriP3

from appendix_a.fem.body import solve_fixed
from appendix_a.fem.elasticity import PlaneStrain

Array = NDArray[np.float64]
PRESSURE_ELEMENTS = {2: ElementTriP1, 3: ElementTriP2, 4: ElementTriP3}


@BilinearForm
def _divergence_x(u, q, w):  # type: ignore[no-untyped-def]  # scikit-fem calls it with its own untyped fields
    return u.grad[0] * q


@BilinearForm
def _divergence_y(u, q, w):  # type: ignore[no-untyped-def]  # as above
    return u.grad[1] * q


@BilinearForm
def _mass(p, q, w):  # type: ignore[no-untyped-def]  # as above
    return p * q


def displacements(body: PlaneStrain, nu: float) -> Array:
    """Solve 2 mu eps(u) : eps(v) - p div v; q div u + p q / lambda = 0 for (2, n), 0 < nu <= 0.5."""
    basis = body.basis
    pressure = Basis(body.mesh, PRESSURE_ELEMENTS[body.order](), quadrature=basis.quadrature)
    mu = 0.5 / (1.0 + nu)
    xx, xy, yy = body.scalar_matrices
    div_x, div_y = (form.assemble(basis, pressure) for form in (_divergence_x, _divergence_y))
    compliance = (1.0 + nu) * (1.0 - 2.0 * nu) / nu * _mass.assemble(pressure)
    system = bmat(
        [
            [mu * (2 * xx + yy), mu * xy, -div_x.T],
            [mu * xy.T, mu * (xx + 2 * yy), -div_y.T],
            [-div_x, -div_y, -compliance],
        ],
        format="csc",
    )
    n = basis.N
    load = np.concatenate([body.load.ravel(), np.zeros(pressure.N)])
    solution = solve_fixed(system, load, *body.far_field(nu), definite=False)
    return solution[: 2 * n].reshape(2, n)
