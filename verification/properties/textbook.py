"""Influence matrices from the textbook's corner differences, written independently of `refimpl.kernels`.

They lose digits with the square of the distance in elements: below 1e-13 on the small grids that matrices
allow, 1.4e-11 at 160 elements.
Sources: Love 1929; Johnson 1985, Eqs (3.25) and (3.73).
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from refimpl.grid import Array, Grid

Corner = Callable[[Array, Array], Array]


def normal_matrix(grid: Grid) -> Array:
    """``I[1/rho]`` between all pairs of elements (m), field by row."""
    return _corners(*_pairs(grid), grid.spacings, _love)


def normal_offsets(shape: tuple[int, int], edges: tuple[float, float] = (1.0, 1.0)) -> Array:
    """``I[1/rho]`` of an element of those edges at offsets ``1 - M ... M - 1`` elements along x and y."""
    return _corners(*_offsets(shape, edges), edges, _love)


def shear_matrix(grid: Grid, direction: float) -> Array:
    """``I[s/rho^2]`` between all pairs (m), ``s`` along ``direction`` (rad) from source to field."""
    return _cerruti(*_pairs(grid), grid.spacings, direction)


def shear_offsets(shape: tuple[int, int], direction: float, edges: tuple[float, float] = (1.0, 1.0)) -> Array:
    """``I[s/rho^2]`` of an element of those edges at offsets ``1 - M ... M - 1`` elements along x and y."""
    return _cerruti(*_offsets(shape, edges), edges, direction)


def _offsets(shape: tuple[int, int], edges: tuple[float, float]) -> tuple[Array, Array]:
    x, y = (np.arange(1.0 - n, n) * edge for n, edge in zip(shape, edges, strict=True))
    return x[:, None], y[None, :]


def _love(X: Array, Y: Array) -> Array:
    return np.asarray(X * np.arcsinh(Y / np.abs(X)) + Y * np.arcsinh(X / np.abs(Y)))


def _cerruti(X: Array, Y: Array, edges: tuple[float, float], direction: float) -> Array:
    along_x = _corners(X, Y, edges, lambda X, Y: Y / 2 * np.log(X**2 + Y**2) + X * np.arctan(Y / X))
    along_y = _corners(X, Y, edges, lambda X, Y: X / 2 * np.log(X**2 + Y**2) + Y * np.arctan(X / Y))
    return math.cos(direction) * along_x + math.sin(direction) * along_y


def _pairs(grid: Grid) -> tuple[Array, Array]:
    """Offsets along x and y between all element centres, field by row."""
    x, y = (axis.ravel() for axis in np.meshgrid(grid.x, grid.y, indexing="ij"))
    return x[:, None] - x[None, :], y[:, None] - y[None, :]


def _corners(X: Array, Y: Array, edges: tuple[float, float], antiderivative: Corner) -> Array:
    """Second difference over the corners of an element at an offset."""
    a, b = edges[0] / 2, edges[1] / 2
    return (
        antiderivative(X + a, Y + b)
        - antiderivative(X - a, Y + b)
        - antiderivative(X + a, Y - b)
        + antiderivative(X - a, Y - b)
    )
