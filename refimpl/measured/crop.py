"""Orientation of a measured surface on its body, and the window that a scene cuts from it."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
import scipy

from refimpl.errors import MOST, InputError, require_number, require_one_of, size_text
from refimpl.grid import Array
from refimpl.measured.detrending import Form
from refimpl.measured.missing_points import fill
from refimpl.measured.readers import RawHeights
from refimpl.surfaces.arrays import MEMORY

ROUNDING = 1e-9  # relative slack of lengths: far above double rounding, far below a pixel
MIRRORS = ("x", "y")


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


def check_orientation(mirror: object, rotate_deg: object, turn_over: object, repeats: bool) -> None:
    """Raise InputError for keys of a measured surface that are out of range; None is not set."""
    if mirror is not None:
        require_one_of("mirror", mirror, MIRRORS)
    angle = require_number("rotate_deg", rotate_deg, "-360 to 360 degrees", at_least=-360, at_most=360)
    if repeats and angle % 90:
        raise InputError("rotate_deg", rotate_deg, "a multiple of 90 for a map that repeats")
    if not isinstance(turn_over, bool | None):
        raise InputError("turn_over", turn_over, "true or false")


def checked_centre(centre: object) -> tuple[float, float]:
    """Return the point (m) of the key ``centre``. Raises InputError."""
    allowed = "two lengths in m from the corner of the file's own area, (x, y)"
    if not isinstance(centre, list | tuple) or len(centre) != 2:
        raise InputError("centre", centre, allowed)
    for at in centre:
        require_number("centre", at, allowed, at_least=-MOST, at_most=MOST)
    return float(centre[0]), float(centre[1])


@dataclass(frozen=True)
class Oriented:
    """A reading as it lies on its body, and the point of it at the domain's middle (m from its corner)."""

    reading: RawHeights
    centre: tuple[float, float]


def oriented(
    reading: RawHeights,
    *,
    replica: bool,
    mirror: str | None,
    rotate_deg: float,
    turned_over: bool,
    centre: tuple[float, float] | None,
    ratio: tuple[float, float] | None = None,
) -> Oriented:
    """Return a reading as it lies on its body: replica, mirror, rotation, turning over, in this order.

    ``centre`` (m) counts from the corner of the file's own measured area; None is its middle. By an angle
    that is no multiple of 90 degrees heights are interpolated, in the largest rectangle that the turned map
    covers, or in the largest whose edges have a given ``ratio``.

    >>> import numpy as np
    >>> steps = RawHeights(np.array([[1.0, 2.0], [3.0, 4.0]]), (1.0, 1.0), "steps", "by hand")
    >>> found = oriented(steps, replica=False, mirror=None, rotate_deg=90, turned_over=False, centre=None)
    >>> found.reading.heights  # heights that rose along x rise along y
    array([[2., 4.],
           [1., 3.]])
    """
    z, (dx, dy), (width, height) = reading.heights, reading.pixel, reading.area
    quarters, angle = divmod(rotate_deg % 360, 90)
    x, y = (width / 2.0, height / 2.0) if centre is None else centre
    if replica:  # z -> -z: the surface that it was taken from
        z = -z
    if mirror == "x":
        z, x = z[::-1], width - x
    elif mirror == "y":
        z, y = z[:, ::-1], height - y
    for _ in range(int(quarters)):  # (x, y) -> (-y, x)
        z, x, y = z.T[::-1], height - y, x
        (dx, dy), (width, height) = (dy, dx), (height, width)
    found = Oriented(replace(reading, heights=z, pixel=(dx, dy)), (x, y))
    if angle:
        found = _turned(found, math.radians(angle), ratio)
    if turned_over:  # about the x axis: z(x, y) -> -z(x, -y)
        (x, y), reading = found.centre, found.reading
        found = Oriented(replace(reading, heights=-reading.heights[:, ::-1]), (x, found.reading.area[1] - y))
    return found


def _turned(old: Oriented, angle: float, ratio: tuple[float, float] | None) -> Oriented:
    """Return a map turned anticlockwise about its middle by an acute angle (rad), in a rectangle inside.

    A cubic spline through the points is sampled on square pixels, of the longer of both edges. A point whose
    nearest one was not measured is missing.
    """
    reading, cos, sin = old.reading, math.cos(angle), math.sin(angle)
    pixel, middle = max(reading.pixel), np.array(reading.area) / 2
    edges = _largest_inside(reading.area, angle) if ratio is None else _like(ratio, reading.area, angle)
    counts = [int(length / pixel * (1 + 1e-9)) for length in edges]
    x, y = np.meshgrid(*(pixel * (np.arange(n) - (n - 1) / 2) for n in counts), indexing="ij", sparse=True)
    i = (cos * x + sin * y + middle[0]) / reading.pixel[0] - 0.5
    j = (cos * y - sin * x + middle[1]) / reading.pixel[1] - 0.5
    if min(counts) < 4:
        allowed = f"a multiple of 90, or a map of more points ({reading.name}: {size_text(counts)} turned)"
        raise InputError("rotate_deg", math.degrees(angle), allowed)
    missing = np.isnan(reading.heights)
    rows, columns = (np.arange(n) for n in missing.shape)
    spline = scipy.interpolate.RectBivariateSpline(rows, columns, fill(reading.heights, reading.pixel), s=0)
    z: Array = spline(i, j, grid=False)
    z[missing[np.rint(i).astype(int), np.rint(j).astype(int)]] = np.nan
    away = np.array([[cos, -sin], [sin, cos]]) @ (np.array(old.centre) - middle)
    note = (
        f"turned by {math.degrees(angle):.4g} degrees, besides quarter turns: interpolated by cubics, which "
        f"damp waves below three pixels, on a rectangle inside, {size_text(n * pixel for n in counts)} m"
    )
    turned = replace(reading, heights=z, pixel=(pixel, pixel), notes=(*reading.notes, note))
    return Oriented(turned, (away[0] + turned.area[0] / 2, away[1] + turned.area[1] / 2))


def _largest_inside(area: tuple[float, float], angle: float) -> tuple[float, float]:
    """Return the edges of the largest upright rectangle in one of edges ``area``, turned by an acute angle.

    >>> [round(edge, 3) for edge in _largest_inside((1.0, 1.0), math.pi / 4)]
    [0.707, 0.707]
    """
    cos, sin, short = math.cos(angle), math.sin(angle), min(area)
    if short <= 2 * sin * cos * max(area):  # two corners on the long edges, their middle at the map's
        edges = short / (2 * sin), short / (2 * cos)
        return edges if area[0] > area[1] else edges[::-1]
    share = cos**2 - sin**2
    return (area[0] * cos - area[1] * sin) / share, (area[1] * cos - area[0] * sin) / share


def _like(ratio: tuple[float, float], area: tuple[float, float], angle: float) -> tuple[float, float]:
    """Return the edges of the largest upright rectangle of a ratio in one of edges ``area``, turned likewise.

    >>> [round(edge, 3) for edge in _like((1.0, 1.0), (2.0, 1.0), math.pi / 6)]
    [0.732, 0.732]
    """
    cos, sin, (x, y) = math.cos(angle), math.sin(angle), ratio
    share = min(area[0] / (x * cos + y * sin), area[1] / (x * sin + y * cos))
    return share * x, share * y
