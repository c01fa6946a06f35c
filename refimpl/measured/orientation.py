"""Which way up a measured surface lies, and which point of it lies at the domain's middle."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from refimpl.errors import MOST, InputError, require_number, require_one_of
from refimpl.measured.readers import RawHeights

TURNS = (0, 90, 180, 270)  # degrees, anticlockwise seen from outside the body
MIRRORS = ("x", "y")


def check_orientation(mirror: object, rotate_deg: object, turn_over: object) -> None:
    """Raise InputError for keys of a measured surface that are out of range; None is not set."""
    if mirror is not None:
        require_one_of("mirror", mirror, MIRRORS)
    allowed = f"one of {', '.join(map(str, TURNS))}"
    require_number("rotate_deg", rotate_deg, allowed)
    if rotate_deg not in TURNS:
        raise InputError("rotate_deg", rotate_deg, allowed)
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

    def negated(self) -> Oriented:
        """Return ``z -> -z``: the surface that a replica was taken from."""
        return self._with(-self.reading.heights, self.centre)

    def mirrored(self, axis: int) -> Oriented:
        """Return ``x -> -x`` (axis 0) or ``y -> -y`` (axis 1)."""
        centre = tuple(
            edge - at if k == axis else at
            for k, (edge, at) in enumerate(zip(self.reading.area, self.centre, strict=True))
        )
        return self._with(np.flip(self.reading.heights, axis), (centre[0], centre[1]))

    def rotated(self, degrees: int) -> Oriented:
        """Turn anticlockwise in the plane: ``(x, y) -> (-y, x)`` for 90 degrees."""
        found = self
        for _ in range(degrees // 90):
            (x, y), (dx, dy) = found.centre, found.reading.pixel
            turned = replace(found.reading, heights=found.reading.heights.T[::-1], pixel=(dy, dx))
            found = Oriented(turned, (found.reading.area[1] - y, x))
        return found

    def turned_over(self) -> Oriented:
        """Turn over about the x axis: ``z(x, y) -> -z(x, -y)``."""
        return self.mirrored(1).negated()

    def _with(self, heights: np.ndarray, centre: tuple[float, float]) -> Oriented:
        return Oriented(replace(self.reading, heights=heights), centre)


def oriented(
    reading: RawHeights,
    *,
    replica: bool,
    mirror: str | None,
    rotate_deg: int,
    turned_over: bool,
    centre: tuple[float, float] | None,
) -> Oriented:
    """Return a reading as it lies on its body: replica, mirror, rotation, turning over, in this order.

    ``centre`` (m) counts from the corner of the file's own measured area; None is its middle.

    >>> steps = RawHeights(np.array([[1.0, 2.0], [3.0, 4.0]]), (1.0, 1.0), "steps", "by hand")
    >>> found = oriented(steps, replica=False, mirror=None, rotate_deg=90, turned_over=False, centre=None)
    >>> found.reading.heights  # heights that rose along x rise along y
    array([[2., 4.],
           [1., 3.]])
    """
    middle = reading.area[0] / 2.0, reading.area[1] / 2.0
    found = Oriented(reading, middle if centre is None else centre)
    if replica:
        found = found.negated()
    if mirror is not None:
        found = found.mirrored(MIRRORS.index(mirror))
    found = found.rotated(rotate_deg)
    return found.turned_over() if turned_over else found
