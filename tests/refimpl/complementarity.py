"""Linear complementarity problems by principal pivoting on dense matrices: solutions to hold solvers to."""

from __future__ import annotations

from itertools import count

import numpy as np

from refimpl.grid import Array, Mask

_BLOCKS = 10  # exchanges of all infeasible elements; single ones follow, which end for every P-matrix


def complementarity(G: Array, q: Array, free: Mask) -> tuple[Array, Mask]:
    """Return ``f >= 0`` with ``G f + q >= 0`` and ``f (G f + q) = 0``, and its free elements.

    What is returned meets both inequalities to rounding, and a P-matrix ``G`` has one such ``f``. The last
    infeasible index is exchanged where blocks do not end (Murty 1974). ``free``: elements to begin with.

    >>> complementarity(np.eye(2), np.array([-1.0, 1.0]), np.zeros(2, dtype=bool))
    (array([1., 0.]), array([ True, False]))
    """
    rounding = len(q) * np.finfo(float).eps
    for exchange in count():
        f = restricted_solve(G, -q, free)
        small, narrow = (rounding * np.abs(v).max(initial=0.0) for v in (f, q))
        infeasible = np.where(free, f < -small, G @ f + q < -narrow)
        if not infeasible.any():
            break
        if exchange >= _BLOCKS:
            infeasible[: np.flatnonzero(infeasible)[-1]] = False
        free = free ^ infeasible
    return np.maximum(f, 0.0), free


def restricted_solve(G: Array, right: Array, active: Mask) -> Array:
    """Solve ``G f = right`` on the active elements, with ``f = 0`` elsewhere; ``right`` may be a matrix."""
    solution, index = np.zeros_like(right), np.flatnonzero(active)
    solution[index] = np.linalg.solve(G[np.ix_(index, index)], right[index])
    return solution
