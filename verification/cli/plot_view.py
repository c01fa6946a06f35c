"""The part of a solution that a picture shows: window about the contact, peak, units at scale."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from verification.cli.plot_style import LENGTHS, PRESSURES, Unit, unit_at_scale

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from refimpl import Solution
    from refimpl.grid import Array

MARGIN = 0.12  # share of the contact's longer side, on each side of it
LEAST = 8  # elements along each side of the window
MOST_OF_DOMAIN = 0.6  # share of the domain from which on all of it is shown
SLENDEREST = 3.0  # ratio of the window's sides; beyond, lengths are drawn to two scales
MOST_CELLS = 512  # cells along the longer side of a map; 2.6 inches at 200 dots


@dataclass(frozen=True)
class View:
    """Window and units of a picture.

    first, last : element indices ``[i, j]``, ``last`` excluded
    peak : element of p_max; of several, that nearest to the middle of the load
    origin, size : corner and sides of the window (m), from the domain's corner
    whole : True if the window is the domain
    length, pressure, gap : units
    """

    first: tuple[int, int]
    last: tuple[int, int]
    peak: tuple[int, int]
    origin: tuple[float, float]
    size: tuple[float, float]
    whole: bool
    length: Unit
    pressure: Unit
    gap: Unit

    def cut(self, field: NDArray[Any]) -> NDArray[Any]:
        """Return the window's part of a field of the grid's shape."""
        (i, j), (k, n) = self.first, self.last
        return field[i:k, j:n]

    @property
    def extent(self) -> tuple[float, float, float, float]:
        """Left, right, bottom and top in the unit of length."""
        (x, y), (width, height) = self.origin, self.size
        left, right, bottom, top = (s / self.length.size for s in (x, x + width, y, y + height))
        return left, right, bottom, top

    @property
    def is_slender(self) -> bool:
        """True if lengths cannot be drawn to one scale."""
        return max(self.size) > SLENDEREST * min(self.size)


def view_of(solution: Solution) -> View:
    """Return the window about the contact; the domain without contact, or where contact is all over."""
    import numpy as np

    grid = solution.grid
    first, last = zip(
        *(_range(np.flatnonzero(solution.contact.any(axis=1 - k)), grid.shape[k]) for k in (0, 1)),
        strict=True,
    )
    first, last = _widened(first, last, grid.shape, grid.spacings)
    share = math.prod(b - a for a, b in zip(first, last, strict=True)) / grid.elements
    whole = share >= MOST_OF_DOMAIN
    if whole:
        first, last = (0, 0), grid.shape
    size = tuple((b - a) * d for a, b, d in zip(first, last, grid.spacings, strict=True))
    origin = tuple(a * d for a, d in zip(first, grid.spacings, strict=True))
    gap = solution.gap[first[0] : last[0], first[1] : last[1]]
    return View(
        first=first,
        last=last,
        peak=peak_of(solution.pressure),
        origin=(origin[0], origin[1]),
        size=(size[0], size[1]),
        whole=whole,
        length=unit_at_scale(max(size), LENGTHS),
        pressure=unit_at_scale(solution.max_pressure, PRESSURES),
        gap=unit_at_scale(float(np.percentile(gap, 99)), LENGTHS),
    )


def peak_of(pressure: Array) -> tuple[int, int]:
    """Return the element of p_max; of equal ones, that nearest to the middle of the load.

    >>> import numpy as np
    >>> peak_of(np.array([[1.0, 0.0, 0.0, 1.0, 1.0, 1.0]]))
    (0, 3)
    """
    import numpy as np

    total = pressure.sum()
    if total == 0:
        return pressure.shape[0] // 2, pressure.shape[1] // 2
    places = np.argwhere(pressure >= pressure.max() * (1 - 1e-9))
    middle = [
        float(np.arange(pressure.shape[k]) @ pressure.sum(axis=1 - k)) / total for k in (0, 1)
    ]  # sums of all rows and of all columns
    i, j = places[np.argmin(np.hypot(*(places - middle).T))]
    return int(i), int(j)


def pooled(field: NDArray[Any], *, lowest: bool = False, most: int = MOST_CELLS) -> tuple[NDArray[Any], int]:
    """Return the highest value (or the lowest) of each block of elements, and the edge of a block.

    There are at most ``most`` blocks along the longer side, so a picture of a fine grid has every contact,
    however small. The last blocks go on beyond the border.

    >>> import numpy as np
    >>> pooled(np.arange(6.0).reshape(2, 3), most=2)
    (array([[4., 5.]]), 2)
    """
    import numpy as np

    step = math.ceil(max(field.shape) / most)
    rest = [(0, -count % step) for count in field.shape]
    padded = np.pad(field, rest, mode="edge")
    i, j = (count // step for count in padded.shape)
    blocks = padded.reshape(i, step, j, step)
    found: NDArray[Any] = blocks.min(axis=(1, 3)) if lowest else blocks.max(axis=(1, 3))
    return found, step


def _range(occupied: NDArray[Any], count: int) -> tuple[int, int]:
    return (int(occupied[0]), int(occupied[-1]) + 1) if len(occupied) else (0, count)


def _widened(
    first: tuple[int, ...], last: tuple[int, ...], shape: tuple[int, int], spacings: tuple[float, float]
) -> tuple[tuple[int, int], tuple[int, int]]:
    """The ranges with a margin; the shorter side is a third of the longer, where the domain allows."""
    sides = [(b - a) * d for a, b, d in zip(first, last, spacings, strict=True)]
    margin = MARGIN * max(sides)
    least = (max(sides) + 2 * margin) / SLENDEREST
    low, high = [], []
    for a, b, side, count, d in zip(first, last, sides, shape, spacings, strict=True):
        wanted = max(side + 2 * margin, least, LEAST * d)
        extra = math.ceil((wanted - side) / (2 * d))
        start = max(a - extra, 0)
        end = min(b + extra, count)
        low.append(start)
        high.append(end)
    return (low[0], low[1]), (high[0], high[1])
