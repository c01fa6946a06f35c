"""The grid of traction elements, windows of it, and fields on it."""

from refimpl.grid.grid import Array, Grid, differences, inner, resampled

__all__ = ["Array", "Grid", "differences", "inner", "resampled"]
