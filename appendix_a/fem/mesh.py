"""Graded triangulations of a half-plane (or quadrant) by a balanced quadtree.

The mesh lives in reference coordinates (xi, eta), eta >= 0 into the body; `geometry` bends it onto a
rough boundary.  Where the field is rough is said by `Source`s: intervals of the surface eta = 0 with a
cell size at them and a growth of the cell size with distance.  The stress of a strip of pressure has a
logarithm at the strip's ends, so point sources with a tiny size sit there (geometric grading); a
waviness is an interval source with a size of a fraction of its wavelength.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from skfem import MeshTri

Array = NDArray[np.float64]
Cells = NDArray[np.int64]  # (n, 3): column, row and size, in units of the finest cell


@dataclass(frozen=True)
class Source:
    """A surface interval [left, right] with cells of at most `size`, growing by `growth` per distance."""

    left: float
    right: float
    size: float
    growth: float

    def limit(self, x0: Array, y0: Array, size: Array) -> Array:
        """Return the largest allowed size of cells [x0, x0 + size] x [y0, y0 + size]."""
        apart = np.maximum(np.maximum(self.left - (x0 + size), x0 - self.right), 0.0)
        return np.maximum(self.size, self.growth * np.hypot(apart, y0))


def graded_mesh(
    sources: Sequence[Source], radius: float, *, centred: bool = True, quadrant: bool = False
) -> MeshTri:
    """Return conforming triangles over [-radius, radius] x [0, radius], or [0, radius]^2 for a `quadrant`.

    `radius` is a power of two, so that every dyadic point of the surface (0, +-1, ...) is a vertex
    wherever cells are small enough.  Lengths in any one unit.  The mesh of a half-plane with symmetric
    sources is mirror symmetric.
    """
    unit = 2.0 ** np.floor(np.log2(min(s.size for s in sources)))
    root = round(radius / unit)
    lefts = (0,) if quadrant else (-root, 0)
    cells = np.array([(left, 0, root) for left in lefts], dtype=np.int64)
    done = []
    while len(cells):
        x0, y0, size = (cells * unit).T
        limit = np.min([s.limit(x0, y0, size) for s in sources], axis=0)
        too_large = (size > limit) & (cells[:, 2] > 1)
        done.append(cells[~too_large])
        cells = _split(cells[too_large])
    leaves = _balanced(np.concatenate(done))
    points, triangles = _triangulated(leaves, centred)
    return MeshTri((points * unit).T.copy(), triangles.T.copy())


def _split(cells: Cells) -> Cells:
    half = cells[:, 2] // 2
    corners = [(cells[:, 0] + i * half, cells[:, 1] + j * half) for i in (0, 1) for j in (0, 1)]
    return np.concatenate([np.column_stack([*corner, half]) for corner in corners])


def _key(column: NDArray[np.int64], row: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return one integer per lattice point; coordinates stay below 2^30 in `graded_mesh`."""
    return (column << 31) + row


def _balanced(leaves: Cells) -> Cells:
    """Split leaves until cells that share an edge differ by one level at most."""
    while True:
        by_size = {int(s): leaves[leaves[:, 2] == s] for s in np.unique(leaves[:, 2])}
        keys = {s: _key(c[:, 0], c[:, 1]) for s, c in by_size.items()}
        split_keys: dict[int, list[NDArray[np.int64]]] = {s: [] for s in by_size}
        for s, cells in by_size.items():
            for di, dj in ((s, 0), (-1, 0), (0, s), (0, -1)):
                column, row = cells[:, 0] + di, cells[:, 1] + dj
                for big in (b for b in by_size if b >= 4 * s):
                    split_keys[big].append(_key(column // big * big, row // big * big))
        kept, cut = [], []
        for s, cells in by_size.items():
            wanted = np.isin(keys[s], np.concatenate([*split_keys[s], np.empty(0, np.int64)]))
            kept.append(cells[~wanted])
            cut.append(cells[wanted])
        marked = np.concatenate(cut)
        if not len(marked):
            return leaves
        leaves = np.concatenate([*kept, _split(marked)])


def _triangulated(leaves: Cells, centred: bool) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Return each leaf's fan about an apex; an edge with a hanging vertex counts as two.

    The apex is the leaf's centre.  Not `centred`, it is the hanging vertex where there is just one, and
    a lower corner, on the side of x = 0, where there is none: about half as many triangles.
    """
    column, row, size = (2 * leaves).T  # doubled, so that centres and edge midpoints are lattice points
    ring = [(column, row), (column + size, row), (column + size, row + size), (column, row + size)]
    corners = np.array([_key(*c) for c in ring])
    sides = zip(ring, ring[1:] + ring[:1], strict=True)
    middles = np.array([_key((c + d) // 2, (r + s) // 2) for (c, r), (d, s) in sides])
    hanging = np.isin(middles, np.unique(corners))
    apex = _key(column + size // 2, row + size // 2)
    if not centred:
        count = hanging.sum(axis=0)
        apex = np.where(count == 1, np.sum(middles * hanging, axis=0), apex)
        apex = np.where(count == 0, np.where(column >= 0, corners[0], corners[1]), apex)
    triangles = []
    next_corners = np.roll(corners, -1, axis=0)
    for first, middle, last, split in zip(corners, middles, next_corners, hanging, strict=True):
        for start, end, used in ((first, last, ~split), (first, middle, split), (middle, last, split)):
            used = used & (start != apex) & (end != apex)
            triangles.append(np.column_stack([start, end, apex])[used])
    keys, numbers = np.unique(np.concatenate(triangles), return_inverse=True)
    columns = (keys + (1 << 30)) >> 31
    return np.column_stack([columns, keys - (columns << 31)]) / 2.0, numbers.reshape(-1, 3)
