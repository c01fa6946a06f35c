"""Direct contact solution by principal pivoting: exact up to rounding, with a guaranteed finish.

The linear complementarity problem ``f >= 0, w = G f + q >= 0, f w = 0`` with a P-matrix ``G`` has
one solution. Blocks of infeasible elements are exchanged while that reduces their number; when it
does not, single exchanges of the last infeasible index (Murty 1974) follow, which end for every
P-matrix (Judice and Pires 1994, Computers Ops Res. 21, 587).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from refimpl.grid import Array, Mask

_PATIENCE = 10  # block exchanges without progress before single ones; Judice and Pires use 10

_LIMIT = 20  # exchanges per element; only a matrix without the P property gets there


class Pivoted(NamedTuple):
    """Solution of a complementarity problem: pressure, its support, and the linear solves it took."""

    pressure: Array
    active: Mask
    solves: int


def complementarity(G: Array, q: Array, start: Mask) -> Pivoted:
    """Solve ``f >= 0, G f + q >= 0, f (G f + q) = 0`` from the support ``start``.

    ``G`` has shape ``(n, n)``, ``q`` and ``start`` have shape ``(n,)``. Signs are judged against
    rounding only: ``n eps`` of the maximum pressure, and of the largest gap.

    Raises `ArithmeticError` when ``G`` is no P-matrix and the exchanges do not end.

    >>> complementarity(np.eye(2), np.array([-1.0, 1.0]), np.array([False, False])).pressure
    array([1., 0.])
    """
    active = start.copy()
    fewest, patience = len(q) + 1, _PATIENCE
    rounding = len(q) * np.finfo(float).eps
    for exchange in range(_LIMIT * (len(q) + 10)):
        pressure = restricted_solve(G, -q, active)
        w = G @ pressure + q
        infeasible = np.where(
            active,
            pressure < -rounding * np.abs(pressure).max(initial=0.0),
            w < -rounding * np.abs(q).max(initial=0.0),
        )
        count = int(np.count_nonzero(infeasible))
        if count == 0:
            return Pivoted(np.maximum(pressure, 0.0), active, exchange + 1)
        if count < fewest:
            fewest, patience = count, _PATIENCE
        else:
            patience -= 1
        if patience > 0:
            active ^= infeasible
        else:
            last = np.flatnonzero(infeasible)[-1]
            active[last] = not active[last]
    raise ArithmeticError("principal pivoting did not end: the matrix is no P-matrix")


def restricted_solve(G: Array, right: Array, active: Mask) -> Array:
    """Solve ``G f = right`` on the active elements, with ``f = 0`` elsewhere; ``right`` may be a matrix."""
    solution = np.zeros_like(right)
    if active.any():
        index = np.flatnonzero(active)
        solution[index] = np.linalg.solve(G[np.ix_(index, index)], right[index])
    return solution
