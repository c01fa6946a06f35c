"""Influence integrals at all offsets of a grid, tabulated once and shared by every grid and level.

The integrals are homogeneous of degree one in length, so one table of elements ``1 x aspect`` serves all
grids with that ratio of edges.
"""

from __future__ import annotations

from collections import OrderedDict

import numpy as np
from numpy.typing import NDArray

from refimpl.grid import Array
from refimpl.kernels import normal_table, tangential_table

_TABLES = {"normal": normal_table, "tangential": tangential_table}
_SHARED = 4  # ratio of sides up to which a table is square: windows of all these shapes share it
_KEPT = 8  # tables kept, the last used ones; a square grid needs two
_LARGEST = 4_000_000  # entries of a table that is kept: 32 MB each, 256 MB with `_KEPT`
_cache: OrderedDict[tuple[str, float, bool], Array] = OrderedDict()


def unit_table(kind: str, shape: tuple[int, int], aspect: float = 1.0) -> Array:
    """Return a read-only table of ``I[1/rho]`` ("normal") or ``I[x/rho^2]`` ("tangential").

    Entry ``[i, j]`` belongs to the offset ``(i, j aspect)`` from an element of edges ``1 x aspect``.
    """
    n, m = shape
    if max(n, m) <= _SHARED * min(n, m):
        n = m = max(n, m)
    key = kind, aspect, n >= m
    table = _cache.pop(key, None)
    if table is None or table.shape[0] < n or table.shape[1] < m:
        if table is not None:
            n, m = max(n, table.shape[0]), max(m, table.shape[1])
        table = _TABLES[kind](n, m, 1.0, aspect, known=table)
        table.flags.writeable = False
    if table.size <= _LARGEST:
        _cache[key] = table
    while len(_cache) > _KEPT:
        _cache.popitem(last=False)
    return table[: shape[0], : shape[1]]


def signed_table(kind: str, rows: NDArray[np.int_], columns: NDArray[np.int_], aspect: float = 1.0) -> Array:
    """Return the table's values at signed integer offsets ``rows[:, None], columns[None, :]``."""
    i, j = np.abs(rows), np.abs(columns)
    values: Array = unit_table(kind, (1 + int(i.max()), 1 + int(j.max())), aspect)[np.ix_(i, j)]
    return values * np.sign(rows)[:, None].astype(np.float64) if kind == "tangential" else values
