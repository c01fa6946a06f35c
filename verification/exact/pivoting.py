"""Direct contact solution by principal pivoting: exact up to rounding, with a guaranteed finish.

The complementarity problem ``0 <= f <= H``, ``w = G f + q``, with ``w >= 0`` where ``f = 0``, ``w = 0`` where
``0 < f < H`` and ``w <= 0`` where ``f = H``, has one solution for a P-matrix ``G``; without a cap ``H`` is
infinite. Blocks of infeasible elements are exchanged while that reduces their number; when it does not,
single exchanges of the last infeasible index follow (Murty 1974), which end for every P-matrix, with an upper
bound too (Judice and Pires 1994, Computers Ops Res. 21, 587).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from refimpl.grid import Array, Mask

_PATIENCE = 10  # block exchanges without progress before single ones; Judice and Pires use 10

_LIMIT = 20  # exchanges per element; only a matrix without the P property gets there


class Pivoted(NamedTuple):
    """Solution of a complementarity problem: pressure, its free and capped elements, number of linear
    solves."""

    pressure: Array
    free: Mask
    capped: Mask
    solves: int


def complementarity(
    G: Array, q: Array, free: Mask, cap: float = math.inf, capped: Mask | None = None
) -> Pivoted:
    """Solve the problem above from the elements that are ``free`` and ``capped`` (none by default) at first.

    ``G`` has shape ``(n, n)``; ``q`` and the masks have shape ``(n,)``. Signs are judged against rounding
    only: ``n eps`` of the maximum pressure, and of the largest gap.

    Raises `ArithmeticError` when ``G`` is no P-matrix and the exchanges do not end.

    >>> found = complementarity(np.eye(3), np.array([-1.0, 1.0, -5.0]), np.zeros(3, dtype=bool), cap=2.0)
    >>> found.pressure, found.capped
    (array([1., 0., 2.]), array([False, False,  True]))
    """
    free = free.copy()
    capped = np.zeros_like(free) if capped is None else capped.copy()
    fewest, patience = len(q) + 1, _PATIENCE
    rounding = len(q) * np.finfo(float).eps
    for exchange in range(_LIMIT * (len(q) + 10)):
        at_cap = np.where(capped, cap, 0.0) if capped.any() else 0.0
        push = G @ at_cap + q if capped.any() else q
        pressure = restricted_solve(G, -push, free) + at_cap
        w = G @ pressure + q
        small = rounding * np.abs(pressure).max(initial=0.0)
        narrow = rounding * np.abs(push).max(initial=0.0)
        falls, rises = free & (pressure < -small), free & (pressure > cap + small)
        enters = ~free & np.where(capped, w > narrow, w < -narrow)
        infeasible = falls | rises | enters
        count = int(np.count_nonzero(infeasible))
        if count == 0:
            return Pivoted(np.clip(pressure, 0.0, cap), free, capped, exchange + 1)
        fewest, patience = (count, _PATIENCE) if count < fewest else (fewest, patience - 1)
        if patience <= 0:
            infeasible = np.arange(len(q)) == np.flatnonzero(infeasible)[-1]
        free, capped = (
            (free & ~infeasible) | (enters & infeasible),
            (capped & ~(enters & infeasible)) | (rises & infeasible),
        )
    raise ArithmeticError("principal pivoting did not end: the matrix is no P-matrix")


def restricted_solve(G: Array, right: Array, active: Mask) -> Array:
    """Solve ``G f = right`` on the active elements, with ``f = 0`` elsewhere; ``right`` may be a matrix."""
    solution = np.zeros_like(right)
    if active.any():
        index = np.flatnonzero(active)
        solution[index] = np.linalg.solve(G[np.ix_(index, index)], right[index])
    return solution
