"""Missing points: filled so that the surface is discretely harmonic there.

Holes are solved one by one, in the rectangle around each. Small ones by elimination; large ones by conjugate
gradients, preconditioned by a multigrid W-cycle (aggregates of 2 x 2, Galerkin operators: Notay 2010), at a
cost proportional to the rectangle's points.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

from refimpl.grid import Array

MAX_ELIMINATED = 4096  # points of one hole: 40 ms by elimination
MAX_TOGETHER = 2**18  # points of all small holes: 0.5 s and 200 MB by elimination
TOLERANCE = 1e-10  # residual over that of the mean height: 1e-9 of the height range around the hole
_MAX_STEPS = 200
_DAMPING = 0.7  # damping of Jacobi's smoothing
_OVERCORRECTION = 1.5  # piecewise constant corrections have too much energy

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
    holes, count = scipy.ndimage.label(missing)
    sizes = np.bincount(holes.ravel(), minlength=count + 1)
    large = np.flatnonzero(sizes[1:] > MAX_ELIMINATED) + 1
    small = missing & ~np.isin(holes, large)
    if 0 < np.count_nonzero(small) <= MAX_TOGETHER:
        filled[small] = _eliminated(heights, small, pixel)
    elif small.any():
        filled[small] = _iterated(heights, small, pixel)
    places = scipy.ndimage.find_objects(holes) if len(large) else []
    for number in large:
        around = tuple(slice(max(s.start - 1, 0), s.stop + 1) for s in places[number - 1])
        hole = holes[around] == number
        filled[around][hole] = _iterated(filled[around], hole, pixel)
    return filled


def _eliminated(heights: Array, hole: NDArray[np.bool_], pixel: tuple[float, float]) -> Array:
    """Heights of the points in small holes, by sparse elimination."""
    unknown = np.empty(heights.shape, dtype=np.intp)
    unknown[hole] = np.arange(hole.sum())
    diagonal, right = np.zeros(hole.sum()), np.zeros(hole.sum())
    rows, columns, weights = [], [], []
    for axis, step in ((0, 1), (0, -1), (1, 1), (1, -1)):
        here, there, coupling = *_neighbours(hole, axis, step), pixel[axis] ** -2.0
        row = unknown[here]
        diagonal[row] += coupling
        known = ~hole[there]
        right[row[known]] += coupling * heights[there][known]
        rows.append(row[~known])
        columns.append(unknown[there][~known])
        weights.append(np.full(np.count_nonzero(~known), -coupling))
    n = np.arange(len(diagonal))
    place = (np.concatenate([n, *rows]), np.concatenate([n, *columns]))
    laplace = scipy.sparse.csc_array((np.concatenate([diagonal, *weights]), place), shape=(len(n), len(n)))
    return np.asarray(scipy.sparse.linalg.spsolve(laplace, right))


def _neighbours(missing: NDArray[np.bool_], axis: int, step: int) -> tuple[_Index, _Index]:
    """Indices of the missing points that have a neighbour on that side, and of those neighbours."""
    i, j = np.nonzero(missing)
    ni, nj = (i + step, j) if axis == 0 else (i, j + step)
    inside = (ni >= 0) & (ni < missing.shape[0]) & (nj >= 0) & (nj < missing.shape[1])
    return (i[inside], j[inside]), (ni[inside], nj[inside])


def _iterated(heights: Array, hole: NDArray[np.bool_], pixel: tuple[float, float]) -> Array:
    """Heights of one large hole; every point of its rectangle's edge that is not in it is known or unused."""
    known = np.where(hole | np.isnan(heights), 0.0, heights)
    finest = _Level.of(hole, ~hole & ~np.isnan(heights), pixel)
    levels = [finest, *_coarser(finest)]
    around = heights[~hole & ~np.isnan(heights)]
    low, high = float(around.min()), float(around.max())
    u = np.where(hole, (low + high) / 2.0, 0.0)
    right = _right_side(known, hole, pixel)
    r = np.where(hole, right - finest.applied(u), 0.0)
    target = TOLERANCE * float(np.abs(right).max() + np.abs(r).max()) if r.any() else 0.0
    direction, rz_before = np.zeros_like(u), 1.0
    for _ in range(_MAX_STEPS):
        if float(np.abs(r).max()) <= target:
            break
        z = _cycle(levels, 0, r)
        rz = float(np.vdot(r, z))
        direction = z + (rz / rz_before) * direction
        step = finest.applied(direction)
        alpha = rz / float(np.vdot(direction, step))
        u += alpha * direction
        r -= alpha * step
        rz_before = rz
    return np.clip(u[hole], low, high)


@dataclass(frozen=True)
class _Level:
    """A Laplace operator on unknown points: couplings along x and y, and with known points."""

    unknown: NDArray[np.bool_]
    along_x: Array  # between (i, j) and (i + 1, j)
    along_y: Array
    diagonal: Array

    @classmethod
    def of(cls, hole: NDArray[np.bool_], known: NDArray[np.bool_], pixel: tuple[float, float]) -> _Level:
        """The five-point operator on a hole; ``diagonal`` counts the known neighbours as well."""
        usable = hole | known
        wx, wy = _couplings(pixel)
        pairs_x = np.multiply(wx, usable[1:] & usable[:-1] & (hole[1:] | hole[:-1]), dtype=np.float64)
        pairs_y = np.multiply(
            wy, usable[:, 1:] & usable[:, :-1] & (hole[:, 1:] | hole[:, :-1]), dtype=np.float64
        )
        total = _sums(pairs_x, pairs_y, hole.shape)
        inner_x, inner_y = pairs_x * (hole[1:] & hole[:-1]), pairs_y * (hole[:, 1:] & hole[:, :-1])
        return cls(hole, inner_x, inner_y, np.where(hole, total, 1.0))

    def applied(self, u: Array) -> Array:
        """The operator on ``u``, which is zero at known points; zero there."""
        out = self.diagonal * u
        out[:-1] -= self.along_x * u[1:]
        out[1:] -= self.along_x * u[:-1]
        out[:, :-1] -= self.along_y * u[:, 1:]
        out[:, 1:] -= self.along_y * u[:, :-1]
        return out * self.unknown


def _couplings(pixel: tuple[float, float]) -> tuple[float, float]:
    """Weights of neighbours along x and y, over pixel[0]^-2."""
    return 1.0, (pixel[0] / pixel[1]) ** 2


def _right_side(known: Array, hole: NDArray[np.bool_], pixel: tuple[float, float]) -> Array:
    """Known neighbours' heights (zero where there are none) times their couplings."""
    right, (wx, wy) = np.zeros_like(known), _couplings(pixel)
    right[:-1] += wx * known[1:]
    right[1:] += wx * known[:-1]
    right[:, :-1] += wy * known[:, 1:]
    right[:, 1:] += wy * known[:, :-1]
    return np.where(hole, right, 0.0)


def _sums(along_x: Array, along_y: Array, shape: tuple[int, int]) -> Array:
    total = np.zeros(shape)
    total[:-1] += along_x
    total[1:] += along_x
    total[:, :-1] += along_y
    total[:, 1:] += along_y
    return total


def _coarser(level: _Level) -> Iterator[_Level]:
    """Galerkin operators of aggregates of 2 x 2 points, down to a few points."""
    while min(level.unknown.shape) > 2 and np.count_nonzero(level.unknown) > 16:
        own = np.where(level.unknown, level.diagonal, 0.0) - _sums(
            level.along_x, level.along_y, level.unknown.shape
        )
        unknown = _blocks(level.unknown.astype(float)) > 0
        along_x = _pairs(level.along_x[1::2])[: unknown.shape[0] - 1]
        along_y = _pairs(level.along_y[:, 1::2].T).T[:, : unknown.shape[1] - 1]
        diagonal = _blocks(own) + _sums(along_x, along_y, unknown.shape)
        level = _Level(unknown, along_x, along_y, np.where(unknown & (diagonal > 0), diagonal, 1.0))
        yield level


def _blocks(values: Array) -> Array:
    """Sums of blocks of 2 x 2."""
    nx, ny = values.shape
    even = np.pad(values, ((0, nx % 2), (0, ny % 2)))
    return even[::2, ::2] + even[1::2, ::2] + even[::2, 1::2] + even[1::2, 1::2]


def _pairs(values: Array) -> Array:
    """Sums of two neighbours along y."""
    even = np.pad(values, ((0, 0), (0, values.shape[1] % 2)))
    return even[:, ::2] + even[:, 1::2]


def _cycle(levels: list[_Level], depth: int, r: Array) -> Array:
    """One W-cycle for ``A u = r`` from zero: symmetric, so that conjugate gradients may use it."""
    level = levels[depth]
    smooth = _DAMPING * level.unknown / level.diagonal
    u = smooth * r
    if depth + 1 == len(levels):
        for _ in range(8):
            u += smooth * (r - level.applied(u))
        return u
    u += smooth * (r - level.applied(u))
    for _ in range(1 if depth == 0 else 2):
        coarse = _cycle(levels, depth + 1, _blocks((r - level.applied(u)) * level.unknown))
        spread = np.repeat(np.repeat(coarse, 2, axis=0), 2, axis=1)[: u.shape[0], : u.shape[1]]
        u += _OVERCORRECTION * spread * level.unknown
    for _ in range(2):
        u += smooth * (r - level.applied(u))
    return u
