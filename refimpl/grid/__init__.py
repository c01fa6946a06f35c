"""The grid of traction elements, windows of it, and fields on it."""

from refimpl.grid.fields import (
    Array,
    Mask,
    differences,
    inner,
    mean_square,
    read_only,
    repeated,
    resampled,
    second_differences,
)
from refimpl.grid.grid import MAX_COUNT, Grid
from refimpl.grid.window import Shape, Window

__all__ = [
    "MAX_COUNT",
    "Array",
    "Grid",
    "Mask",
    "Shape",
    "Window",
    "differences",
    "inner",
    "mean_square",
    "read_only",
    "repeated",
    "resampled",
    "second_differences",
]
