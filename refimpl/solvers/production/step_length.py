"""Trial pressures that go below zero: how far a step has room, and what a cut leaves of it at the load."""

from __future__ import annotations

import numpy as np

from refimpl.grid import Array, inner

_LITTLE = 1e-3  # of the load: from 1e-2 to 1e-4 CG takes as many steps, within half a per cent


def room(pressure: Array, change: Array) -> float:
    """The multiple of a change at which the first pressure reaches zero."""
    falling = np.flatnonzero(change < 0)
    return float((pressure.take(falling) / -change.take(falling)).min())


def cut_at_zero(trial: Array, pressure: Array, change: Array, weights: Array, target: float | None) -> bool:
    """Cut a trial at zero, and ``change`` to what leads there from ``pressure``; False if nothing stays.

    ``weights.trial`` is brought to the target, if there is one. Load that the cut adds is taken from all
    pressures; a little only from those that rise, as scaling the rest as well would stir up what has long
    settled.
    """
    np.maximum(trial, 0.0, out=trial)
    total = inner(weights, trial)
    if total <= 0:
        return False
    if target is not None and total > (1 + _LITTLE) * target:
        trial *= target / total
        total = target
    np.subtract(trial, pressure, out=change)
    if target is not None and total > target:
        rising = np.maximum(change, 0.0)
        rising *= (total - target) / inner(weights, rising)
        change -= rising
    return True
