"""White Gaussian noise on the infinite square lattice: any rectangle of it, in any order, always the same."""

from __future__ import annotations

import numpy as np
import scipy
from numpy.typing import NDArray

from refimpl.grid import Array

_TILE = 64
STREAM = 0x726F7567686E6573  # the key's second word, ASCII "roughnes": keeps these streams apart from others


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
