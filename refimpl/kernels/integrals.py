"""The two integrals at arbitrary points, and at all offsets ``(i dx, j dy)`` of a grid, slab by slab.

At integer offsets ``q_x = 2i`` and ``q_y = 2j`` whatever the aspect ratio, so the order of the rule depends
on the index alone. A slab of rows ``i0 <= i < i1`` with the columns ``j < i1`` takes x as the outer axis
and the order of ``2 i0``; the columns ``j0 <= j < j1`` with the rows ``i < j0`` take y. Slabs are small
enough for their temporaries to stay in cache.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from refimpl.errors import InputError, is_whole, require_number
from refimpl.kernels.cerruti import CERRUTI
from refimpl.kernels.love import LOVE
from refimpl.kernels.quadrature import NEAR, Kernel, across, order_for, shells

Array = NDArray[np.float64]
_NEAR_COUNT = int(np.ceil(NEAR / 2))  # offsets served by the closed form: 2i < NEAR
_SLAB = 16384  # evaluations: 128 kB per temporary


def normal_integral(x: ArrayLike, y: ArrayLike, dx: float, dy: float) -> Array:
    """Return the integral of 1/rho over the centred ``dx`` by ``dy`` rectangle, seen from ``(x, y)``.

    ``x`` and ``y`` broadcast; the result has their common shape and the unit of length. Even in x and in y.
    Relative error at most 1e-13. Raises ``InputError`` unless edges are positive and everything finite.

    >>> bool(np.isclose(normal_integral(0.0, 0.0, 1.0, 1.0), 4 * np.arcsinh(1.0), rtol=1e-15))  # its centre
    True
    >>> bool(np.isclose(normal_integral(3e6, 4e6, 1.0, 1.0), 1 / 5e6, rtol=1e-13))  # a point load
    True
    """
    x, y = _points(x, y)
    unit = scale(dx, dy)
    return unit * _evaluate(LOVE, np.abs(x) / unit, np.abs(y) / unit, dx / unit, dy / unit)


def tangential_integral(x: ArrayLike, y: ArrayLike, dx: float, dy: float) -> Array:
    """Return the integral of s/rho^2, ``s = x - xi``, over the centred ``dx`` by ``dy`` rectangle.

    ``x`` and ``y`` broadcast; the result has their common shape and the unit of length. Odd in x, exactly 0
    at x = 0, even in y. Relative error at most 1e-13, close to x = 0 too. Raises ``InputError`` as
    ``normal_integral``.

    >>> tangential_integral([-1.0, 0.0, 1.0], 0.0, 1.0, 1.0)
    array([-0.98457246,  0.        ,  0.98457246])
    """
    x, y = _points(x, y)
    unit = scale(dx, dy)
    return np.copysign(unit, x) * _evaluate(CERRUTI, np.abs(x) / unit, np.abs(y) / unit, dx / unit, dy / unit)


def scale(dx: float, dy: float) -> float:
    """Return the power of two above the larger edge; `InputError` unless both are positive and finite."""
    edges: dict[str, Any] = {"dx": dx, "dy": dy}
    for name, edge in edges.items():
        one = edge.item() if isinstance(edge, np.ndarray) and edge.ndim == 0 else edge
        require_number(name, one, "a positive finite length, one number", above=0)
    return float(np.ldexp(1.0, np.frexp(float(max(dx, dy)))[1]))


def _points(x: ArrayLike, y: ArrayLike) -> tuple[Array, Array]:
    x, y = _lengths("x", x), _lengths("y", y)
    try:
        x, y = np.broadcast_arrays(x, y)
    except ValueError as refused:
        raise InputError("y", np.shape(y), f"a shape that goes with that of x, {np.shape(x)}") from refused
    return x, y


def _lengths(name: str, given: ArrayLike) -> Array:
    try:
        lengths = np.asarray(given, dtype=np.float64)
    except (TypeError, ValueError) as refused:
        raise InputError(name, given, "finite lengths") from refused
    if not np.isfinite(lengths).all():
        raise InputError(name, lengths[~np.isfinite(lengths)][0], "finite lengths")
    return lengths


def _evaluate(kernel: Kernel, x: Array, y: Array, dx: float, dy: float) -> Array:
    """Return the kernel at ``x, y >= 0``: near in closed form, farther by the fewest points that suffice."""
    q_x, q_y = 2 * x / dx, 2 * y / dy
    q = np.maximum(q_x, q_y)
    integral = np.empty(q.shape)
    near = q < NEAR
    integral[near] = kernel.closed_form(x[near], y[near], dx, dy)
    for start, end, order in shells():
        in_shell = (start <= q) & (q < end)
        if not in_shell.any():
            continue
        outer_x, outer_y = in_shell & (q_x >= q_y), in_shell & (q_x < q_y)
        integral[outer_x] = across(kernel.over_x, x[outer_x], y[outer_x], dx, dy, order)
        integral[outer_y] = across(kernel.over_y, y[outer_y], x[outer_y], dy, dx, order)
    return integral


def normal_table(n: int, m: int, dx: float, dy: float | None = None, *, known: Array | None = None) -> Array:
    """Return ``normal_integral(i dx, j dy, dx, dy)`` for ``i < n``, ``j < m``, in the unit of ``dx``.

    ``dy = dx`` by default; ``known`` is a smaller table of the same elements, to start from: the result is
    the same to the last bit. Extend evenly to negative offsets. Same accuracy and errors as
    ``normal_integral``.
    """
    dx, dy, unit = _edges(n, m, dx, dy)
    known = None if known is None else known / unit
    if dx != dy:
        table = _table(LOVE, n, m, dx, dy, known)
    elif n < m:
        table = _symmetric_table(LOVE, m, n, dx, None if known is None else known.T).T
    else:
        table = _symmetric_table(LOVE, n, m, dx, known)
    table *= unit
    return table


def tangential_table(
    n: int, m: int, dx: float, dy: float | None = None, *, known: Array | None = None
) -> Array:
    """Return ``tangential_integral(i dx, j dy, dx, dy)`` for ``i < n``, ``j < m``, in the unit of ``dx``.

    ``dy = dx`` by default; ``known`` as for `normal_table`. Extend oddly in x, evenly in y. Same accuracy
    and errors as ``tangential_integral``.
    """
    dx, dy, unit = _edges(n, m, dx, dy)
    table = _table(CERRUTI, n, m, dx, dy, None if known is None else known / unit)
    table *= unit
    return table


def _edges(n: int, m: int, dx: float, dy: float | None) -> tuple[float, float, float]:
    for name, count in (("n", n), ("m", m)):
        if not is_whole(count) or count < 1:
            raise InputError(name, count, "a whole number of offsets, at least 1")
    dy = dx if dy is None else dy
    unit = scale(dx, dy)
    return dx / unit, dy / unit, unit


def _table(kernel: Kernel, n: int, m: int, dx: float, dy: float, known: Array | None) -> Array:
    table, done = _begun(kernel, n, m, dx, dy, known)
    for start, stop in _slabs(n, m, done):
        rows, columns = min(stop, n), min(stop, m)
        if start < n:
            table[start:rows, :columns] = _across_x(kernel, start, rows, columns, dx, dy)
        if start < m:
            table[:start, start:columns] = _across_y(kernel, min(start, n), start, columns, dx, dy)
    return table


def _symmetric_table(kernel: Kernel, n: int, m: int, edge: float, known: Array | None) -> Array:
    """Return the same for square elements, ``n >= m``, and a kernel symmetric in x and y: half the work."""
    table, done = _begun(kernel, n, m, edge, edge, known)
    for start, stop in _slabs(n, m, done):
        columns = min(stop, m)
        rows = _across_x(kernel, start, stop, columns, edge, edge)
        table[start:stop, :columns] = rows
        if start < m:
            table[:start, start:columns] = rows[: columns - start, :start].T
            block = rows[: columns - start, start:]
            below = np.tri(len(block), dtype=bool)
            table[start:columns, start:columns] = np.where(below, block, block.T)
    return table


def _begun(kernel: Kernel, n: int, m: int, dx: float, dy: float, known: Array | None) -> tuple[Array, int]:
    """Return a table with its first corner, known or by the closed form, and the known corner's size.

    All else is NaN, so that no gap between slabs goes unseen.
    """
    table = np.full((n, m), np.nan)
    if known is not None and min(known.shape) >= _NEAR_COUNT:
        rows, columns = min(known.shape[0], n), min(known.shape[1], m)
        table[:rows, :columns] = known[:rows, :columns]
        return table, min(rows, columns)
    x, y = _offsets(0, min(n, _NEAR_COUNT), dx), _offsets(0, min(m, _NEAR_COUNT), dy)
    table[: len(x), : len(y)] = kernel.closed_form(x[:, None], y, dx, dy)
    return table, 0


def _offsets(start: int, stop: int, edge: float) -> Array:
    return np.arange(start, stop, dtype=np.float64) * edge


def _slabs(n: int, m: int, known: int) -> Iterator[tuple[int, int]]:
    """Yield ``[start, stop)`` beyond ``known``, thin near the load, where the order changes fast.

    Where slabs start does not depend on n and m as long as both are larger. So a table that starts from a
    known one is the same to the last bit.
    """
    start = _NEAR_COUNT
    while start < max(n, m):
        evaluations = order_for(2.0 * start) * min(start, n, m)  # per row
        height = min(1 + start // 2, max(1, _SLAB // evaluations))
        stop = min(start + height, max(n, m))
        if stop > known:
            yield start, stop
        start += height


def _across_x(kernel: Kernel, start: int, stop: int, columns: int, dx: float, dy: float) -> Array:
    x, y = _offsets(start, stop, dx), _offsets(0, columns, dy)
    return across(kernel.over_x, x[:, None], y, dx, dy, order_for(2.0 * start))


def _across_y(kernel: Kernel, rows: int, start: int, stop: int, dx: float, dy: float) -> Array:
    x, y = _offsets(0, rows, dx), _offsets(start, stop, dy)
    return across(kernel.over_y, y, x[:, None], dy, dx, order_for(2.0 * start))
