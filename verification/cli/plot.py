"""A solution as a picture: maps about the contact, profiles through the peak, histograms."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

from verification.cli.plot_maps import View, domain_map, gap_map, pressure_map, shear_map, view_of
from verification.cli.plot_style import (
    BLACK,
    BLUE,
    GREEN,
    ORANGE,
    PINK,
    print_style,
    write,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch
    from numpy.typing import NDArray

    from refimpl import Scene, Solution
    from verification.exact.hertz import Sphere as HertzSphere

WIDTH = 7.1  # inches, 180 mm: the width of a page's text
MAP, LOWEST_MAP, GRAPH = 2.35, 1.0, 1.05  # inches: width of all panels, least height of a map, of a graph
KEY = 2.15  # inches, least height of the numbers and the legend
_BINS = 40  # bins of a histogram
_SYMBOLS = {"mu": "μ", "p_max": "$p_{max}$", "delta": "approach δ"}
_GREY = "0.45"
ROOM = 2.7  # inches, for axes with their labels, and for titles


def draw(solution: Solution, scene: Scene, path: Path) -> None:
    """Write the picture: maps of pressure, shear and gap, profiles through the peak, histograms.

    Coordinates count from the domain's corner, as in arrays and tables. For a scene with a sphere the
    profiles have Hertz' pressure beside them.
    """
    view = view_of(solution)
    hertz = hertz_of(scene, solution.normal_force)
    ratio = 1.0 if view.is_slender else view.size[1] / view.size[0]  # lengths to one scale where they can be
    with print_style():
        figure, panels = _panels(min(max(MAP * ratio, LOWEST_MAP), MAP))
        pressure_map(panels["pressure"], solution, view)
        shear_map(panels["shear"], solution, view)
        gap_map(panels["gap"], solution, view)
        _key(panels["key"], solution, view, hertz)
        for axis, name in enumerate(("along x", "along y")):
            profile(panels[name], solution, view, hertz, axis)
        pressure_histogram(panels["pressures"], solution, view)
        gap_histogram(panels["gaps"], solution, view)
        write(figure, path)


def hertz_of(scene: Scene, load: float) -> HertzSphere | None:
    """Return the smooth, frictionless Hertz contact of a scene with a sphere; None without one."""
    from refimpl.surfaces.shapes import Sphere
    from verification.exact import hertz

    curvature = sum(
        sign / part.radius
        for sign, body in ((1, scene.upper), (-1, scene.lower))
        for part in getattr(body.surface, "parts", (body.surface,))
        if isinstance(part, Sphere)
    )
    if scene.periodic or curvature <= 0 or load <= 0:
        return None
    return hertz.Sphere(load=load, radius=1 / curvature, modulus=scene.materials.reduced_modulus)


def _panels(height: float) -> tuple[Figure, dict[str, Axes]]:
    """Return a figure and its panels by name: two columns, maps of this height (inches) above."""
    import matplotlib.pyplot as plt

    return plt.subplot_mosaic(
        [["pressure", "shear"], ["gap", "key"], ["along x", "along y"], ["pressures", "gaps"]],
        height_ratios=(height, max(height, KEY), GRAPH, GRAPH),
        figsize=(WIDTH, height + max(height, KEY) + 2 * GRAPH + ROOM),
        layout="constrained",
    )


def numbers_of(solution: Solution) -> list[str]:
    """Return the lines of numbers, each with the digits that its error bar leaves."""
    from refimpl.solution.quantities import QUANTITIES

    rows = ((name, quantity.symbol) for name, quantity in QUANTITIES.items() if "picture" in quantity.tables)
    turned = math.degrees(solution.details.sliding_direction)
    return [
        *(f"{_SYMBOLS.get(symbol, symbol)} = {_with_bar(solution, name)}" for name, symbol in rows),
        f"sliding at {turned:.4g}° from x",
        f"{solution.status.value}, {solution.grid.shape[0]} × {solution.grid.shape[1]} elements",
    ]


def _with_bar(solution: Solution, name: str) -> str:
    from refimpl.solution.display import shown

    return " ".join(shown(solution, name)).replace("+-", "±").replace("um", "µm").replace("^2", "²")


def _key(axes: Axes, solution: Solution, view: View, hertz: HertzSphere | None) -> None:
    """Draw the whole domain where the maps show a part of it, numbers, and meaning of lines and colours."""
    axes.axis("off")
    if not view.whole:
        domain_map(axes.inset_axes((-0.08, 0.56, 0.44, 0.40)), solution, view)
    left = 0.0 if view.whole else 0.46
    lines = [*numbers_of(solution), *(["x and y to different scales"] if view.is_slender else [])]
    axes.text(left, 1.04, "\n".join(lines), va="top", linespacing=1.3, fontsize=7)
    axes.legend(
        handles=legend_of(solution, hertz), loc="lower left", frameon=False, bbox_to_anchor=(-0.18, -0.2)
    )


def legend_of(solution: Solution, hertz: HertzSphere | None) -> list[Patch | Line2D]:
    """Return the entries of the legend: those of what the solution has."""
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    def line(label: str, colour: str, dashes: Any = "-", width: float = 1.1) -> Line2D:
        return Line2D([], [], color=colour, linestyle=dashes, linewidth=width, label=label)

    found = [
        line("pressure p", BLUE),
        line("shear r", ORANGE, (0, (3, 1))),
        line("gap (right scale)", _GREY, ":"),
    ]
    if hertz is not None:
        found.append(line("Hertz' pressure, smooth", BLACK, (0, (5, 2)), 0.8))
    found.append(line("maps: lines of the profiles", BLACK, (0, (4, 3)), 0.6))
    if solution.details.plastic.any():
        found.append(line("pressure map: edge of plastic zones", ORANGE, width=0.7))
    patches = [Patch(color=ORANGE, label="gap map: contact")]
    if (solution.details.excluded & solution.contact).any():
        patches.append(Patch(color=PINK, label="shear map: no adhesive shear, r = β p"))
    return [*found, *patches]


def profile(axes: Axes, solution: Solution, view: View, hertz: HertzSphere | None, axis: int) -> None:
    """Draw pressure, shear and, to the right, the gap along one axis through the peak."""
    import numpy as np

    grid = solution.grid
    across = view.peak[1 - axis]
    window = slice(view.first[axis], view.last[axis])
    s = (grid.x, grid.y)[axis][window] / view.length.size
    gap_axes = axes.twinx()
    gap = np.take(solution.gap, across, axis=1 - axis)[window] / view.gap.size
    gap_axes.plot(s, np.maximum(gap, 0.0), color=_GREY, linestyle=":", linewidth=1.0)
    gap_axes.set_ylabel(f"gap ({view.gap.name})", color=_GREY)
    gap_axes.tick_params(colors=_GREY)
    gap_axes.set_ylim(bottom=0.0)
    for name, label, colour, dashes in (
        ("pressure", "pressure p", BLUE, "-"),
        ("traction", "shear r", ORANGE, (0, (3, 1))),
    ):
        line = np.take(getattr(solution, name), across, axis=1 - axis)[window] / view.pressure.size
        axes.plot(s, line, color=colour, linestyle=dashes, linewidth=1.1, label=label)
    if hertz is not None:
        fine = np.linspace(s[0], s[-1], 1001)
        middle = [length / 2 for length in grid.lengths]
        offset = (grid.x, grid.y)[1 - axis][across] - middle[1 - axis]
        radius = np.hypot(fine * view.length.size - middle[axis], offset)
        smooth = hertz.pressure(radius) / view.pressure.size
        axes.plot(fine, smooth, color=BLACK, linestyle=(0, (5, 2)), linewidth=0.8, label="Hertz, smooth")
    letter, other = "xy" if axis == 0 else "yx"
    place = (grid.x, grid.y)[1 - axis][across] / view.length.size
    axes.set(
        xlabel=f"{letter} ({view.length.name})", ylabel=f"p, r ({view.pressure.name})",
        xlim=view.extent[2 * axis : 2 * axis + 2],
        title=f"profile through the peak, {other} = {place:.4g} {view.length.name}",
    )  # fmt: skip
    axes.set_ylim(bottom=0.0)
    axes.set_zorder(gap_axes.get_zorder() + 1)
    axes.patch.set_visible(False)


def pressure_histogram(axes: Axes, solution: Solution, view: View) -> None:
    """Draw the share of the contact by pressure; what is at the hardness is a line with its share."""
    import numpy as np

    plastic = solution.details.plastic
    elastic = solution.pressure[solution.contact & ~plastic] / view.pressure.size
    top = solution.max_pressure / view.pressure.size
    _histogram(axes, elastic, top, int(np.count_nonzero(solution.contact)), BLUE)
    if plastic.any():
        axes.axvline(top, color=ORANGE, linewidth=1.2)
    share = f"; {100 * solution.plastic_share:.3g} % at the hardness (line)" if plastic.any() else ""
    axes.set(xlabel=f"pressure p ({view.pressure.name})", title=f"pressure in contact{share}")
    axes.set_xlim(0.0, 1.03 * top if top else 1.0)


def gap_histogram(axes: Axes, solution: Solution, view: View) -> None:
    """Draw the share of the window by gap, outside of the contact, whose share the title states."""
    import numpy as np

    contact = view.cut(solution.contact)
    gap = view.cut(solution.gap)[~contact] / view.gap.size
    if len(gap):
        top = max(float(np.percentile(gap, 99.9)), 0.0) or 1.0  # gaps of rounding may be negative
        _histogram(axes, gap, top, contact.size, GREEN)
        axes.set_xlim(0.0, top)
    where = "domain" if view.whole else "window"
    axes.set(xlabel=f"gap ({view.gap.name})", ylabel="share (%)")
    axes.set_title(f"gap; {100 * contact.mean():.3g} % of the {where} in contact")


def _histogram(axes: Axes, values: NDArray[Any], top: float, count: int, colour: str) -> None:
    import numpy as np

    if len(values):
        weights = np.full(len(values), 100 / count)
        axes.hist(values, bins=_BINS, range=(0.0, top), weights=weights, histtype="stepfilled", color=colour)
    axes.set_ylabel("share (%)")
