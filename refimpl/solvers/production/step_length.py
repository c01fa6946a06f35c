"""Steps that would make pressures negative: how far a step may go, and its trial point cut at zero."""

from __future__ import annotations

import numpy as np

from refimpl.grid import Array, inner
from refimpl.solvers.production.constants import LOAD_SLACK


def step_share(residual: Array, change: Array, moved: Array) -> float:
    """Return the multiple of a change, which displaces ``moved``, of least energy; 0 for none."""
    curvature = inner(change, moved)
    if curvature == 0:
        change = change / (float(np.abs(change).max()) or 1.0)
        curvature = inner(change, moved)
    return inner(residual, change) / curvature if curvature > 0 else 0.0


def longest_step(pressure: Array, change: Array) -> float:
    """Return the multiple of a change at which the first pressure reaches zero."""
    falling = np.flatnonzero(change < 0)
    return float((pressure.take(falling) / -change.take(falling)).min())


def cut_at_zero(trial: Array, pressure: Array, change: Array, weights: Array, target: float | None) -> bool:
    """Cut a trial at zero, set ``change`` to ``trial - pressure``; return False if nothing remains.

    ``weights.trial`` is brought to the target; a small excess is taken from rising pressures alone.
    """
    np.maximum(trial, 0.0, out=trial)
    total = inner(weights, trial)
    if total <= 0:
        return False
    if target is not None and total > (1 + LOAD_SLACK) * target:
        trial *= target / total
        total = target
    np.subtract(trial, pressure, out=change)
    if target is not None and total > target:
        rising = np.maximum(change, 0.0)
        rising *= (total - target) / inner(weights, rising)
        change -= rising
    return True
