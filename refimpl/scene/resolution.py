"""Resolution of a scene by its grid: elements per finest length of each random roughness."""

from __future__ import annotations

from dataclasses import dataclass

from refimpl.grid import Grid
from refimpl.scene.scene import Scene
from refimpl.surfaces.surface import Detail


@dataclass(frozen=True)
class Resolution:
    """The finest detail of a scene's roughness, elements per length on the grid, and the number required."""

    detail: Detail
    elements: float
    required: float


def resolution(scene: Scene, grid: Grid, accuracy: float) -> Resolution | None:
    """Return the resolution of the roughness that is resolved worst; None without random roughness.

    Central differences see the rms slope too small (`refimpl.surfaces.surface.Detail.required`), and the
    contact area goes as its inverse. For Eq. (9): ``l/h >= sqrt(2.3 / accuracy)``.
    """
    spacing = max(grid.spacings)
    parts = (*scene.lower.surface.parts, *scene.upper.surface.parts)
    found = [
        Resolution(detail, detail.length / spacing, detail.required(accuracy))
        for part in parts
        if (detail := part.detail(spacing)) is not None
    ]
    return min(found, key=lambda one: one.elements / one.required, default=None)
