"""A preconditioner that lets residuals go on beyond the contact's edge.

The best one on a contact set S, the inverse of ``a`` restricted to it, is ``E' W E``: with ``W`` the inverse
on the whole plane, and ``E`` the continuation of a field from S to the plane that has the least energy
``e.(W e)``. A mask, which is the continuation by zero, falls off a cliff at every edge. Here an element
outside takes the mean of its neighbours in S, the nearer the more; neighbours outside hold it back a little.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from refimpl.grid import Array
from refimpl.model.friction import Mask
from refimpl.solvers.production.projected_cg import Apply

_REACH = 2  # elements; the eight nearest alone spare three quarters of the CG steps that two spare
_WORTHWHILE = 8_000  # elements of a window: on fewer, set-up and passes cost what the steps spared are worth
_AMPLE = 16_000  # elements from which a twentieth of the steps is worth more neighbours


class _Neighbours(NamedTuple):
    """Who is asked: steps ``(2, n)`` in elements, weights ``(n,)``, and what those outside hold back.

    ``held`` is the share of what neighbours outside would hold back if they stayed at zero.
    """

    steps: NDArray[np.intp]
    weights: Array
    held: float

    @classmethod
    def within(cls, squared: int, held: float) -> _Neighbours:
        """Those up to a squared distance, by one over the distance."""
        along, across = np.indices((2 * _REACH + 1,) * 2).reshape(2, -1) - _REACH
        squares = along**2 + across**2
        near = (squares > 0) & (squares <= squared)
        distances: Array = np.sqrt(squares[near], dtype=np.float64)
        return cls(np.array([along[near], across[near]]), 1 / distances, held)


_TWELVE = _Neighbours.within(4, held=0.5)  # 0.5 to 0.7 take as many steps
_TWENTY = _Neighbours.within(5, held=0.3)  # 0.25 to 0.5, or weights by its square, do within 2 %


def extended(precondition: Apply, contact: Mask) -> Apply:
    """The preconditioner with residuals continued beyond a contact, where that is worthwhile."""
    return ExtendedPreconditioner(precondition, contact) if contact.size >= _WORTHWHILE else precondition


class ExtendedPreconditioner:
    """``E' W E`` for a contact set; ``precondition`` is W.

    Symmetric and positive definite on any other set as well, so CG may exchange elements: ``E`` differs from
    the identity by what goes from S out of it, which leaves it invertible. It is kept as pairs of an element
    of S at its edge and one beyond: a sparse matrix takes longer to make than all its products.
    """

    def __init__(self, precondition: Apply, contact: Mask) -> None:
        self._precondition = precondition
        steps, weights, held = _TWENTY if contact.size >= _AMPLE else _TWELVE
        n, m = contact.shape
        width = m + 2 * _REACH
        inside, outside = np.zeros((2, n + 2 * _REACH, width), dtype=bool)
        window = slice(_REACH, n + _REACH), slice(_REACH, m + _REACH)
        inside[window], outside[window] = contact, ~contact
        edge = np.flatnonzero(inside.ravel() & _near(outside.ravel(), width))
        around = edge[:, None] + (steps[0] * width + steps[1])
        paired = np.flatnonzero(outside.take(around))
        outer = around.take(paired)
        self._from, step = np.divmod(paired, weights.size)
        asking = weights.take(step)
        asked = np.bincount(outer, asking, minlength=outside.size)
        beyond = np.flatnonzero(asked > 0)
        number = np.empty(outside.size, dtype=np.intp)
        number[beyond] = np.arange(beyond.size)
        self._to = number.take(outer)
        asking /= ((1 - held) * asked + held * weights.sum()).take(outer)
        self._weights = asking
        self._edge, self._beyond = (
            place - (width - m) * (place // width) - _REACH * (m + 1) for place in (edge, beyond)
        )
        self._source = self._edge.take(self._from)

    def __call__(self, residual: Array) -> Array:
        """The preconditioned residual, same shape; the caller masks argument and result.

        An element that has come into contact since has a residual of its own, and goes on with that.
        """
        own = residual.take(self._beyond)
        free = own == 0
        own += free * np.bincount(self._to, self._weights * residual.take(self._source))
        continued = residual.copy()
        continued.put(self._beyond, own)
        found = np.ascontiguousarray(self._precondition(continued))
        back = (free * found.take(self._beyond)).take(self._to)
        found.ravel()[self._edge] += np.bincount(self._from, self._weights * back, self._edge.size)
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
