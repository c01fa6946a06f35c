"""Pictures of surfaces: an inspected one with autocorrelation and spectrum, a half-space's local error."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING

from verification.cli.plot_style import BLACK, BLUE, ORANGE, print_style, subplots, write

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from refimpl import Inspection
    from refimpl.sensitivities.surface_verdict import SurfaceVerdict

MILLI, MICRO, NANO = 1e-3, 1e-6, 1e-9
SLENDER = 4.0  # ratio of the lengths from which a profile shows more than a map


def draw_inspection(found: Inspection, path: Path) -> None:
    """Write the picture: the map above, its autocorrelation and its spectrum beside and below."""
    figure, axes = subplots(2, 2, figsize=(10, 8.5))
    draw_map(axes[0, 0], found)
    _autocorrelation_map(axes[0, 1], found)
    _profiles(axes[1, 0], found)
    _spectrum(axes[1, 1], found)
    numbers = found.parameters
    figure.suptitle(
        f"{found.surface.label}: Sq = {numbers['Sq'] / NANO:.4g} nm, Sdq = {numbers['Sdq']:.3g}, "
        f"Sal = {numbers['Sal'] / MICRO:.3g} µm, {found.surface.level} subtracted"
    )
    write(figure, path, dpi=120)


def draw_map(axes: Axes, found: Inspection) -> None:
    """Draw heights in nm over x, y in µm, as seen from outside the body; missing points are white."""
    import numpy as np

    lx, ly = (n * edge / MICRO for n, edge in zip(found.z.shape, found.pixel, strict=True))
    low, high = np.nanpercentile(found.z, [0.5, 99.5]) / NANO
    image = axes.imshow(
        np.ma.masked_invalid(found.z.T) / NANO, origin="lower", extent=(0, lx, 0, ly), cmap="viridis",
        vmin=low, vmax=high, interpolation="nearest",
    )  # fmt: skip
    axes.set(xlabel="x (µm)", ylabel="y (µm)", title="Height, from outside the body")
    axes.figure.colorbar(image, ax=axes, label="nm")


def _autocorrelation_map(axes: Axes, found: Inspection) -> None:
    import numpy as np

    acf = found.autocorrelation
    x, y = (lags / MICRO for lags in acf.lags)
    extent = (x[0], x[-1], y[0], y[-1])
    image = axes.imshow(acf.values.T, origin="lower", extent=extent, cmap="RdBu_r", vmin=-1, vmax=1)
    axes.contour(x, y, np.nan_to_num(acf.values.T), levels=[0.2], colors=BLACK, linewidths=1)
    axes.set(xlabel="lag in x (µm)", ylabel="lag in y (µm)", title="Autocorrelation; line: 0.2")
    axes.figure.colorbar(image, ax=axes)


def _profiles(axes: Axes, found: Inspection) -> None:
    acf = found.autocorrelation
    middle = tuple(n // 2 for n in acf.values.shape)
    x, y = (lags / MICRO for lags in acf.lags)
    axes.plot(x[middle[0] :], acf.values[middle[0] :, middle[1]], color=BLUE, label="along x")
    axes.plot(y[middle[1] :], acf.values[middle[0], middle[1] :], color=ORANGE, label="along y")
    for level, name in ((0.1, "10 %"), (math.exp(-1), "1/e")):
        axes.axhline(level, color=BLACK, linewidth=0.7, linestyle=":")
        axes.text(1.0, level, name, transform=axes.get_yaxis_transform(), ha="right", va="bottom")
    axes.set(xlabel="lag (µm)", ylabel="autocorrelation", title="Autocorrelation along the axes")
    axes.legend(frameon=False)


def _spectrum(axes: Axes, found: Inspection) -> None:
    spectrum = found.spectrum
    axes.loglog(spectrum.q * MICRO, spectrum.C / (MICRO**2 * NANO**2), color=BLUE)
    axes.set(
        xlabel="q = 2π / wavelength (rad/µm)", ylabel="C (µm² nm²)",
        title="Power spectral density, mean over directions",
    )  # fmt: skip


def draw_local_error(verdict: SurfaceVerdict, path: Path) -> None:
    """Write the picture, in the format of the path's suffix; maps in vector formats are images within."""
    low, high = sorted(verdict.solution.grid.lengths)
    slender = high > SLENDER * low
    with print_style():
        figure, axes = subplots(figsize=(4.4, 2.8 if slender else 3.8))
        (_error_profile if slender else _error_map)(axes, verdict)
        rows = [verdict.numbers()[name] for name in ("normal_force", "friction_coefficient", "contact_area")]
        N, mu, A = (f"{row['stated'] / abs(row['value']):.1%}" if row["value"] else "-" for row in rows)
        figure.suptitle(
            f"Flat coefficients off by more than 2 % on {verdict.share_above:.1%} of the area;\n"
            f"N at the approach by {N}, mu by {mu}, A by {A} (stated)",
            fontsize=8,
        )
        write(figure, path)


def _error_map(axes: Axes, verdict: SurfaceVerdict) -> None:
    """Draw the error in percent, the contact outlined, elements beyond the tables in grey."""
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


def _error_profile(axes: Axes, verdict: SurfaceVerdict) -> None:
    """Draw the largest error across the longer side, where contact is, and the paper's 2 %."""
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
