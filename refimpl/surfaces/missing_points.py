"""Missing points: filled so that the surface is discretely harmonic there."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_array
from scipy.sparse.linalg import spsolve

from refimpl.grid import Array

_Index = tuple[NDArray[np.intp], NDArray[np.intp]]


def fill(heights: Array, pixel: tuple[float, float]) -> Array:
    """``heights`` with its NaN replaced by the solution of the five-point Laplace equation between the rest.

    A border point lacks the neighbour outside (no slope across the border). Every filled height lies between
    the lowest and the highest around its gap. One point must be there at least; ``pixel``: the two spacings.

    >>> x = np.arange(5.0)
    >>> saddle = x[:, None] ** 2 - x[None, :] ** 2
    >>> holed = saddle.copy(); holed[1:4, 2] = np.nan
    >>> bool(np.allclose(fill(holed, (1.0, 1.0)), saddle, rtol=0, atol=1e-14))
    True
    """
    missing = np.isnan(heights)
    filled = heights.copy()
    if not missing.any():
        return filled
    unknown = np.empty(heights.shape, dtype=np.intp)
    unknown[missing] = np.arange(missing.sum())
    diagonal, right = np.zeros(missing.sum()), np.zeros(missing.sum())
    rows, columns, weights = [], [], []
    for axis, step in ((0, 1), (0, -1), (1, 1), (1, -1)):
        here, there, coupling = *_neighbours(missing, axis, step), pixel[axis] ** -2.0
        row = unknown[here]
        diagonal[row] += coupling
        known = ~missing[there]
        right[row[known]] += coupling * heights[there][known]
        rows.append(row[~known])
        columns.append(unknown[there][~known])
        weights.append(np.full(np.count_nonzero(~known), -coupling))
    n = np.arange(len(diagonal))
    place = (np.concatenate([n, *rows]), np.concatenate([n, *columns]))
    laplace = csc_array((np.concatenate([diagonal, *weights]), place), shape=(len(n), len(n)))
    filled[missing] = spsolve(laplace, right)
    return filled


def _neighbours(missing: NDArray[np.bool_], axis: int, step: int) -> tuple[_Index, _Index]:
    """Indices of the missing points that have a neighbour on that side, and of those neighbours."""
    i, j = np.nonzero(missing)
    ni, nj = (i + step, j) if axis == 0 else (i, j + step)
    inside = (ni >= 0) & (ni < missing.shape[0]) & (nj >= 0) & (nj < missing.shape[1])
    return (i[inside], j[inside]), (ni[inside], nj[inside])
