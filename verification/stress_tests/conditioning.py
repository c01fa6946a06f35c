"""Condition numbers of the dense flexibility against the grid, and their cost in digits and iterations."""

from __future__ import annotations

import numpy as np
from scipy.sparse.linalg import cg

from refimpl.grid import Array, Grid
from verification.exact.dense_influence import DenseInfluence

GRIDS = (2, 3, 4, 6, 8, 12, 16, 24, 32, 40)
CG_TOLERANCE = 1e-10


def measure(M: int) -> dict[str, float]:
    """Return the extreme eigenvalues (unit elements), condition number, digits lost by a direct solve, CG
    iterations, about sqrt(condition) ln(2 / tolerance) / 2.

    The right-hand side is formed in long double from known pressures: the solve's error is its own.
    """
    matrix = DenseInfluence(Grid.square(float(M), M), 0.0).normal_matrix
    values = np.linalg.eigvalsh(matrix)
    known = np.random.default_rng(M).random(M * M)
    right = (matrix.astype(np.longdouble) @ known.astype(np.longdouble)).astype(np.float64)
    error = float(np.abs(np.linalg.solve(matrix, right) - known).max() / known.max())
    steps: list[Array] = []
    cg(matrix, right, rtol=CG_TOLERANCE, callback=steps.append)
    return {
        "least": float(values[0]),
        "largest": float(values[-1]),
        "condition": float(values[-1] / values[0]),
        "digits lost by a direct solve": float(np.log10(max(error, 1e-17) / np.finfo(float).eps)),
        "CG iterations": float(len(steps)),
    }


def table() -> dict[str, list[float]]:
    """Return the columns over the grid."""
    rows = [measure(M) for M in GRIDS]
    return {"M": [float(M) for M in GRIDS], **{name: [row[name] for row in rows] for name in rows[0]}}
