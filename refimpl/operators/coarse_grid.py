"""A coarser grid under a window: elements spread to its points and interpolated from them, by matrices."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from refimpl.grid import Array, Shape

COARSER = 4  # elements per spacing
_CELLS = 8  # cells of the coarse grid in a block


class CoarseGrid(NamedTuple):
    """Spreads elements to a coarse grid and interpolates from it, by small dense matrices, block by block.

    shape : points of the coarse grid
    blocks : of `_CELLS` cells along each axis; the last ones may be beyond the elements
    weights : from the points that a block's elements see to those elements
    """

    shape: Shape
    blocks: Shape
    weights: Array

    @classmethod
    def under(cls, shape: Shape, window: Callable[[Array], Array], first: float, beyond: int) -> CoarseGrid:
        """Return the coarse grid of a window, points from ``first``; weights by distance in spacings."""
        n, m = (-(-k // (_CELLS * COARSER)) for k in shape)
        elements = (np.arange(_CELLS * COARSER) + 0.5) / COARSER
        points = np.arange(_CELLS + beyond)[:, None] + first
        return cls((n * _CELLS + beyond, m * _CELLS + beyond), (n, m), window(points - elements))

    def spread(self, values: Array) -> Array:
        """Return the sums of elements' values by the window about each point."""
        (n, m), (rows, columns), width = self.blocks, self.shape, self.weights.shape[1]
        if values.shape != (n * width, m * width):
            values = np.pad(values, [(0, k * width - s) for k, s in zip((n, m), values.shape, strict=True)])
        along = np.zeros((rows, m * width))
        _add_blocks(along, self.weights @ values.reshape(n, width, -1))
        found = np.zeros((columns, rows))
        across = (along.reshape(-1, width) @ self.weights.T).reshape(rows, m, -1)
        _add_blocks(found, across.transpose(1, 2, 0))
        return found.T

    def interpolate(self, values: Array, shape: Shape) -> Array:
        """Return the values of points at the elements of a window."""
        reach = len(self.weights)
        blocks = sliding_window_view(values, reach, axis=1)[:, ::_CELLS]
        along = (blocks.reshape(-1, reach) @ self.weights).reshape(self.shape[0], -1)
        rows = sliding_window_view(along, reach, axis=0)[::_CELLS].transpose(0, 2, 1)
        return (self.weights.T @ rows).reshape(-1, along.shape[1])[: shape[0], : shape[1]]


def _add_blocks(total: Array, blocks: Array) -> None:
    """Add blocks, each `_CELLS` rows further than the last, into a total."""
    n, width, _ = blocks.shape
    for first in range(0, width, _CELLS):
        part = blocks[:, first : first + _CELLS]
        for row in range(part.shape[1]):
            total[first + row :: _CELLS][:n] += part[:, row]
