"""Profiles of a solution through its peak, and histograms of pressure and gap."""

from __future__ import annotations

from typing import TYPE_CHECKING

from verification.cli.plot_style import BLACK, BLUE, GREEN, ORANGE

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from refimpl import Solution
    from verification.cli.plot_view import View
    from verification.exact.hertz import Sphere as HertzSphere

_BINS = 40
_GREY = "0.45"


def profile(axes: Axes, solution: Solution, view: View, hertz: HertzSphere | None, axis: int) -> None:
    """Pressure, shear and, to the right, the gap on the line of elements through the peak, along one axis."""
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
    """Share of the contact by pressure; what is at the hardness is a line with its share."""
    import numpy as np

    plastic = solution.plastic
    elastic = solution.pressure[solution.contact & ~plastic] / view.pressure.size
    contacts = int(np.count_nonzero(solution.contact))
    top = solution.max_pressure / view.pressure.size
    if len(elastic):
        axes.hist(
            elastic, bins=_BINS, range=(0.0, top), weights=np.full(len(elastic), 100 / contacts),
            histtype="stepfilled", color=BLUE,
        )  # fmt: skip
    if plastic.any():
        axes.axvline(top, color=ORANGE, linewidth=1.2)
    axes.set(xlabel=f"pressure p ({view.pressure.name})", ylabel="share (%)")
    share = f"; {100 * solution.plastic_share:.3g} % at the hardness (line)" if plastic.any() else ""
    axes.set_title(f"pressure in contact{share}")
    axes.set_xlim(0.0, 1.03 * top if top else 1.0)


def gap_histogram(axes: Axes, solution: Solution, view: View) -> None:
    """Share of the window by gap, outside of the contact, whose share the title states."""
    import numpy as np

    contact = view.cut(solution.contact)
    gap = view.cut(solution.gap)[~contact] / view.gap.size
    if len(gap):
        top = float(np.percentile(gap, 99.9))
        axes.hist(
            gap, bins=_BINS, range=(0.0, top or 1.0), weights=np.full(len(gap), 100 / contact.size),
            histtype="stepfilled", color=GREEN,
        )  # fmt: skip
        axes.set_xlim(0.0, top or 1.0)
    where = "domain" if view.whole else "window"
    axes.set(xlabel=f"gap ({view.gap.name})", ylabel="share (%)")
    axes.set_title(f"gap; {100 * contact.mean():.3g} % of the {where} in contact")
