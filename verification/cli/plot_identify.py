"""An identification as a picture: data with the fit's band, the region of tau and beta, residuals."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from verification.cli.plot_style import BLACK, BLUE, ORANGE

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from refimpl.identification import Identification

MEGA = 1e6
JOINT = 5.991464547107979  # 95 % quantile of chi-square, two degrees of freedom


def draw(found: Identification, path: Path) -> None:
    """Write the picture."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    from verification.framework.files import replacing

    figure, axes = plt.subplots(1, 3, figsize=(13, 4.2), layout="constrained")
    _fit(axes[0], found)
    _region(axes[1], found)
    _residuals(axes[2], found)
    with replacing(path) as temporary:
        figure.savefig(temporary, dpi=130)
    plt.close(figure)


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
    """The joint 95 % ellipse about the optimum without bounds, within the bounds, and both intervals.

    An interval without an upper end is drawn to the edge of the ellipse.
    """
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
    """A logarithmic axis with plain numbers: 1, 2, 5 and their decades within the loads."""
    low, high = 0.9 * min(loads), 1.1 * max(loads)
    decades = 10.0 ** np.arange(np.floor(np.log10(low)), np.log10(high) + 1)
    ticks = [k * decade for decade in decades for k in (1, 2, 5) if low <= k * decade <= high]
    axes.set(xscale="log", xlabel="load (N)", xlim=(low, high))
    axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    axes.set_xticks([], minor=True)
