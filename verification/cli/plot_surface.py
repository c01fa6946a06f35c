"""An inspected surface as a picture: map with its axes, autocorrelation, spectrum."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING

from verification.cli.plot_style import BLACK, BLUE, ORANGE

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from refimpl import Inspection

MICRO, NANO = 1e-6, 1e-9


def draw_inspection(found: Inspection, path: Path) -> None:
    """Write the picture: the map above, its autocorrelation and its spectrum beside and below."""
    import matplotlib

    matplotlib.use("Agg")  # no display is needed
    import matplotlib.pyplot as plt

    from verification.framework.files import replacing

    figure, axes = plt.subplots(2, 2, figsize=(10, 8.5), layout="constrained")
    draw_map(axes[0, 0], found)
    _autocorrelation_map(axes[0, 1], found)
    _profiles(axes[1, 0], found)
    _spectrum(axes[1, 1], found)
    numbers = found.parameters
    figure.suptitle(
        f"{found.surface.label}: Sq = {numbers['Sq'] / NANO:.4g} nm, Sdq = {numbers['Sdq']:.3g}, "
        f"Sal = {numbers['Sal'] / MICRO:.3g} µm, {found.surface.level} subtracted"
    )
    with replacing(path) as temporary:
        figure.savefig(temporary, dpi=120)
    plt.close(figure)


def draw_map(axes: Axes, found: Inspection) -> None:
    """Heights in nm over x, y in µm, as seen from outside the body; missing points are left white."""
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
