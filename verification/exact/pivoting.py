"""Direct contact solution by principal pivoting: exact up to rounding, with a guaranteed finish.

The complementarity problem ``f >= 0``, ``w = G f + q >= 0``, ``f w = 0`` has one solution for a P-matrix
``G``. Blocks of infeasible elements are exchanged while that reduces their number; when it does not, single
exchanges of the last infeasible index follow (Murty 1974), which end for every P-matrix.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from refimpl.grid import Array, Mask

_PATIENCE = 10  # block exchanges without progress before single ones; Judice and Pires (1994) use 10

_LIMIT = 20  # exchanges per element; only a matrix without the P property gets there


class Pivoted(NamedTuple):
    """Solution of a complementarity problem: pressure, its free elements, number of linear solves."""

    pressure: Array
    free: Mask
    solves: int


def complementarity(G: Array, q: Array, free: Mask) -> Pivoted:
    """Solve the problem above from the elements that are ``free`` at first.

    ``G`` has shape ``(n, n)``; ``q`` and ``free`` have shape ``(n,)``. Signs are judged against rounding
    only: ``n eps`` of the maximum pressure, and of the largest gap.

    Raises `ArithmeticError` when ``G`` is no P-matrix and the exchanges do not end.

    >>> complementarity(np.eye(2), np.array([-1.0, 1.0]), np.zeros(2, dtype=bool)).pressure
    array([1., 0.])
    """
    fewest, patience = len(q) + 1, _PATIENCE
    rounding = len(q) * np.finfo(float).eps
    for exchange in range(_LIMIT * (len(q) + 10)):
        pressure = restricted_solve(G, -q, free)
        small, narrow = (rounding * np.abs(v).max(initial=0.0) for v in (pressure, q))
        infeasible = np.where(free, pressure < -small, G @ pressure + q < -narrow)
        count = int(np.count_nonzero(infeasible))
        if count == 0:
            return Pivoted(np.maximum(pressure, 0.0), free, exchange + 1)
        fewest, patience = (count, _PATIENCE) if count < fewest else (fewest, patience - 1)
        if patience <= 0:
            infeasible = np.arange(len(q)) == np.flatnonzero(infeasible)[-1]
        free = free ^ infeasible
    raise ArithmeticError("principal pivoting did not end: the matrix is no P-matrix")


def restricted_solve(G: Array, right: Array, active: Mask) -> Array:
    """Solve ``G f = right`` on the active elements, with ``f = 0`` elsewhere; ``right`` may be a matrix."""
    solution = np.zeros_like(right)
    if active.any():
        index = np.flatnonzero(active)
        solution[index] = np.linalg.solve(G[np.ix_(index, index)], right[index])
    return solution
