"""Preconditioners: the inverse of the influence of elements on one another, approximately.

`SpectralPreconditioner` is one over the symbol, on a circle without padding. `ExtendedPreconditioner` adds
what happens at the contact's edge: the best preconditioner on a contact set S, the inverse of ``a``
restricted to S, is ``E' W E``, with ``W`` the inverse on the whole plane and ``E`` the continuation of a
field from S to the plane that has the least energy ``e.(W e)``. A mask is the continuation by zero, which
jumps at every edge. Here an element outside takes the weighted mean of its neighbours in S, reduced by its
neighbours outside; what that leaves, and elements further away, is filled from means where contact is sparse.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from refimpl.grid import Array, Mask
from refimpl.operators.block_means import BlockMeans
from refimpl.operators.influence import WindowInfluence
from refimpl.operators.transforms import fourier, threads

Apply = Callable[[Array], Array]
"""A linear map of fields on a window."""

_REACH = 2  # elements; the eight nearest alone save three quarters of the CG steps that two rings save
_WORTHWHILE = 8_000  # elements of a window: on fewer, set-up and passes cost as much as the CG steps saved
_SPARSE = 0.35  # share of a window up to which contact is sparse
_MANY = 100_000  # elements from which means save time: rough, 0.97 at 512 a side, 0.77 at 1024
_SINGLE = 20_000  # numbers of half a spectrum from which single precision pays: 200 x 200 elements
_AMPLE = 16_000  # elements from which 5 % fewer CG steps pay for twenty neighbours instead of twelve


class SpectralPreconditioner:
    """Approximate inverse of ``a`` between the elements of a window, by one over its symbol.

    ``symbol`` is the displacement per pressure on the operator's circle (m/Pa), half along the first axis.
    Restricted to a contact set on both sides the map stays symmetric positive definite. The mean pressure,
    which displaces nothing in a periodic scene, is given half of the longest wave's stiffness.

    Single precision is enough, and quicker on large windows: what CG minimises does not depend on it.
    Stiffnesses and residuals are over their largest, so that no unit exceeds the numbers' range.
    """

    def __init__(self, operator: WindowInfluence, symbol: Array) -> None:
        self._circle, self._counter = operator.circle, operator.counter
        if symbol[0, 0] == 0:
            symbol = symbol.copy()
            symbol[0, 0] = 2 * symbol.max() or 1.0
        self._stiffest = 1 / symbol.min()
        self._precision: Any = np.float32 if symbol.size >= _SINGLE else np.float64
        self._symbol = (symbol.min() / symbol).astype(self._precision)

    def __call__(self, residual: Array) -> Array:
        """Return the preconditioned residual, same shape; the caller masks argument and result."""
        points = math.prod(self._circle)
        self._counter.add("preconditioner", points)
        workers = threads(points)
        largest = max(residual.max(), -residual.min()) or 1.0
        scaled: Array = (residual / largest).astype(self._precision, copy=False)
        spectrum = fourier.plane(scaled, self._circle, workers)
        spectrum *= self._symbol
        n, m = residual.shape
        found = fourier.plane_back(spectrum, self._circle, workers)[:n, :m]
        return np.asarray(np.multiply(found, largest * self._stiffest, dtype=np.float64))


class _Neighbours(NamedTuple):
    """Who is asked: steps ``(2, n)`` in elements, weights ``(n,)``, and what those outside hold back.

    ``held`` is the share of what neighbours outside would hold back if they stayed at zero.
    """

    steps: NDArray[np.intp]
    weights: Array
    held: float

    @classmethod
    def within(cls, squared: int, held: float) -> _Neighbours:
        """Return the weights up to a squared distance, by one over the distance."""
        along, across = np.indices((2 * _REACH + 1,) * 2).reshape(2, -1) - _REACH
        squares = along**2 + across**2
        near = (squares > 0) & (squares <= squared)
        distances: Array = np.sqrt(squares[near], dtype=np.float64)
        return cls(np.array([along[near], across[near]]), 1 / distances, held)


_TWELVE = _Neighbours.within(4, held=0.5)  # 0.5 to 0.7 take as many steps
_TWENTY = _Neighbours.within(5, held=0.3)  # 0.25 to 0.5, or weights by its square, do within 2 %


def extended(precondition: Apply, contact: Mask) -> Apply:
    """Return the preconditioner with residuals continued beyond a contact, where that is worthwhile."""
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
        self._means: BlockMeans | None = None
        if contact.size >= _MANY and np.count_nonzero(contact) <= _SPARSE * contact.size:
            self._means = BlockMeans(contact)
            self._left = (~contact).astype(np.float64)
            self._left.ravel()[self._beyond] -= np.bincount(self._to, self._weights)

    def __call__(self, residual: Array) -> Array:
        """Return the preconditioned residual, same shape; the caller masks argument and result.

        An element that has come into contact since has a residual of its own, and goes on with that.
        """
        own = residual.take(self._beyond)
        free = own == 0
        own += free * np.bincount(self._to, self._weights * residual.take(self._source))
        continued = residual.copy()
        continued.put(self._beyond, own)
        if self._means:
            left = self._left * (residual == 0)
            continued += left * self._means.continued(residual)
        found = np.ascontiguousarray(self._precondition(continued))
        back = (free * found.take(self._beyond)).take(self._to)
        from_edge = np.bincount(self._from, self._weights * back, self._edge.size)
        if self._means:
            found += self._means.transposed(left * found)
        found.ravel()[self._edge] += from_edge
        return found


def _near(marked: Mask, width: int) -> Mask:
    """Mark all within a square's reach of a mark, in rows this long; a frame as wide has no mark."""
    for stride in (1, width):
        near = marked.copy()
        for step in range(stride, _REACH * stride + 1, stride):
            near[step:] |= marked[:-step]
            near[:-step] |= marked[step:]
        marked = near
    return marked
