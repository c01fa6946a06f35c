"""Fields on the contact set: lists where the contact is sparse, whole windows that vanish elsewhere if
not."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from refimpl.grid import Array, Mask
from refimpl.solvers.production.constants import LIST_SHARE


class ContactVectors:
    """The vectors of one contact set.

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
