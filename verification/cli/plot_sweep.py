"""A sweep as a picture: means over realisations, their scatter as bands, error bars."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from verification.sweep.curves import Curves

# Okabe and Ito 2008, safe for colour-blind readers; markers and dashes tell curves apart in print
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
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
    "friction_coefficient": "friction coefficient $\\mu$",
    "contact_area": "real contact area $A$",
}


def draw(found: Curves, x: str, y: str, by: str | None, path: Path) -> None:
    """Write the picture; logarithmic axes where positive values span more than a decade."""
    import matplotlib

    matplotlib.use("Agg")  # no display is needed
    import matplotlib.pyplot as plt

    from verification.framework.files import replacing
    from verification.sweep.curves import is_logarithmic

    sx, sy = scale(x)[0], scale(y)[0]
    figure, axes = plt.subplots(figsize=(6.4, 4.2), layout="constrained")
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
    if is_logarithmic([point.mean - point.scatter for point in points]):
        axes.set_yscale("log")
    axes.set(xlabel=label(x), ylabel=label(y))
    if by:
        axes.legend(frameon=False, fontsize="small")
    axes.set_title(_caption(found), fontsize="small", loc="left")
    with replacing(path) as temporary:
        figure.savefig(temporary, dpi=150)
    plt.close(figure)


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
    """What bars and bands are, and how many error bars are unbounded."""
    points = [point for curve in found.values() for point in curve]
    most = max((point.realisations for point in points), default=0)
    unbounded = sum(1 for point in points if math.isinf(point.error))
    band = f"; band: standard deviation of {most} realisations" if most > 1 else ""
    missing = f"; {unbounded} error bars unbounded, not drawn" if unbounded else ""
    return f"bars: mean error bar of a solve{band}{missing}"
