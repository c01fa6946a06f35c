"""The window that a scene cuts from measured heights."""

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
class Crop:
    """The rectangle of ``lengths`` (m) about the middle of the measured area, moved by ``offset`` (m).

    Each point counts as one pixel, so n points measure n pixels. Raises InputError where the window leaves
    the measured area, or holds fewer than four points an axis. Positions are in pixels: point ``[i, j]`` sits
    at (i, j).
    """

    reading: Reading
    lengths: tuple[float, float]
    offset: tuple[float, float] = (0.0, 0.0)

    def __post_init__(self) -> None:
        area, slack = self.reading.area, ROUNDING * max(self.lengths)
        room = tuple((measured - length) / 2.0 for measured, length in zip(area, self.lengths, strict=True))
        if min(room) < -slack / 2:
            allowed = f"at most the measured {by(area)} m of {self.reading.name}"
            raise InputError("side", self.lengths[room.index(min(room))], allowed)
        if any(abs(o) > r + slack for o, r in zip(self.offset, room, strict=True)):
            raise InputError("offset", self.offset, f"at most {by(room)} m either way in {self.reading.name}")
        counts = tuple(s.stop - s.start for s in self.points)
        if min(counts) < 4:
            least = f"at least 4 pixels of {self.reading.name}, each {by(self.reading.pixel)} m"
            raise InputError("side", self.lengths[counts.index(min(counts))], least)

    def positions(self, along: Array, axis: int) -> Array:
        """Pixel positions of points ``along`` an axis (m from the window's edge)."""
        corner = (self.reading.area[axis] - self.lengths[axis]) / 2.0 + self.offset[axis]
        return np.asarray((corner + along) / self.reading.pixel[axis] - 0.5)

    @property
    def points(self) -> tuple[slice, slice]:
        """The points whose centres lie in the window."""
        slack = ROUNDING * max(self.lengths)
        i, j = (self.positions(np.array([-slack, self.lengths[axis] + slack]), axis) for axis in (0, 1))
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
