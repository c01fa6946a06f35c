"""General minimisers of the complementary energy: they know a quadratic form and nothing of contact.

Non-negative least squares (Lawson and Hanson 1974; scipy), a bound-constrained quasi-Newton method (Byrd, Lu,
Nocedal and Zhu 1995; scipy's L-BFGS-B) and a proximal interior-point method for quadratic programs (Schwan,
Jiang, Kuhn and Jones 2023; PIQP). The first and the last need the matrix, the second only its products.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from scipy.linalg import cholesky, solve_triangular
from scipy.optimize import minimize, nnls

from refimpl.grid import Array
from verification.framework.case import Unavailable
from verification.variational.energy import Energy

GRADIENT_TOLERANCE = 1e-6  # L-BFGS-B, of the projected gradient: penetration over approach
INTERIOR_TOLERANCE = 1e-10  # PIQP, of its residuals, in units of the approach
_STEPS = 20_000


@dataclass(frozen=True, eq=False)
class Minimum:
    """Unknowns at the minimum, ``(n,)``, what it took, and the approach in units of the energy's own."""

    x: Array
    operations: Mapping[str, float]
    approach: float = 1.0


def least_squares(energy: Energy) -> Minimum:
    """``min |L^T x - L^-1 depth|`` over ``x >= 0`` with ``A = L L^T``: V* up to a constant, by active sets.

    Raises RuntimeError when the exchanges do not end.
    """
    factor = cholesky(energy.matrix(), lower=True, overwrite_a=True, check_finite=False)
    right = solve_triangular(factor, energy.depth, lower=True, check_finite=False)
    x, _ = nnls(factor.T, right, maxiter=10 * len(right))
    n, loaded = len(x), int(np.count_nonzero(x))
    # one Householder column per loaded element, each applied to all columns: 4 n flops apiece at full length
    return Minimum(x, {"unknowns": n, "flops at least": n**3 / 3 + 2.0 * n * n * loaded})


def quasi_newton(energy: Energy) -> Minimum:
    """L-BFGS-B with products by FFT, from the depth itself at its best scale.

    Raises RuntimeError when it ends without meeting the gradient tolerance.
    """

    def value_and_gradient(x: Array) -> tuple[float, Array]:
        displacement = energy.apply(x)
        return 0.5 * float(x @ displacement) - float(x @ energy.depth), displacement - energy.depth

    depth, before = energy.depth, energy.counter.point_logs
    start = depth * float(depth @ depth) / float(depth @ energy.apply(depth))
    found = minimize(
        value_and_gradient,
        start,
        jac=True,
        method="L-BFGS-B",
        bounds=[(0.0, None)] * len(depth),
        options={"gtol": GRADIENT_TOLERANCE, "ftol": 0.0, "maxiter": _STEPS, "maxfun": 2 * _STEPS},
    )
    if not found.success:
        raise RuntimeError(f"L-BFGS-B: {found.message}")
    work = {"unknowns": len(depth), "products": found.nfev + 1, "iterations": found.nit}
    return Minimum(found.x, work | {"n log2 n": energy.counter.point_logs - before})


def interior_point(energy: Energy, load: float | None = None) -> Minimum:
    """PIQP on the dense matrix, at the energy's approach or, with ``load`` (N), under ``sum f dA = load``.

    Under a load the constraint's multiplier is what the approach found exceeds the energy's by. Raises
    `Unavailable` without PIQP, RuntimeError when it does not solve the problem.
    """
    try:
        import piqp
    except ImportError as missing:
        raise Unavailable("PIQP is not installed: the extra 'variational'") from missing
    solver = piqp.DenseSolver()
    settings = solver.settings
    settings.eps_abs = settings.eps_rel = INTERIOR_TOLERANCE
    settings.eps_duality_gap_abs = settings.eps_duality_gap_rel = INTERIOR_TOLERANCE
    matrix, depth, n = np.asfortranarray(energy.matrix()), energy.depth, len(energy.depth)
    lower = np.zeros(n)
    if load is None:
        solver.setup(matrix, -depth, x_l=lower)
    else:
        dA = energy.problem.grid.element_area
        total = load / (dA * float(energy.pressure(np.ones(n)).max()))
        solver.setup(matrix, -depth, np.ones((1, n), order="F"), np.array([total]), x_l=lower)
    status = solver.solve()
    if status != piqp.PIQP_SOLVED:
        raise RuntimeError(f"PIQP ended with status {status}")
    iterations = int(solver.result.info.iter)
    found = 1.0 if load is None else 1.0 - float(solver.result.y[0])
    x = np.where(solver.result.x > solver.result.z_bl, solver.result.x, 0.0)
    work = {"unknowns": n, "iterations": iterations, "flops at least": iterations * n**3 / 3}
    return Minimum(x, work, found)


MINIMISERS: Mapping[str, Callable[[Energy], Minimum]] = {
    "NNLS": least_squares,
    "L-BFGS-B": quasi_newton,
    "PIQP": interior_point,
}
