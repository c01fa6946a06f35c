"""The random field of Eq. (9) as a smoothed lattice of white noise.

``exp(-4.6 r^2 / l^2)`` convolved with itself is proportional to ``R(r) = exp(-2.3 r^2 / l^2)``. So
independent standard normal numbers w on the nodes of an infinite square lattice of spacing h, smoothed by
that kernel,

    z(x, y) = (h k / l) sum_mn exp(-4.6 ((x - m h)^2 + (y - n h)^2) / l^2) w_mn,    k = sqrt(9.2 / pi),

make a Gaussian field, analytic in x and y. Its covariance is R(r) but for two errors, both below rounding:

- The lattice. By Poisson's sum the covariance at the mean position c of two points is R(r) times
  ``1 + 2 exp(-pi^2 l^2 / (9.2 h^2)) cos(2 pi c / h) + ...`` for each axis: with h = l / 6, 3.4e-17 cos(...).
- Cutting the kernel off at 17 nodes, r = 2.83 l: what is dropped is below exp(-4.6 * 2.83^2) = 9e-17 of its
  peak.

Two lengths and a lay are that field in sheared coordinates (`refimpl.surfaces.lay`), where the lattice is
square and both errors are the same. The sum over n goes first; the one over m is another for each y.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

from refimpl.errors import InputError
from refimpl.grid import Array
from refimpl.surfaces.lay import Lay

_TILE = 64
STREAM = 0x726F7567686E6573  # the key's second word, ASCII "roughnes": keeps these streams apart from others
DECAY = 2.3  # exponent of Eq. (9)
NODES_PER_LENGTH = 6
HALF_WIDTH = 17 / NODES_PER_LENGTH  # half-width of the kernel, in correlation lengths
MAX_NODES = 8192  # an axis: 512 MiB of noise
MAX_FAR = 1e6  # lattice spacings from the origin: rounding of x there moves heights by < 1e-9 rms


def white_noise(seed: int, rows: range, columns: range, stream: int = STREAM) -> Array:
    """Return independent normal numbers at lattice nodes ``rows x columns``; indices may be negative.

    Philox (Salmon et al. 2011) is a function of key and counter, so a tile ``(p, q)`` is drawn without any
    other: key = (seed, stream), counter = (0, 0, p, q). Its raw words are fixed for good, numpy's normal
    numbers are not; so 53 bits of each word give a uniform number in (0, 1), its normal quantile the noise.

    >>> part = white_noise(7, range(-3, 70), range(100, 103))
    >>> bool((part[60:, 1:] == white_noise(7, range(57, 70), range(101, 103))).all())
    True
    """
    noise = np.empty((len(rows), len(columns)))
    for p in range(rows.start // _TILE, (rows.stop - 1) // _TILE + 1):
        for q in range(columns.start // _TILE, (columns.stop - 1) // _TILE + 1):
            here_i, tile_i = _overlap(rows, p)
            here_j, tile_j = _overlap(columns, q)
            noise[here_i, here_j] = scipy.special.ndtri(_uniform_tile(seed, stream, p, q)[tile_i, tile_j])
    return noise


def _uniform_tile(seed: int, stream: int, p: int, q: int) -> Array:
    key = np.array([seed, stream], dtype=np.uint64)
    counter = np.array([0, 0, p % 2**64, q % 2**64], dtype=np.uint64)  # low words run within the tile
    words: NDArray[np.uint64] = np.random.Philox(key=key, counter=counter).random_raw(_TILE * _TILE)
    uniform = ((words >> np.uint64(11)).astype(np.float64) + 0.5).reshape(_TILE, _TILE) * 2.0**-53
    return np.minimum(uniform, 1 - 2.0**-53)  # the greatest word's would round to 1


def _overlap(nodes: range, tile: int) -> tuple[slice, slice]:
    first, last = max(nodes.start, tile * _TILE), min(nodes.stop, (tile + 1) * _TILE)
    return slice(first - nodes.start, last - nodes.start), slice(first - tile * _TILE, last - tile * _TILE)


@dataclass(frozen=True)
class NoiseLattice:
    """The field of unit rms.

    ellipse : the lengths of Eq. (9) (m) and their lay
    refuse : called as ``refuse(factor, limit)`` where the lengths are too short by a factor; raises
    """

    ellipse: Lay
    refuse: Callable[[float, str], object]

    def field(self, seed: int, x: Array, y: Array, periods: tuple[float, float] | None) -> Array:
        """Return the field at all pairs of x and y (m), or an isotropic one that repeats with ``periods``."""
        period_x, period_y = periods or (None, None)
        _, shear, _ = self.ellipse.sheared
        nodes_y, smooth_y = self.smoothing(y, 1, period_y)
        if shear:
            return self._sheared(seed, x, shear * y, nodes_y, smooth_y)
        nodes_x, smooth_x = self.smoothing(x, 0, period_x)  # one matrix for all y
        noise = white_noise(seed, nodes_x, nodes_y)
        return np.ascontiguousarray((smooth_y @ (smooth_x @ noise).T).T)

    def _sheared(
        self, seed: int, x: Array, shift: Array, nodes_y: range, smooth_y: scipy.sparse.csr_array
    ) -> Array:
        """Return the sum at ``x_i + shift_j``."""
        ends = np.array([x.min() + shift.min(), x.max() + shift.max()])
        nodes_x, _ = self.smoothing(ends, 0)
        rows = smooth_y @ white_noise(seed, nodes_x, nodes_y).T
        z = np.empty((len(x), len(shift)))
        for j, row in enumerate(rows):
            node, weight = self._kernel(x + shift[j], 0, None)
            z[:, j] = np.einsum("im,im->i", weight, row[node - nodes_x.start])
        return z

    def smoothing(
        self, x: Array, axis: int, period: float | None = None
    ) -> tuple[range, scipy.sparse.csr_array]:
        """Return the nodes along one sheared axis, and the kernel as a matrix S, (len(x), nodes).

        The field is ``S_x w S_y^T``: the exact correlation along an axis, in the ensemble, is ``S S^T``.
        """
        node, weight = self._kernel(x, axis, period)
        nodes = range(int(node.min()), int(node.max()) + 1)
        row = np.repeat(np.arange(len(x)), node.shape[1])
        entries = (weight.ravel(), (row, node.ravel() - nodes.start))
        # entries of one node add up
        return nodes, scipy.sparse.csr_array(entries, shape=(len(x), len(nodes)))

    def _kernel(self, x: Array, axis: int, period: float | None) -> tuple[NDArray[np.int64], Array]:
        """Return the nodes that each point sums over, and their weights."""
        length = self.ellipse.sheared[2 * axis]
        h = length / NODES_PER_LENGTH
        if period is not None:
            h = period / math.ceil(NODES_PER_LENGTH * period / length)
        reach = math.ceil(HALF_WIDTH * length / h)
        self._refuse_too_many(x, h, reach)
        node = np.rint(x / h).astype(np.int64)[:, None] + np.arange(-reach, reach + 1)
        from_node = (x[:, None] - node * h) / length
        peak = math.sqrt(math.sqrt(4.0 * DECAY / math.pi) * h / length)
        weight = peak * np.exp(-2.0 * DECAY * from_node**2)
        if period is not None:
            node %= round(period / h)
            weight /= math.sqrt(_images(period / length))
        return node, weight

    def _refuse_too_many(self, x: Array, h: float, reach: int) -> None:
        extent, farthest = float(x.max() - x.min()), float(np.abs(x).max())
        if extent / h + 2 * reach + 2 > MAX_NODES:
            limit = f"{MAX_NODES} noise nodes an axis of {extent:.4g} m, is the side in m?"
            self.refuse(extent / h / (MAX_NODES - 2 * reach - 2), limit)
        if farthest / h > MAX_FAR:
            raise InputError("offset", farthest, f"within {MAX_FAR:.3g} x {h:.3g} m: beyond, digits are lost")


def _images(ratio: float) -> float:
    """Return ``sum_m exp(-2.3 (m ratio)^2)``, ratio = side / l >= 1: a variance with images."""
    m = np.arange(1, 6)  # the sixth image would add exp(-2.3 * 36) = 1e-36
    return float(1.0 + 2.0 * np.exp(-DECAY * (m * ratio) ** 2).sum())
