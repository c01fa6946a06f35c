"""The square window that a scene cuts from measured heights."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from refimpl.errors import InputError
from refimpl.grid import Array
from refimpl.surfaces.bicubic import MEMORY
from refimpl.surfaces.missing_points import fill
from refimpl.surfaces.readers import Reading

ROUNDING = 1e-9  # relative slack of lengths: far above double rounding, far below a pixel


@dataclass(frozen=True)
class Window:
    """The square of edge ``side`` (m) about the middle of the measured area, moved by ``offset`` (m).

    Each point counts as one pixel, so n points measure n pixels. Raises InputError where the window leaves
    the measured area, or holds fewer than four points an axis. Positions are in pixels: point ``[i, j]`` sits
    at (i, j).
    """

    reading: Reading
    side: float
    offset: tuple[float, float] = (0.0, 0.0)

    def __post_init__(self) -> None:
        area, slack = self.reading.area, ROUNDING * self.side
        if self.side > min(area) + slack:
            raise InputError("side", self.side, f"at most the measured {by(area)} m of {self.reading.name}")
        room = tuple((length - self.side) / 2.0 for length in area)
        if any(abs(o) > r + slack for o, r in zip(self.offset, room, strict=True)):
            raise InputError("offset", self.offset, f"at most {by(room)} m either way in {self.reading.name}")
        if min(s.stop - s.start for s in self.points) < 4:
            least = f"at least 4 pixels of {self.reading.name}, each {by(self.reading.pixel)} m"
            raise InputError("side", self.side, least)

    def positions(self, along: Array, axis: int) -> Array:
        """Pixel positions of points ``along`` an axis (m from the window's edge)."""
        corner = (self.reading.area[axis] - self.side) / 2.0 + self.offset[axis]
        return np.asarray((corner + along) / self.reading.pixel[axis] - 0.5)

    @property
    def points(self) -> tuple[slice, slice]:
        """The points whose centres lie in the window."""
        slack = ROUNDING * self.side
        ends = np.array([-slack, self.side + slack])
        i, j = (self.positions(ends, axis) for axis in (0, 1))
        return slice(math.ceil(i[0]), math.floor(i[1]) + 1), slice(math.ceil(j[0]), math.floor(j[1]) + 1)

    @property
    def lost(self) -> int:
        """How many of these points are missing."""
        return int(np.isnan(self.reading.heights[self.points]).sum())

    @property
    def size(self) -> int:
        """How many points there are."""
        return self.reading.heights[self.points].size

    def filled(self) -> tuple[Array, tuple[slice, slice]]:
        """The window's points and what a spline remembers around them, gaps filled; and where these begin."""
        around = tuple(slice(max(s.start - MEMORY, 0), s.stop + MEMORY) for s in self.points)
        i, j = around
        return fill(self.reading.heights[i, j], self.reading.pixel), (i, j)


def by(lengths: tuple[float, ...]) -> str:
    """``a x b``."""
    return " x ".join(f"{length:.6g}" for length in lengths)
