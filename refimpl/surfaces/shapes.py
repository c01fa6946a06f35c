"""Smooth shapes: the flat and the paraboloid that stands for a sphere."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from refimpl.errors import LEAST, InputError, keep_doubles, require_number
from refimpl.grid import Array, Grid
from refimpl.surfaces.surface import Surface


@dataclass(frozen=True)
class Flat(Surface):
    """Height zero everywhere."""

    kind: ClassVar[str] = "flat"

    def heights_on(self, grid: Grid, offset: tuple[float, float]) -> Array:
        return grid.zeros


@dataclass(frozen=True)
class Sphere(Surface):
    """The paraboloid ``(x^2 + y^2) / (2 radius)`` about the scene's centre.

    A positive ``radius`` (m) bulges downwards: a ball as the upper body, its lowest point, at height 0, over
    the centre of the square. A ball as the lower body has a negative one. Periodic: the paraboloid of the
    nearest image.

    >>> Sphere(radius=0.5).heights(Grid.square(4.0, 2))
    array([[2., 2.], [2., 2.]])
    """

    radius: float
    kind: ClassVar[str] = "sphere"

    def __post_init__(self) -> None:
        allowed = f"a length in m, positive for an upper ball, negative for a lower one, from {LEAST} up"
        if abs(require_number("radius", self.radius, allowed)) < LEAST:
            raise InputError("radius", self.radius, allowed)
        keep_doubles(self, "radius")

    def parameters(self) -> dict[str, float]:
        return {"radius": self.radius}

    def heights_on(self, grid: Grid, offset: tuple[float, float]) -> Array:
        x, y = (_from_centre(grid, axis) + offset[axis] for axis in (0, 1))
        if grid.periodic:
            x, y = (s - L * np.round(s / L) for s, L in zip((x, y), grid.lengths, strict=True))
        return np.asarray((x[:, None] ** 2 + y[None, :] ** 2) / (2.0 * self.radius))


def _from_centre(grid: Grid, axis: int) -> Array:
    """Return the element centres from the domain's centre (m), symmetric to the last bit."""
    count = grid.shape[axis]
    return np.asarray((2.0 * np.arange(count) + 1.0 - count) * (grid.spacings[axis] / 2.0))
