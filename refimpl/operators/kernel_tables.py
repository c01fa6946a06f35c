"""Influence coefficients of the unit grid, tabulated once and shared by every grid and level.

The integrals are homogeneous of degree one in length, so one table of unit elements serves all.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from refimpl.grid import Array
from refimpl.kernels import normal_table, tangential_table

_TABLES = {"normal": normal_table, "tangential": tangential_table}
_cache: dict[str, Array] = {}


def unit_table(kind: str, n: int) -> Array:
    """Read-only ``(n, n)`` table of ``I[1/rho]`` ("normal") or ``I[x/rho^2]`` ("tangential").

    Entry ``[i, j]`` belongs to the offset ``(i, j)`` from a unit square element. The largest table
    asked for so far is kept, and smaller ones are views of it.
    """
    table = _cache.get(kind)
    if table is None or len(table) < n:
        table = _TABLES[kind](n, n, 1.0, known=table)
        table.flags.writeable = False
        _cache[kind] = table
    return table[:n, :n]


def signed_table(kind: str, rows: NDArray[np.int_], columns: NDArray[np.int_]) -> Array:
    """The table's values at signed integer offsets ``rows[:, None], columns[None, :]``."""
    n = 1 + int(max(np.abs(rows).max(), np.abs(columns).max()))
    values: Array = unit_table(kind, n)[np.ix_(np.abs(rows), np.abs(columns))]
    return values * np.sign(rows)[:, None].astype(np.float64) if kind == "tangential" else values
