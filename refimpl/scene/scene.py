"""The scene: two bodies, their friction, the load and the frame."""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass
from typing import Any

import numpy as np

from refimpl.errors import MOST, InputError, keep_doubles, printable, require_number, require_size
from refimpl.grid import Array, Grid
from refimpl.model.friction import Friction
from refimpl.model.materials import Material, Pair
from refimpl.surfaces import Surface, SurfaceWarning, as_surface

# What a surface is asked with, by the names that the scene has for it.
_ASKED_OF_SURFACES = {"side": "side", "periodic": "periodic", "offset": "sliding_offset"}


@dataclass(frozen=True, eq=False)
class Body:
    """A half-space of one material with a rough surface (a `Surface`, an array of heights, or a sum)."""

    material: Material
    surface: Surface

    def __init__(self, material: Material, surface: Any) -> None:
        if not isinstance(material, Material):
            raise InputError("material", material, "a Material")
        object.__setattr__(self, "material", material)
        object.__setattr__(self, "surface", as_surface(surface))


@dataclass(frozen=True, eq=False)
class Scene:
    """Two rough half-spaces sliding under a normal load.

    Parameters
    ----------
    upper, lower : the two bodies; the upper one slides along ``(cos phi, sin phi)``
    friction : local friction law, Eq. (1)
    load : normal load P (N)
    side : edge of the square domain (m)
    sliding_direction : phi (rad)
    sliding_offset : how far the upper body has slid (m); the lower surface is sampled at x + offset
    periodic : the doubly periodic problem instead of a half-space that is free outside the domain

    Raises `InputError` naming the field.
    """

    upper: Body
    lower: Body
    friction: Friction
    load: float
    side: float
    sliding_direction: float = 0.0
    sliding_offset: float = 0.0
    periodic: bool = False

    def __post_init__(self) -> None:
        for name in ("upper", "lower"):
            if not isinstance(getattr(self, name), Body):
                raise InputError(name, getattr(self, name), "a Body")
        if not isinstance(self.friction, Friction):
            raise InputError("friction", self.friction, "a Friction")
        require_number("load", self.load, "a positive normal load in N", above=0)
        require_size("side", self.side, "a positive length in m")
        require_number("sliding_direction", self.sliding_direction, "a finite angle in rad")
        allowed = f"a finite length in m, at most {MOST} either way"
        require_number("sliding_offset", self.sliding_offset, allowed, at_least=-MOST, at_most=MOST)
        if not isinstance(self.periodic, bool):
            raise InputError("periodic", self.periodic, "true or false")
        keep_doubles(self, "load", "side", "sliding_direction", "sliding_offset")

    @property
    def materials(self) -> Pair:
        """The two materials with their combined compliances."""
        return Pair(lower=self.lower.material, upper=self.upper.material)

    @property
    def lengths(self) -> tuple[float, float]:
        """Lengths of the domain along x and y (m)."""
        return self.side, self.side

    def grid(self, M: int) -> Grid:
        """Return the grid of M elements along the longer side.

        Raises `InputError` unless M is a whole number of elements.
        """
        return Grid((M, M), self.lengths, self.periodic)

    def check_approach(self, approach: float) -> None:
        """Raise `InputError` unless a prescribed approach (m) is finite, and below 0 in a periodic scene.

        There it counts from the mean planes.
        """
        if self.periodic:
            require_number("approach", approach, "an approach below 0 m (mean planes)", below=0)
        require_number("approach", approach, "a finite approach in m")

    def heights(self, grid: Grid) -> tuple[Array, Array]:
        """Return heights ``(z_lower, z_upper)`` at the element centres, each about its own mid-height (m).

        Mid-heights are taken off because only the gap enters: heights may come with any datum.

        Raises `InputError` when a surface's peak-to-valley exceeds the side, which means a wrong unit; warns
        (`SurfaceWarning`) of `cautions`.
        """
        for caution in self.cautions(grid):
            warnings.warn(caution, SurfaceWarning, stacklevel=2)
        return self.sampled(grid)

    def cautions(self, grid: Grid) -> tuple[str, ...]:
        """What a user should know of how the heights of this grid were had, each once."""
        parts = (*self.lower.surface.parts, *self.upper.surface.parts)
        return tuple(dict.fromkeys(printable(line) for part in parts for line in part.cautions(grid)))

    def sampled(self, grid: Grid) -> tuple[Array, Array]:
        """The `heights`, without a warning."""
        slide = (
            self.sliding_offset * math.cos(self.sliding_direction),
            self.sliding_offset * math.sin(self.sliding_direction),
        )
        lower, upper = self._summed("lower", grid, slide), self._summed("upper", grid, (0.0, 0.0))
        return _centred("lower", lower, grid), _centred("upper", upper, grid)

    def _summed(self, name: str, grid: Grid, offset: tuple[float, float]) -> Array:
        """The sum of a body's parts (m); a refusal names the part, or the field of the scene that is why."""
        body: Body = getattr(self, name)
        z = grid.zeros
        for k, part in enumerate(body.surface.parts):
            try:
                z += part.sample(grid, offset)
            except InputError as refused:
                field, value = f"{name}.surface[{k}].{refused.field}", refused.value
                if refused.field in _ASKED_OF_SURFACES:
                    field = _ASKED_OF_SURFACES[refused.field]
                    value = getattr(self, field)
                raise InputError(field, value, refused.allowed) from refused.__cause__
        return z


def _centred(name: str, heights: Array, grid: Grid) -> Array:
    """The heights about their mid-height, in place."""
    if not np.all(np.isfinite(heights)):
        raise InputError(f"{name}.surface", "NaN or infinite heights", "finite heights in m")
    low, high = float(heights.min()), float(heights.max())
    side = max(grid.lengths)
    if high - low > side:
        raise InputError(
            f"{name}.surface",
            f"peak-to-valley {high - low:.3g} m",
            f"heights in m whose peak-to-valley is at most the side, {side:.3g} m (wrong unit? Without slope "
            "terms, heights and approach times s with moduli over s have the same pressures)",
        )
    heights -= low + 0.5 * (high - low)
    return heights
