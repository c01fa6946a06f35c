"""Influence matrices from the textbook's corner differences, written independently of `refimpl.kernels`.

They lose digits with the square of the distance in elements: below 1e-13 on the small grids used here.
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
    return _corners(grid, lambda X, Y: X * np.arcsinh(Y / np.abs(X)) + Y * np.arcsinh(X / np.abs(Y)))


def shear_matrix(grid: Grid, direction: float) -> Array:
    """``I[s/rho^2]`` between all pairs (m), ``s`` along ``direction`` (rad) from source to field."""
    along_x = _corners(grid, lambda X, Y: Y / 2 * np.log(X**2 + Y**2) + X * np.arctan(Y / X))
    along_y = _corners(grid, lambda X, Y: X / 2 * np.log(X**2 + Y**2) + Y * np.arctan(X / Y))
    return math.cos(direction) * along_x + math.sin(direction) * along_y


def _corners(grid: Grid, antiderivative: Corner) -> Array:
    """Second difference over an element's corners, for all offsets between element centres."""
    x, y = (axis.ravel() for axis in np.meshgrid(grid.centres, grid.centres, indexing="ij"))
    X, Y, half = x[:, None] - x[None, :], y[:, None] - y[None, :], grid.spacing / 2
    return (
        antiderivative(X + half, Y + half)
        - antiderivative(X - half, Y + half)
        - antiderivative(X + half, Y - half)
        + antiderivative(X - half, Y - half)
    )
