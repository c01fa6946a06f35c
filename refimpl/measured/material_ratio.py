"""Material ratio curve (bearing curve) of a map and the parameters of its core, as ISO 25178-2 has them."""

from __future__ import annotations

import numpy as np

from refimpl.grid import Array

CLASSES = 10_000
CORE = 0.4  # material ratio of the core's secant


def material_ratio(z: Array, classes: int = CLASSES) -> tuple[Array, Array]:
    """Return material ratios 0 to 1, and the heights (m, from the mean) that those shares reach."""
    ratio = np.linspace(0.0, 1.0, classes + 1)
    return ratio, np.nanquantile(z, 1.0 - ratio) - np.nanmean(z)


def core_parameters(z: Array) -> dict[str, float]:
    """Return Sk, Spk, Svk (m) by the line over the flattest 40 % of the curve (ISO 25178-2)."""
    ratio, height = material_ratio(z)
    width = round(CORE * CLASSES)
    first = int(np.argmin(height[:-width] - height[width:]))
    core = slice(first, first + width + 1)
    fall, top = np.polyfit(ratio[core], height[core], 1)
    peaks, dales = height - top, top + fall - height
    return {"Sk": float(-fall), "Spk": _reduced(peaks), "Svk": _reduced(dales)}


def _reduced(beyond: Array) -> float:
    """Return the height of the triangle whose base and area are those beyond the core."""
    share = float(np.mean(beyond > 0))
    return 2.0 * float(np.maximum(beyond, 0.0).mean()) / share if share else 0.0
