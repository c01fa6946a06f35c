"""A preconditioner that lets residuals go on beyond the contact's edge.

The best one on a contact set S, the inverse of ``a`` restricted to it, is ``E' W E``: with ``W`` the inverse
on the whole plane, and ``E`` the continuation of a field from S to the plane that has the least energy
``e.(W e)``. A mask, which is the continuation by zero, falls off a cliff at every edge. Here an element
outside takes the mean of its neighbours in S, the nearer the more; neighbours outside hold it back a little.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sparse

from refimpl.contact.projected_cg import Apply
from refimpl.friction import Mask
from refimpl.grid import Array

_REACH = 2  # elements; one spares a third of the CG steps that two spare, four a tenth more
_HELD = 0.3  # of what neighbours outside would hold back if they stayed at zero; 0.15 and 0.5 spare less
_WORTHWHILE = 16_000  # elements of a window: on fewer, set-up and passes cost what the steps spared are worth

_STEPS = [
    (i, j)
    for i in range(-_REACH, _REACH + 1)
    for j in range(-_REACH, _REACH + 1)
    if 0 < i * i + j * j < 2 * _REACH**2
]
_WEIGHTS = np.array([1 / (i * i + j * j) for i, j in _STEPS])


def extended(precondition: Apply, contact: Mask) -> Apply:
    """The preconditioner with residuals continued beyond a contact, where that is worthwhile."""
    return ExtendedPreconditioner(precondition, contact) if contact.size >= _WORTHWHILE else precondition


class ExtendedPreconditioner:
    """``E' W E`` for a contact set; ``precondition`` is W.

    Symmetric and positive definite on any other set as well, so CG may exchange elements: ``E`` differs from
    the identity by what goes from S out of it, which leaves it invertible.
    """

    def __init__(self, precondition: Apply, contact: Mask) -> None:
        self._precondition = precondition
        n, m = contact.shape
        width = m + 2 * _REACH
        inside, outside = np.zeros((2, n + 2 * _REACH, width), dtype=bool)
        window = slice(_REACH, n + _REACH), slice(_REACH, m + _REACH)
        inside[window], outside[window] = contact, ~contact
        edge = np.flatnonzero(inside.ravel() & _near(outside.ravel(), width))
        around = edge[:, None] + np.array([i * width + j for i, j in _STEPS])
        paired = outside.take(around)
        pairs = np.flatnonzero(paired)
        outer = around.take(pairs)
        weights = np.tile(_WEIGHTS, edge.size).take(pairs)
        asked = np.bincount(outer, weights, minlength=outside.size)
        beyond = np.flatnonzero(asked > 0)
        weights /= ((1 - _HELD) * asked + _HELD * _WEIGHTS.sum()).take(outer)
        number = np.empty(outside.size, dtype=np.int32)
        number[beyond] = np.arange(beyond.size)
        ends = np.cumsum(paired.sum(axis=1, dtype=np.int32), dtype=np.int32)
        rows = weights, number.take(outer), np.concatenate([[0], ends])
        self._back = sparse.csr_array(rows, shape=(edge.size, beyond.size))
        self._onward = self._back.T
        self._edge, self._beyond = (
            (place // width - _REACH) * m + place % width - _REACH for place in (edge, beyond)
        )

    def __call__(self, residual: Array) -> Array:
        """The preconditioned residual, same shape; the caller masks argument and result.

        An element that has come into contact since has a residual of its own, and goes on with that.
        """
        own = residual.take(self._beyond)
        free = own == 0
        continued = residual.copy()
        continued.ravel()[self._beyond] = own + free * (self._onward @ residual.take(self._edge))
        found = np.ascontiguousarray(self._precondition(continued))
        found.ravel()[self._edge] += self._back @ (free * found.take(self._beyond))
        return found


def _near(marked: Mask, width: int) -> Mask:
    """Within a square's reach of something marked, in rows this long; a frame as wide is not marked."""
    for stride in (1, width):
        near = marked.copy()
        for step in range(stride, _REACH * stride + 1, stride):
            near[step:] |= marked[:-step]
            near[:-step] |= marked[step:]
        marked = near
    return marked
