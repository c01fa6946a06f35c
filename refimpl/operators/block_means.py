"""Means over blocks of contact elements: a field continued far beyond scattered contact.

The continuation of least energy is the displacement that pressures on the contact alone cause: about an
element it falls as one over the distance, and between many it is their mean. So a block of ``b x b`` elements
with ``c`` of them in contact takes their mean by the share ``c / (c + KAPPA b)``, and the rest from the block
twice as large about it, of which the largest takes its rest from zero. Between blocks' centres values are
bilinear.
"""

from __future__ import annotations

import numpy as np

from refimpl.grid import Array, Mask, Shape, resampled
from refimpl.operators.coarse_grid import CoarseGrid

KAPPA = 8.0  # CG steps on rough 512: 12 without means, 11 at 2, 9 at 4, 8 at 8, 9 at 16, 10 at 32
_LEVELS = 5  # halvings, to blocks of 32
_FINEST = 2  # halvings to the least blocks: those of 2 elements save no step


class BlockMeans:
    """The linear map from fields on a contact to the window, and its transpose."""

    def __init__(self, contact: Mask) -> None:
        self._shape: Shape = (contact.shape[0], contact.shape[1])
        self._grid = CoarseGrid.under(self._shape, lambda d: np.maximum(1 - np.abs(d), 0.0), -0.5, 2)
        self._weights: list[Array] = []
        self._rests: list[Array] = []
        for level, count in enumerate(self._sums(contact.astype(np.float64)), _FINEST):
            reduced = count + KAPPA * 2**level
            self._weights.append(1 / reduced)
            self._rests.append(KAPPA * 2**level / reduced)

    def continued(self, field: Array) -> Array:
        """Return the means of a field that vanishes outside the contact, on the whole window."""
        parts = [sums * weights for sums, weights in zip(self._sums(field), self._weights, strict=True)]
        found = parts.pop()
        while parts:
            found = self._rests[len(parts) - 1] * _doubled(found)
            found += parts.pop()
        return self._grid.interpolate(np.pad(found, 1), self._shape)

    def transposed(self, field: Array) -> Array:
        """Return the sum over a field on the window of what `continued` would take from each element."""
        left = self._grid.spread(field)[1:-1, 1:-1]
        parts = []
        for weights, rest in zip(self._weights, self._rests, strict=True):
            parts.append(left * weights)
            left = _halved(_halved(left * rest).T).T if len(parts) < len(self._weights) else left
        found = parts.pop()
        while parts:
            found = parts.pop() + _repeated(found)
        for _ in range(_FINEST):
            found = _repeated(found)
        n, m = self._shape
        return found[:n, :m]

    def _sums(self, field: Array) -> list[Array]:
        """Return the sums over blocks, from the least ones on."""
        room = [(0, -n % 2**_LEVELS) for n in self._shape]  # zeros up to whole blocks
        sums = [np.pad(field, room) if any(more for _, more in room) else field]
        for _ in range(_LEVELS):
            last = sums[-1][::2] + sums[-1][1::2]
            sums.append(last[:, ::2] + last[:, 1::2])
        return sums[_FINEST:]


def _doubled(values: Array) -> Array:
    n, m = values.shape
    return resampled(values, (2 * n, 2 * m))


def _halved(values: Array) -> Array:
    """Return half as many rows: along both axes the transpose of `_doubled`."""
    found = 0.75 * (values[::2] + values[1::2])
    quarter = 0.25 * values
    found[:-1] += quarter[2::2]
    found[1:] += quarter[1:-1:2]
    found[0] += quarter[0]
    found[-1] += quarter[-1]
    return found


def _repeated(values: Array) -> Array:
    return np.repeat(np.repeat(values, 2, axis=0), 2, axis=1)
