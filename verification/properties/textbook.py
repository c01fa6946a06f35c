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
    """``I[1/rho]`` between all pairs of elements (m), shape ``(M^2, M^2)``, field by row."""
    return _corners(*_pairs(grid), grid.element_size, _love)


def normal_offsets(M: int) -> Array:
    """``I[1/rho]`` of an element of unit edge at offsets ``1 - M ... M - 1`` along x and y."""
    offsets = np.arange(1.0 - M, M)
    return _corners(offsets[:, None], offsets[None, :], 1.0, _love)


def shear_matrix(grid: Grid, direction: float) -> Array:
    """``I[s/rho^2]`` between all pairs (m), ``s`` along ``direction`` (rad) from source to field."""
    return _cerruti(*_pairs(grid), grid.element_size, direction)


def shear_offsets(M: int, direction: float) -> Array:
    """``I[s/rho^2]`` of an element of unit edge at offsets ``1 - M ... M - 1`` along x and y."""
    offsets = np.arange(1.0 - M, M)
    return _cerruti(offsets[:, None], offsets[None, :], 1.0, direction)


def _love(X: Array, Y: Array) -> Array:
    return np.asarray(X * np.arcsinh(Y / np.abs(X)) + Y * np.arcsinh(X / np.abs(Y)))


def _cerruti(X: Array, Y: Array, edge: float, direction: float) -> Array:
    along_x = _corners(X, Y, edge, lambda X, Y: Y / 2 * np.log(X**2 + Y**2) + X * np.arctan(Y / X))
    along_y = _corners(X, Y, edge, lambda X, Y: X / 2 * np.log(X**2 + Y**2) + Y * np.arctan(X / Y))
    return math.cos(direction) * along_x + math.sin(direction) * along_y


def _pairs(grid: Grid) -> tuple[Array, Array]:
    """Offsets along x and y between all element centres, field by row."""
    x, y = (axis.ravel() for axis in np.meshgrid(grid.x, grid.y, indexing="ij"))
    return x[:, None] - x[None, :], y[:, None] - y[None, :]


def _corners(X: Array, Y: Array, edge: float, antiderivative: Corner) -> Array:
    """Second difference over the corners of an element at an offset."""
    half = edge / 2
    return (
        antiderivative(X + half, Y + half)
        - antiderivative(X - half, Y + half)
        - antiderivative(X + half, Y - half)
        + antiderivative(X - half, Y - half)
    )
