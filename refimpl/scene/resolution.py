"""Resolution of a scene by its grid: elements per finest length of each random roughness."""

from __future__ import annotations

import math
from dataclasses import dataclass

from refimpl.grid import Grid
from refimpl.scene.scene import Scene
from refimpl.surfaces.surface import Detail

_LEAST = 1e-6  # share of the mean square gradient that is worth a part of a bar


@dataclass(frozen=True)
class Resolution:
    """The finest detail of a scene's roughness, elements per length on the grid, and the number required."""

    detail: Detail
    elements: float
    required: float


def resolution(scene: Scene, grid: Grid, accuracy: float) -> Resolution | None:
    """Return the resolution of the roughness that is resolved worst; None without random roughness.

    Contact area goes as the inverse of the slope seen. For Eq. (9): ``l/h >= sqrt(2.3 / accuracy)``.
    """
    spacing = max(grid.spacings)
    found = [
        Resolution(detail, detail.length / spacing, detail.required(accuracy))
        for detail in _details(scene, spacing)
    ]
    return min(found, key=lambda one: one.elements / one.required, default=None)


def unresolved_slope(scene: Scene, grid: Grid) -> float:
    """Return the share of the rms gradient that the grid does not hold (Bush, Gibson and Thomas 1975)."""
    details = _details(scene, max(grid.spacings))
    squares = [detail.gradient**2 for detail in details]
    missed = sum(detail.unresolved * square for detail, square in zip(details, squares, strict=True))
    return 1 - math.sqrt(max(1 - missed / sum(squares), 0.0)) if missed > _LEAST * sum(squares) else 0.0


def _details(scene: Scene, spacing: float) -> list[Detail]:
    parts = (*scene.lower.surface.parts, *scene.upper.surface.parts)
    return [detail for part in parts if (detail := part.detail(spacing)) is not None]
