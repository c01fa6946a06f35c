"""Which way up a measured surface lies, and which point of it lies at the domain's middle."""

from __future__ import annotations

from dataclasses import dataclass, replace

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

    >>> import numpy as np
    >>> steps = RawHeights(np.array([[1.0, 2.0], [3.0, 4.0]]), (1.0, 1.0), "steps", "by hand")
    >>> found = oriented(steps, replica=False, mirror=None, rotate_deg=90, turned_over=False, centre=None)
    >>> found.reading.heights  # heights that rose along x rise along y
    array([[2., 4.],
           [1., 3.]])
    """
    z, (dx, dy), (width, height) = reading.heights, reading.pixel, reading.area
    x, y = (width / 2.0, height / 2.0) if centre is None else centre
    if replica:  # z -> -z: the surface that it was taken from
        z = -z
    if mirror == "x":
        z, x = z[::-1], width - x
    elif mirror == "y":
        z, y = z[:, ::-1], height - y
    for _ in range(rotate_deg // 90):  # (x, y) -> (-y, x)
        z, x, y = z.T[::-1], height - y, x
        (dx, dy), (width, height) = (dy, dx), (height, width)
    if turned_over:  # about the x axis: z(x, y) -> -z(x, -y)
        z, y = -z[:, ::-1], height - y
    return Oriented(replace(reading, heights=z, pixel=(dx, dy)), (x, y))
