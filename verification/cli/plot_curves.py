"""Pictures of sweeps and fits: means with their scatter and error bars, data with a fit's band and region."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING

from verification.cli.plot_style import BLACK, BLUE, GREEN, ORANGE, PINK, subplots, write

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis

    from refimpl.identification import Identification
    from verification.sweep.curves import Curves

MEGA = 1e6
JOINT = 5.991464547107979  # 95 % quantile of chi-square, two degrees of freedom

# markers and dashes distinguish curves in print, too
COLOURS = (BLUE, ORANGE, GREEN, PINK, "#E69F00", "#56B4E9", BLACK)
MARKERS, DASHES = "osD^v<>", ("-", "--", "-.", ":")
SCALES = {
    "m": (1e6, "µm"),
    "Pa": (1e-6, "MPa"),
    "m^2": (1e6, "mm²"),
    "N": (1.0, "N"),
    "rad": (180 / math.pi, "°"),
}
LABELS = {
    "sliding_offset": "sliding distance",
    "friction_coefficient_corrected": "friction coefficient $\\mu$",
    "friction_coefficient": "friction coefficient $\\mu$, summed over elements",
    "contact_area": "real contact area $A$",
}


def draw_sweep(found: Curves, x: str, y: str, by: str | None, path: Path) -> None:
    """Write the picture; logarithmic axes where positive values span more than a decade."""
    from verification.sweep.curves import is_logarithmic

    sx, sy = scale(x)[0], scale(y)[0]
    figure, axes = subplots(figsize=(6.4, 4.2))
    for k, (value, points) in enumerate(found.items()):
        xs, means = [p.x * sx for p in points], [p.mean * sy for p in points]
        colour = COLOURS[k % len(COLOURS)]
        bars = [p.error * sy if math.isfinite(p.error) else math.nan for p in points]
        axes.errorbar(
            xs, means, bars, color=colour, marker=MARKERS[k % len(MARKERS)], markersize=4, capsize=2.5,
            linestyle=DASHES[k // len(COLOURS) % len(DASHES)], linewidth=1.2, label=_entry(by, value),
        )  # fmt: skip
        low, high = ([(p.mean + sign * p.scatter) * sy for p in points] for sign in (-1, 1))
        axes.fill_between(xs, low, high, color=colour, alpha=0.15, linewidth=0)
    points = [point for curve in found.values() for point in curve]
    if is_logarithmic([point.x for point in points]):
        axes.set_xscale("log")
        _plain_decades(axes.xaxis)
    if is_logarithmic([point.mean - point.scatter for point in points]):
        axes.set_yscale("log")
        _plain_decades(axes.yaxis)
    axes.set(xlabel=label(x), ylabel=label(y))
    if by:
        axes.legend(frameon=False, fontsize="small")
    axes.set_title(_caption(found), fontsize="small", loc="left")
    write(figure, path, dpi=150)


def _plain_decades(axis: Axis) -> None:
    """Set the ticks at 1, 2, 5 of each decade, as plain numbers; no labels between them."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(NullFormatter())


def scale(name: str) -> tuple[float, str]:
    """Return the factor from SI to the unit of an axis, and that unit.

    >>> scale("lower_rms"), scale("beta")
    ((1000000.0, 'µm'), (1.0, ''))
    """
    from verification.sweep.export import unit_of

    return SCALES.get(unit_of(name), (1.0, unit_of(name)))


def label(name: str) -> str:
    """Return the label of an axis: the name, and the unit.

    >>> label("load")
    'load (N)'
    """
    unit = scale(name)[1]
    text = LABELS.get(name, name.replace("_", " "))
    return f"{text} ({unit})" if unit else text


def _entry(by: str | None, value: object) -> str | None:
    if by is None:
        return None
    factor, unit = scale(by)
    shown = f"{value * factor:.4g}" if isinstance(value, int | float) else Path(str(value)).name
    return f"{by.replace('_', ' ')} = {shown} {unit}".rstrip()


def _caption(found: Curves) -> str:
    """Return what bars and bands are, and how many error bars are unbounded."""
    points = [point for curve in found.values() for point in curve]
    most = max((point.realisations for point in points), default=0)
    unbounded = sum(1 for point in points if math.isinf(point.error))
    band = f"; band: standard deviation of {most} realisations" if most > 1 else ""
    missing = f"; {unbounded} error bars unbounded, not drawn" if unbounded else ""
    return f"bars: mean error bar of a solve{band}{missing}"


def draw_identification(found: Identification, path: Path) -> None:
    """Write the picture: data with the fit's band, the region of tau and beta, residuals."""
    figure, axes = subplots(1, 3, figsize=(13, 4.2))
    _fit(axes[0], found)
    _region(axes[1], found)
    _residuals(axes[2], found)
    write(figure, path, dpi=130)


def _fit(axes: Axes, found: Identification) -> None:
    ordered = sorted(found.predictions, key=lambda p: p.load)
    loads = [p.load for p in ordered]
    axes.fill_between(
        loads, [p.mu.low for p in ordered], [p.mu.high for p in ordered], color=BLUE, alpha=0.25, lw=0,
        label="95 % interval of the model",
    )  # fmt: skip
    axes.plot(loads, [p.mu.value for p in ordered], color=BLUE, marker=".", label="model")
    axes.errorbar(
        [row.load for row in found.rows], [row.mu for row in found.rows],
        [1.96 * row.u_mu for row in found.rows],
        fmt="o", color=BLACK, ms=4, capsize=2, label="measured, 95 %",
    )  # fmt: skip
    axes.set(ylabel="μ")
    _loads(axes, loads)
    axes.legend(frameon=False, fontsize=8)


def _region(axes: Axes, found: Identification) -> None:
    """Draw the joint 95 % ellipse about the optimum without bounds, within the bounds, and both intervals.

    An interval without an upper end is drawn to the edge of the ellipse.
    """
    import numpy as np

    angle = np.linspace(0, 2 * np.pi, 2000)
    root = np.linalg.cholesky(found.covariance[:2, :2])
    ellipse = found.fitted.free[:2, None] + np.sqrt(JOINT) * root @ [np.cos(angle), np.sin(angle)]
    tau, beta = found.values["tau"], found.values["beta"]
    axes.plot(ellipse[0] / MEGA, ellipse[1], color=BLUE, label="joint 95 %, without bounds")
    highs = [
        one.high if np.isfinite(one.high) else max(edge, one.value)
        for one, edge in zip((tau, beta), ellipse.max(axis=1), strict=True)
    ]
    axes.errorbar(
        tau.value / MEGA, beta.value,
        [[beta.value - beta.low], [highs[1] - beta.value]],
        [[(tau.value - tau.low) / MEGA], [(highs[0] - tau.value) / MEGA]],
        fmt="o", color=ORANGE, capsize=3, label=f"95 % each, {found.method}",
    )  # fmt: skip
    for edge in (axes.axvline, axes.axhline):
        edge(0, color="0.6", lw=0.8)
    axes.set(xlabel="τ (MPa)", ylabel="β")
    axes.legend(frameon=False, fontsize=8)


def _residuals(axes: Axes, found: Identification) -> None:
    loads = [row.load for row in found.rows]
    axes.axhspan(-1.96, 1.96, color=BLUE, alpha=0.15, lw=0)
    axes.axhline(0, color="0.6", lw=0.8)
    axes.plot(loads, found.residuals, "o", color=BLACK, ms=4)
    far = found.outliers
    axes.plot([loads[k] for k in far], [found.residuals[k] for k in far], "o", color=ORANGE, ms=8, mfc="none")
    reach = max(4.0, 1.2 * max(map(abs, found.residuals)))
    axes.set(ylabel="residual / standard uncertainty", ylim=(-reach, reach))
    _loads(axes, loads)


def _loads(axes: Axes, loads: list[float]) -> None:
    """Make a logarithmic axis with plain numbers: 1, 2, 5 and their decades within the loads."""
    axes.set(xscale="log", xlabel="load (N)", xlim=(0.9 * min(loads), 1.1 * max(loads)))
    _plain_decades(axes.xaxis)
