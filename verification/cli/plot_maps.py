"""Maps of a solution about its contact: pressure with plastic zones, shear, gap, and the whole domain."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from verification.cli.plot_style import BLACK, BLUE, ORANGE, PINK, scaled_unit

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from refimpl import Solution
    from refimpl.grid import Array, Mask
    from refimpl.solution.units import Unit

MARGIN = 0.12  # share of the contact's longer side, on each side of it
LEAST = 8  # elements along each side of the window
MOST_OF_DOMAIN = 0.6  # share of the domain from which on all of it is shown
SLENDEREST = 3.0  # ratio of the window's sides; beyond, lengths are drawn to two scales
_WIDEST_GAP = 99.5  # percentile of the gap in the window at which its colours end
MOST_CELLS = 512  # cells along the longer side of a map; 2.6 inches at 200 dots


@dataclass(frozen=True)
class View:
    """Window and units of a picture.

    first, last : element indices ``[i, j]``, ``last`` excluded
    peak : element of p_max; of several, that nearest to the middle of the load
    spacings : edges of an element (m)
    whole : True if the window is the domain
    length, pressure, gap : units
    """

    first: tuple[int, int]
    last: tuple[int, int]
    peak: tuple[int, int]
    spacings: tuple[float, float]
    whole: bool
    length: Unit
    pressure: Unit
    gap: Unit

    def cut(self, field: NDArray[Any]) -> NDArray[Any]:
        """Return the window's part of a field of the grid's shape."""
        (i, j), (k, n) = self.first, self.last
        return field[i:k, j:n]

    @property
    def origin(self) -> tuple[float, float]:
        """Corner of the window (m), from the domain's corner."""
        return self.first[0] * self.spacings[0], self.first[1] * self.spacings[1]

    @property
    def size(self) -> tuple[float, float]:
        """Sides of the window (m)."""
        return _sides(self.first, self.last, self.spacings)

    @property
    def extent(self) -> tuple[float, float, float, float]:
        """Left, right, bottom and top in the unit of length."""
        (x, y), (width, height) = self.origin, self.size
        left, right, bottom, top = (s / self.length.size for s in (x, x + width, y, y + height))
        return left, right, bottom, top

    def edges(self, step: int) -> tuple[float, float]:
        """Return the edges of a block of ``step`` elements per side, in the unit of length."""
        return step * self.spacings[0] / self.length.size, step * self.spacings[1] / self.length.size

    @property
    def is_slender(self) -> bool:
        """True if lengths cannot be drawn to one scale."""
        return max(self.size) > SLENDEREST * min(self.size)


def view_of(solution: Solution) -> View:
    """Return the window about the contact; the domain without contact, or where contact is all over."""
    import numpy as np

    grid = solution.grid
    first, last = (0, 0), grid.shape
    if solution.contact.any():
        places = np.argwhere(solution.contact)
        ends = places.min(axis=0).tolist(), (places.max(axis=0) + 1).tolist()
        first, last = _widened(*ends, grid.shape, grid.spacings)
    share = math.prod(b - a for a, b in zip(first, last, strict=True)) / grid.elements
    whole = share >= MOST_OF_DOMAIN
    if whole:
        first, last = (0, 0), grid.shape
    gap = solution.gap[first[0] : last[0], first[1] : last[1]]
    return View(
        first=first,
        last=last,
        peak=peak_of(solution.pressure),
        spacings=grid.spacings,
        whole=whole,
        length=scaled_unit(max(_sides(first, last, grid.spacings)), "m"),
        pressure=scaled_unit(solution.max_pressure, "Pa"),
        gap=scaled_unit(float(np.percentile(gap, 99)), "m"),
    )


def peak_of(pressure: Array) -> tuple[int, int]:
    """Return the element of p_max; of equal ones, that nearest to the middle of the load."""
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
    """
    import numpy as np

    step = math.ceil(max(field.shape) / most)
    rest = [(0, -count % step) for count in field.shape]
    padded = np.pad(field, rest, mode="edge")
    i, j = (count // step for count in padded.shape)
    blocks = padded.reshape(i, step, j, step)
    found: NDArray[Any] = blocks.min(axis=(1, 3)) if lowest else blocks.max(axis=(1, 3))
    return found, step


def _sides(first: Sequence[int], last: Sequence[int], spacings: tuple[float, float]) -> tuple[float, float]:
    return (last[0] - first[0]) * spacings[0], (last[1] - first[1]) * spacings[1]


def _widened(
    first: Sequence[int], last: Sequence[int], shape: tuple[int, int], spacings: tuple[float, float]
) -> tuple[tuple[int, int], tuple[int, int]]:
    """Return the ranges with a margin; the shorter side is a third of the longer, where the domain allows."""
    sides = _sides(first, last, spacings)
    margin = MARGIN * max(sides)
    least = (max(sides) + 2 * margin) / SLENDEREST
    low, high = [], []
    for a, b, side, count, d in zip(first, last, sides, shape, spacings, strict=True):
        wanted = max(side + 2 * margin, least, LEAST * d)
        extra = math.ceil((wanted - side) / (2 * d))
        low.append(max(a - extra, 0))
        high.append(min(b + extra, count))
    return (low[0], low[1]), (high[0], high[1])


def pressure_map(axes: Axes, solution: Solution, view: View) -> None:
    """Draw the pressure in contact; elements at the hardness are outlined."""
    values = view.cut(solution.pressure) / view.pressure.size
    image = _image(axes, values, view, "viridis", vmin=0.0)
    _bar(axes, image, f"pressure p ({view.pressure.name})")
    plastic = view.cut(solution.details.plastic)
    if plastic.any():
        outline(axes, plastic, view, ORANGE)
    sections(axes, solution, view)


def shear_map(axes: Axes, solution: Solution, view: View) -> None:
    """Draw the local friction in contact; elements without adhesive shear in a colour of their own."""
    unit = scaled_unit(float(solution.traction.max()), "Pa")
    values = view.cut(solution.traction) / unit.size
    image = _image(axes, values, view, "cividis", vmin=0.0)
    _bar(axes, image, f"shear r ({unit.name})")
    excluded = view.cut(solution.details.excluded & solution.contact)
    if excluded.any():
        _overlay(axes, excluded, view, PINK)
        outline(axes, excluded, view, PINK)  # single elements of a fine grid are too small to be seen
    if not solution.traction.any():
        axes.text(0.5, 0.5, "no friction", ha="center", va="center", transform=axes.transAxes)
    _arrow(axes, solution.details.sliding_direction)


def gap_map(axes: Axes, solution: Solution, view: View) -> None:
    """Draw the gap between the deformed surfaces; the contact in a colour of its own."""
    import numpy as np

    gap = np.maximum(view.cut(solution.gap), 0.0) / view.gap.size
    top = float(np.percentile(gap, _WIDEST_GAP))
    image = _image(axes, gap, view, "Blues", lowest=True, vmin=0.0, vmax=top or 1.0)
    _bar(axes, image, f"gap ({view.gap.name})", extend="max" if gap.max() > top else "neither")
    _overlay(axes, view.cut(solution.contact), view, ORANGE)


def domain_map(axes: Axes, solution: Solution, view: View) -> None:
    """Draw the whole domain: the contact, and the window of the other maps."""
    from matplotlib.patches import Rectangle

    whole = replace(view, first=(0, 0), last=solution.grid.shape)
    _overlay(axes, solution.contact, whole, BLUE, most=160)
    left, right, bottom, top = view.extent
    axes.add_patch(Rectangle((left, bottom), right - left, top - bottom, fill=False, ec=BLACK, lw=0.8))
    _, width, _, height = whole.extent
    axes.set_xticks([0, width], ["0", f"{width:.4g}"])
    axes.set_yticks([0, height], ["0", f"{height:.4g}"])
    axes.set_title(f"whole domain ({view.length.name})")


def sections(axes: Axes, solution: Solution, view: View) -> None:
    """Draw the lines of both profiles, through the peak."""
    x, y = solution.grid.x[view.peak[0]], solution.grid.y[view.peak[1]]
    for line in (axes.axhline(y / view.length.size), axes.axvline(x / view.length.size)):
        line.set(color=BLACK, linestyle=(0, (4, 3)), linewidth=0.6)


def outline(axes: Axes, where: Mask, view: View, colour: str) -> None:
    """Draw the edges between elements inside and outside of a set."""
    import numpy as np
    from matplotlib.collections import LineCollection

    where, step = pooled(where)
    left, _, bottom, _ = view.extent
    dx, dy = view.edges(step)
    padded = np.pad(where, 1)
    upright = np.argwhere(padded[1:, 1:-1] != padded[:-1, 1:-1])
    level = np.argwhere(padded[1:-1, 1:] != padded[1:-1, :-1])
    lines = [[(i, j), (i, j + 1)] for i, j in upright] + [[(i, j), (i + 1, j)] for i, j in level]
    if lines:
        placed = np.array(lines, dtype=float) * (dx, dy) + (left, bottom)
        axes.add_collection(LineCollection(list(placed), colors=colour, linewidths=0.7))


def _image(
    axes: Axes, values: Array, view: View, colours: str, *, lowest: bool = False, **limits: Any
) -> Any:
    """Return a field over the window; zeros of pressure and shear are left white."""
    import numpy as np

    blocks, step = pooled(values, lowest=lowest)
    shown = blocks if lowest else np.ma.masked_equal(blocks, 0.0)
    image = _show(axes, shown.T, step, view, cmap=colours, **limits)
    axes.set(xlabel=f"x ({view.length.name})", ylabel=f"y ({view.length.name})")
    return image


def _overlay(axes: Axes, where: Mask, view: View, colour: str, most: int = MOST_CELLS) -> None:
    import numpy as np
    from matplotlib.colors import ListedColormap

    blocks, step = pooled(where, most=most)
    _show(axes, np.ma.masked_equal(blocks.T, 0), step, view, cmap=ListedColormap([colour]))


def _show(axes: Axes, picture: NDArray[Any], step: int, view: View, **options: Any) -> Any:
    left, right, bottom, top = view.extent
    dx, dy = view.edges(step)
    image = axes.imshow(
        picture, origin="lower",
        extent=(left, left + picture.shape[1] * dx, bottom, bottom + picture.shape[0] * dy),
        aspect="auto" if view.is_slender else "equal", interpolation="nearest", **options,
    )  # fmt: skip
    axes.set(xlim=(left, right), ylim=(bottom, top))
    return image


def _bar(axes: Axes, image: Any, title: str, extend: str = "neither") -> None:
    axes.figure.colorbar(image, cax=axes.inset_axes((1.03, 0.0, 0.05, 1.0)), extend=extend)
    axes.set_title(title, loc="left")


def _arrow(axes: Axes, direction: float) -> None:
    """Draw the direction of sliding above the map's right corner."""
    above: Any = {"xycoords": "axes fraction", "textcoords": "offset points", "va": "center"}
    turned = math.degrees(direction)
    axes.annotate("→", (1.0, 1.0), (-9.0, 8.0), ha="center", rotation=turned, fontsize=14, **above)
    axes.annotate("sliding", (1.0, 1.0), (-22.0, 8.0), ha="right", fontsize=7, **above)
