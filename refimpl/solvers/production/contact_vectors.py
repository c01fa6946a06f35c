"""The elements that CG works on: fields on few of them are lists, on many whole windows, zero elsewhere."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from refimpl.grid import Array
from refimpl.model.friction import Mask

_FEW = 0.35  # share of a window up to which lists are quicker: 0.35 measured at 256 elements, 0.45 at 512


class Support:
    """A contact set, and fields on it.

    Lists have the shape ``(1, n)``, so that whatever is done to windows can be done to them.

    >>> support = Support(np.array([[False, True, False, False, False]]))
    >>> support.of(np.arange(5.0)[None, :])
    array([[1.]])
    >>> support.onto(np.array([[7.0]]))
    array([[0., 7., 0., 0., 0.]])
    """

    def __init__(self, contact: Mask) -> None:
        self._contact = contact.copy()
        self._index: NDArray[np.intp] | None = None
        if np.count_nonzero(contact) <= _FEW * contact.size:
            self._index = np.flatnonzero(contact)[None, :]

    def ones(self) -> Array:
        """One on each element."""
        return self._contact.astype(np.float64) if self._index is None else np.ones(self._index.shape)

    def of(self, field: Array) -> Array:
        """A field's values on the elements, for keeps."""
        return field * self._contact if self._index is None else field.take(self._index)

    def seen(self, field: Array) -> Array:
        """The same, to be read only, of a field that is zero elsewhere or will meet one that is."""
        return field if self._index is None else field.take(self._index)

    def onto(self, values: Array) -> Array:
        """The window of values on the elements, zero elsewhere."""
        if self._index is None:
            return values
        window = np.zeros(self._contact.shape)
        window.ravel()[self._index] = values
        return window

    def where(self, marked: Mask) -> Mask:
        """The window's mask of the elements that are marked."""
        if self._index is None:
            return marked
        window = np.zeros(self._contact.shape, dtype=bool)
        window.ravel()[self._index] = marked
        return window
