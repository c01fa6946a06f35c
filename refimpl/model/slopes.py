"""Slopes of the deformed common surface along and across the sliding direction."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from refimpl.grid import Array, Grid, Mask, Window, inner


@dataclass(frozen=True)
class Slopes:
    """Tangents of the slope angles ``theta_x`` (along sliding, positive uphill) and ``theta_y``.

    The direction of ``theta_y`` is 90 degrees anticlockwise of the sliding direction. Arrays share
    one shape; cosines and sines follow from the tangents without trigonometry.
    """

    tan_x: Array
    tan_y: Array

    @classmethod
    def flat(cls, shape: tuple[int, ...]) -> Slopes:
        """Return zero slopes: every cosine is 1 and every sine is 0. One zero is broadcast to the shape."""
        zero = np.broadcast_to(0.0, shape)
        return cls(zero, zero)

    @property
    def is_flat(self) -> bool:
        """True if these are the zero slopes of `flat`."""
        return not any(self.tan_x.strides)

    def __reduce__(self) -> tuple[Any, ...]:
        """Return the parts of a pickle: a broadcast zero would come back as an array, and no longer flat."""
        return (Slopes.flat, (self.tan_x.shape,)) if self.is_flat else (Slopes, (self.tan_x, self.tan_y))

    @classmethod
    def of_surface(cls, heights: Array, grid: Grid, direction: float) -> Slopes:
        """Return the slopes of ``heights`` (m) on a grid or on a window of it, by central differences.

        >>> ramp = np.arange(4.0)[:, None] * np.ones(4)
        >>> float(Slopes.of_surface(ramp, Grid.square(4.0, 4), math.pi).tan_x[0, 0])
        -1.0
        """
        along_x, along_y = grid.gradient(heights)
        cos, sin = math.cos(direction), math.sin(direction)
        tan_x = cos * along_x
        tan_x += sin * along_y
        along_y *= cos
        along_x *= sin
        along_y -= along_x
        return cls(tan_x, along_y)

    def mean_square(self, weights: Array) -> float:
        """Return the weighted mean of ``tan^2 theta_x + tan^2 theta_y``; 0 where the weights vanish."""
        total = float(np.sum(weights))
        if self.is_flat or total <= 0:
            return 0.0
        return sum(inner(tangent * weights, tangent) for tangent in (self.tan_x, self.tan_y)) / total

    def distance(self, other: Slopes, where: Mask) -> float:
        """Return the largest difference of the tangents on the marked elements."""
        if (self.is_flat and other.is_flat) or not where.any():
            return 0.0
        pairs = ((self.tan_x, other.tan_x), (self.tan_y, other.tan_y))
        return max(float(np.abs(a - b)[where].max()) for a, b in pairs)

    @cached_property
    def cos_x(self) -> Array:
        """``cos(theta_x)``."""
        return self._cosine(self.tan_x)

    @cached_property
    def cos_y(self) -> Array:
        """``cos(theta_y)``."""
        return self._cosine(self.tan_y)

    def _cosine(self, tangent: Array) -> Array:
        return np.broadcast_to(1.0, tangent.shape) if self.is_flat else 1 / np.sqrt(1 + tangent**2)

    @cached_property
    def sin_x(self) -> Array:
        """``sin(theta_x)``."""
        return self.tan_x if self.is_flat else self.tan_x * self.cos_x

    @cached_property
    def sin_y(self) -> Array:
        """``sin(theta_y)``."""
        return self.tan_y if self.is_flat else self.tan_y * self.cos_y

    @cached_property
    def cosine_product(self) -> Array:
        """``cos(theta_x) cos(theta_y)``, the factor of Eq. (6). On a large grid every array counts."""
        if self.is_flat:
            return self.cos_x
        squares = self.tan_x**2
        squares += 1
        other = self.tan_y**2
        other += 1
        squares *= other
        np.sqrt(squares, out=squares)
        return np.divide(1, squares, out=squares)

    @cached_property
    def theta_x(self) -> Array:
        """Slope angle along the sliding direction, positive uphill (rad)."""
        return np.arctan(self.tan_x)

    @cached_property
    def theta_y(self) -> Array:
        """Slope angle along the direction 90 degrees anticlockwise of sliding (rad)."""
        return np.arctan(self.tan_y)

    def per_cosine_product(self, values: Array) -> Array:
        """Return ``values / cosine_product``, in place where that is 1 everywhere."""
        return values if self.is_flat else values / self.cosine_product

    def windowed(self, window: Window) -> Slopes:
        """Return the slopes on a window of their grid."""
        return Slopes(self.tan_x[window.slices], self.tan_y[window.slices])

    def spread(self, window: Window, grid: Grid) -> Slopes:
        """Return the slopes of a window on its whole grid, zero elsewhere."""
        if self.is_flat:
            return Slopes.flat(grid.shape)
        return Slopes(window.spread(self.tan_x, grid.shape), window.spread(self.tan_y, grid.shape))
