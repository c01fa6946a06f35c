"""Smooth shapes: the flat and the paraboloid that stands for a sphere."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from refimpl.errors import LEAST, InputError
from refimpl.grid import Array, Grid
from refimpl.surfaces.surface import Surface, finite


@dataclass(frozen=True)
class Flat(Surface):
    """Height zero everywhere."""

    kind: ClassVar[str] = "flat"

    def _sample(self, grid: Grid, offset: tuple[float, float], periodic: bool) -> Array:
        return np.zeros((grid.M, grid.M))


@dataclass(frozen=True)
class Sphere(Surface):
    """The paraboloid ``(x^2 + y^2) / (2 radius)`` about the scene's centre.

    A positive ``radius`` (m) bulges downwards: a ball as the upper body, its lowest point, at height 0, over
    the centre of the square. A ball as the lower body has a negative one. Periodic: the paraboloid of the
    nearest image.

    >>> Sphere(radius=0.5).heights(Grid(side=4.0, M=2))
    array([[2., 2.], [2., 2.]])
    """

    radius: float
    kind: ClassVar[str] = "sphere"

    def __post_init__(self) -> None:
        allowed = f"a length in m, positive for an upper ball, negative for a lower one, from {LEAST} up"
        if abs(finite("radius", self.radius, allowed)) < LEAST:
            raise InputError("radius", self.radius, allowed)
        object.__setattr__(self, "radius", float(self.radius))

    def _sample(self, grid: Grid, offset: tuple[float, float], periodic: bool) -> Array:
        # (2i + 1 - M) h / 2 is symmetric about the centre to the last bit; (i + 1/2) h - side / 2 is not
        from_centre = (2.0 * np.arange(grid.M) + 1.0 - grid.M) * (grid.spacing / 2.0)
        x, y = from_centre + offset[0], from_centre + offset[1]
        if periodic:
            x, y = x - grid.side * np.round(x / grid.side), y - grid.side * np.round(y / grid.side)
        return np.asarray((x[:, None] ** 2 + y[None, :] ** 2) / (2.0 * self.radius))
