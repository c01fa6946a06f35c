"""The local coefficient error of a surface as a picture: a map, or a profile of surfaces that are long."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from verification.cli.plot_style import BLACK, BLUE, ORANGE, print_style, write

MILLI = 1e-3
SLENDER = 4.0  # ratio of the lengths from which a profile shows more than a map

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from refimpl.sensitivities.surface_verdict import SurfaceVerdict


def draw_local_error(verdict: SurfaceVerdict, path: Path) -> None:
    """Write the picture, in the format of the path's suffix; maps in vector formats are images within."""
    low, high = sorted(verdict.solution.grid.lengths)
    slender = high > SLENDER * low
    with print_style():
        import matplotlib.pyplot as plt

        figure, axes = plt.subplots(figsize=(4.4, 2.8 if slender else 3.8), layout="constrained")
        (_profile if slender else _map)(axes, verdict)
        figure.suptitle(_title(verdict), fontsize=8)
        write(figure, path)


def _title(verdict: SurfaceVerdict) -> str:
    percents = [_percent(verdict, name) for name in ("normal_force", "friction_coefficient", "contact_area")]
    return (
        f"Flat coefficients off by more than 2 % on {verdict.share_above:.1%} of the area;\n"
        f"N at the approach by {percents[0]}, mu by {percents[1]}, A by {percents[2]} (stated)"
    )


def _percent(verdict: SurfaceVerdict, name: str) -> str:
    row = verdict.numbers()[name]
    return f"{row['stated'] / abs(row['value']):.1%}" if row["value"] else "-"


def _map(axes: Axes, verdict: SurfaceVerdict) -> None:
    """Error in percent, the contact outlined, elements beyond the tables in grey."""
    import numpy as np

    grid = verdict.solution.grid
    lx, ly = (length / MILLI for length in grid.lengths)
    shown = axes.imshow(
        np.ma.masked_invalid(100 * verdict.local.T), origin="lower", extent=(0, lx, 0, ly), cmap="cividis",
        interpolation="nearest", vmin=0.0,
    )  # fmt: skip
    axes.set_facecolor("0.6")
    axes.figure.colorbar(shown, ax=axes, label="error of a flat's coefficients (%)")
    contact = verdict.solution.contact
    if contact.any() and not contact.all():
        axes.contour(
            grid.x / MILLI,
            grid.y / MILLI,
            contact.T.astype(float),
            levels=[0.5],
            colors=ORANGE,
            linewidths=0.9,
        )
    axes.set(xlabel="x (mm)", ylabel="y (mm)", title="at the undeformed slopes; orange: contact")


def _profile(axes: Axes, verdict: SurfaceVerdict) -> None:
    """Largest error across the longer side, where contact is, and the paper's 2 %."""
    import numpy as np

    grid = verdict.solution.grid
    along = 0 if grid.lengths[0] >= grid.lengths[1] else 1
    where = (grid.x, grid.y)[along] / MILLI
    error = 100 * verdict.local.max(axis=1 - along)
    axes.plot(where, np.where(np.isfinite(error), error, np.nan), color=BLUE)
    touching = verdict.solution.contact.any(axis=1 - along)
    bottom = np.zeros_like(where)
    axes.plot(where, np.where(touching, bottom, np.nan), color=ORANGE, linewidth=5, label="contact")
    axes.axhline(2.0, color=BLACK, linewidth=0.8, linestyle=":", label="2 %")
    axes.set(xlabel=f"{'xy'[along]} (mm)", ylabel="error of a flat's coefficients (%)")
    axes.legend(frameon=False)
