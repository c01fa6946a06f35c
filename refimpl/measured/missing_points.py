"""Missing points: filled so that the surface is discretely harmonic there.

Small holes by elimination; large ones, one by one, by conjugate gradients, preconditioned by a multigrid
W-cycle (aggregates of 2 x 2, Galerkin operators: Notay 2010), at a cost proportional to their points.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import scipy
from numpy.typing import NDArray

from refimpl.grid import Array

MAX_ELIMINATED = 4096  # points of one hole: 40 ms by elimination
MAX_TOGETHER = 2**18  # points of all small holes: 0.5 s and 200 MB by elimination
TOLERANCE = 1e-12  # residual over that of the middle height: 1e-9 of the height range around the hole
_MAX_STEPS = 60  # cycles; 22 on 300 x 300 square points
_COARSEST = 16  # points
_DAMPING = 0.7  # damping of Jacobi's smoothing
_OVERCORRECTION = 1.5  # piecewise constant corrections have too much energy

_Index = tuple[NDArray[np.intp], NDArray[np.intp]]


def fill(heights: Array, pixel: tuple[float, float]) -> Array:
    """Return ``heights`` with NaN replaced by the solution of the five-point Laplace equation.

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
    holes, count = scipy.ndimage.label(missing)
    sizes = np.bincount(holes.ravel(), minlength=count + 1)
    large = np.flatnonzero(sizes[1:] > MAX_ELIMINATED) + 1
    small = missing & ~np.isin(holes, large)
    if 0 < np.count_nonzero(small) <= MAX_TOGETHER:
        laplace, right = _equations(heights, small, pixel)
        filled[small] = scipy.sparse.linalg.spsolve(laplace.tocsc(), right)
    elif small.any():
        filled[small] = _iterated(heights, small, pixel)
    places = scipy.ndimage.find_objects(holes) if len(large) else []
    for number in large:
        around = tuple(slice(max(s.start - 1, 0), s.stop + 1) for s in places[number - 1])
        hole = holes[around] == number
        filled[around][hole] = _iterated(filled[around], hole, pixel)
    return filled


def _equations(
    heights: Array, hole: NDArray[np.bool_], pixel: tuple[float, float]
) -> tuple[scipy.sparse.csr_array, Array]:
    """Return the Laplace operator on the points of a hole, and what their known neighbours add."""
    unknown = np.empty(heights.shape, dtype=np.intp)
    unknown[hole] = n = np.arange(np.count_nonzero(hole))
    diagonal, right = np.zeros(len(n)), np.zeros(len(n))
    rows, columns, weights = [n], [n], [diagonal]
    for axis, step in ((0, 1), (0, -1), (1, 1), (1, -1)):
        here, there, coupling = *_neighbours(hole, axis, step), (pixel[0] / pixel[axis]) ** 2
        row = unknown[here]
        diagonal[row] += coupling
        known = ~hole[there]
        right[row[known]] += coupling * heights[there][known]
        rows.append(row[~known])
        columns.append(unknown[there][~known])
        weights.append(np.full(np.count_nonzero(~known), -coupling))
    place = np.concatenate(rows), np.concatenate(columns)
    return scipy.sparse.csr_array((np.concatenate(weights), place)), right


def _neighbours(missing: NDArray[np.bool_], axis: int, step: int) -> tuple[_Index, _Index]:
    """Return the missing points that have a neighbour on that side, and those neighbours."""
    i, j = np.nonzero(missing)
    ni, nj = (i + step, j) if axis == 0 else (i, j + step)
    inside = (ni >= 0) & (ni < missing.shape[0]) & (nj >= 0) & (nj < missing.shape[1])
    return (i[inside], j[inside]), (ni[inside], nj[inside])


def _iterated(heights: Array, hole: NDArray[np.bool_], pixel: tuple[float, float]) -> Array:
    """Return the heights of the points in large holes, between the lowest and the highest of the array."""
    low, high = float(np.nanmin(heights)), float(np.nanmax(heights))
    middle = (low + high) / 2.0
    laplace, right = _equations(np.where(hole, 0.0, heights) - middle, hole, pixel)
    levels = _levels(laplace, np.argwhere(hole))
    cycle = scipy.sparse.linalg.LinearOperator(laplace.shape, lambda r: _cycle(levels, 0, r.ravel()))
    found, left = scipy.sparse.linalg.cg(laplace, right, rtol=TOLERANCE, maxiter=_MAX_STEPS, M=cycle)
    if left:  # long pixels, across which the aggregates smooth little
        found = scipy.sparse.linalg.spsolve(laplace.tocsc(), right)
    return np.asarray(np.clip(middle + found, low, high))


class _Level(NamedTuple):
    """An operator, what smooths its residual, and the aggregate of each of its points."""

    operator: scipy.sparse.csr_array
    smooth: Array
    aggregate: NDArray[np.intp]


def _levels(operator: scipy.sparse.csr_array, places: NDArray[np.intp]) -> list[_Level]:
    """Return Galerkin operators of aggregates of 2 x 2 points; ``places``: (i, j) of each."""
    levels = []
    while True:
        places, aggregate = np.unique(places // 2, axis=0, return_inverse=True)
        aggregate = aggregate.ravel()
        levels.append(_Level(operator, _DAMPING / operator.diagonal(), aggregate))
        if operator.shape[0] <= _COARSEST:
            return levels
        fine = operator.tocoo()
        i, j = aggregate[fine.row], aggregate[fine.col]
        operator = scipy.sparse.csr_array((fine.data, (i, j)), shape=(len(places), len(places)))


def _cycle(levels: list[_Level], depth: int, r: Array) -> Array:
    """Run one W-cycle for ``A u = r`` from zero: symmetric, so that conjugate gradients may use it."""
    operator, smooth, aggregate = levels[depth]
    u = smooth * r
    if depth + 1 == len(levels):
        for _ in range(8):
            u += smooth * (r - operator @ u)
        return u
    u += smooth * (r - operator @ u)
    for _ in range(1 if depth == 0 else 2):
        rest = np.bincount(aggregate, r - operator @ u).astype(float)
        coarse = _cycle(levels, depth + 1, rest)
        u += _OVERCORRECTION * coarse[aggregate]
    for _ in range(2):
        u += smooth * (r - operator @ u)
    return u
