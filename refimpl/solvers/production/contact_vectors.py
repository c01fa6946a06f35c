"""Fields on the contact set, as lists or windows, and steps along them: how far, and cut at zero."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from refimpl.grid import Array, Mask, inner
from refimpl.solvers.production.constants import LIST_SHARE, LOAD_SLACK


class ContactVectors:
    """The vectors of one contact set: lists where it is sparse, else windows that vanish elsewhere.

    Lists have the shape ``(1, n)``, so that code for windows holds for lists as well.

    >>> vectors = ContactVectors(np.array([[False, True, False, False, False]]))
    >>> vectors.gather(np.arange(5.0)[None, :])
    array([[1.]])
    >>> vectors.scatter(np.array([[7.0]]))
    array([[0., 7., 0., 0., 0.]])
    """

    def __init__(self, contact: Mask) -> None:
        self._contact = contact.copy()
        self._index: NDArray[np.intp] | None = None
        if np.count_nonzero(contact) <= LIST_SHARE * contact.size:
            self._index = np.flatnonzero(contact)[None, :]

    def ones(self) -> Array:
        """Return one on each element."""
        return self._contact.astype(np.float64) if self._index is None else np.ones(self._index.shape)

    def gather(self, field: Array) -> Array:
        """Return a copy of a field's values on the contact set."""
        return field * self._contact if self._index is None else field.take(self._index)

    def gather_view(self, field: Array) -> Array:
        """Return values to read only, of a field that vanishes elsewhere or meets one that does."""
        return field if self._index is None else field.take(self._index)

    def scatter(self, values: Array) -> Array:
        """Return the window with these values on the contact set, zero elsewhere."""
        if self._index is None:
            return values
        window = np.zeros(self._contact.shape)
        window.ravel()[self._index] = values
        return window

    def scatter_mask(self, marked: Mask) -> Mask:
        """Return the window's mask of the elements that are marked."""
        if self._index is None:
            return marked
        window = np.zeros(self._contact.shape, dtype=bool)
        window.ravel()[self._index] = marked
        return window


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
