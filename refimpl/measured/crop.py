"""The window that a scene cuts from measured heights."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from refimpl.errors import InputError, size_text
from refimpl.grid import Array
from refimpl.measured.detrending import Form
from refimpl.measured.missing_points import fill
from refimpl.measured.readers import RawHeights
from refimpl.surfaces.bicubic import MEMORY

ROUNDING = 1e-9  # relative slack of lengths: far above double rounding, far below a pixel


@dataclass(frozen=True)
class Crop:
    """The rectangle of ``lengths`` (m) about ``centre``, moved by ``offset`` (m).

    ``centre`` counts from the corner of the measured area; by default it is the area's middle.

    Each point counts as one pixel, so n points measure n pixels. Raises InputError where the window leaves
    the measured area, or holds fewer than four points an axis. Positions are in pixels: point ``[i, j]`` sits
    at (i, j).
    """

    reading: RawHeights
    lengths: tuple[float, float]
    offset: tuple[float, float] = (0.0, 0.0)
    centre: tuple[float, float] | None = None

    def __post_init__(self) -> None:
        name, most = self.reading.name, extent(self.reading, self._middle)
        room = tuple((whole - length) / 2.0 for whole, length in zip(most, self.lengths, strict=True))
        for length, left in zip(self.lengths, room, strict=True):
            if left < -ROUNDING * length / 2:
                about = "" if self.centre is None else " about the centre"
                raise InputError("side", length, f"at most the measured {size_text(most)} m of {name}{about}")
        moved = extent(self.reading, self._middle, self.offset)
        if any(
            length - whole > 2 * ROUNDING * length for length, whole in zip(self.lengths, moved, strict=True)
        ):
            fits = f"; a size of {size_text(moved)} m fits this offset" if min(moved) > 0 else ""
            raise InputError("offset", self.offset, f"at most {size_text(room)} m either way in {name}{fits}")
        counts = tuple(s.stop - s.start for s in self.points)
        if min(counts) < 4:
            least = f"at least 4 pixels of {self.reading.name}, each {size_text(self.reading.pixel)} m"
            raise InputError("side", self.lengths[counts.index(min(counts))], least)

    @property
    def _middle(self) -> tuple[float, float]:
        return self.centre or (self.reading.area[0] / 2.0, self.reading.area[1] / 2.0)

    def positions(self, along: Array, axis: int) -> Array:
        """Return the pixel positions of points ``along`` an axis (m from the window's edge)."""
        corner = self._middle[axis] - self.lengths[axis] / 2.0 + self.offset[axis]
        return np.asarray((corner + along) / self.reading.pixel[axis] - 0.5)

    @property
    def points(self) -> tuple[slice, slice]:
        """The points whose centres lie in the window."""
        ends = np.array([-ROUNDING, 1 + ROUNDING])
        i, j = (self.positions(ends * length, axis) for axis, length in enumerate(self.lengths))
        return slice(math.ceil(i[0]), math.floor(i[1]) + 1), slice(math.ceil(j[0]), math.floor(j[1]) + 1)

    @property
    def lost(self) -> int:
        """Number of these points that are missing."""
        return int(np.isnan(self.reading.heights[self.points]).sum())

    @property
    def size(self) -> int:
        """Number of points."""
        return self.reading.heights[self.points].size

    def filled(self, form: Form) -> tuple[Array, tuple[slice, slice]]:
        """Return points in and around the window less ``form``, gaps filled; and where they begin."""
        i, j = (slice(max(s.start - MEMORY, 0), s.stop + MEMORY) for s in self.points)
        heights = self.reading.heights[i, j]
        x, y = (s.start + np.arange(n, dtype=float) for s, n in zip((i, j), heights.shape, strict=True))
        return fill(heights - form(x, y), self.reading.pixel), (i, j)


def extent(
    reading: RawHeights, centre: tuple[float, float], offset: tuple[float, float] = (0.0, 0.0)
) -> tuple[float, float]:
    """Return the largest rectangle (m) about a point, moved by an offset, that the measured area covers."""
    x, y = (
        2.0 * min(at + moved, edge - at - moved)
        for edge, at, moved in zip(reading.area, centre, offset, strict=True)
    )
    return x, y
