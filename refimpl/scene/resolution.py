"""Resolution of a scene by its grid: elements per correlation length of each Gaussian roughness."""

from __future__ import annotations

import math
from dataclasses import dataclass

from refimpl.grid import Grid
from refimpl.scene.scene import Scene
from refimpl.surfaces import GaussianRoughness
from refimpl.surfaces.gaussian import DECAY


@dataclass(frozen=True)
class Resolution:
    """The scene's shortest correlation length (m), elements per length on the grid, and the number
    required."""

    correlation_length: float
    elements: float
    required: float


def resolution(scene: Scene, grid: Grid, accuracy: float) -> Resolution | None:
    """Return the resolution of the shortest correlation length; None without Gaussian roughness.

    Central differences of spacing h see the mean square slope of Eq. (9) too small by ``4.6 (h/l)^2``
    (`refimpl.surfaces.statistics.rms_slopes`), hence the rms slope by half of that, and the contact area
    goes as its inverse: ``l/h >= sqrt(2.3 / accuracy)``.
    """
    parts = (*scene.lower.surface.parts, *scene.upper.surface.parts)
    lengths = [part.correlation_length for part in parts if isinstance(part, GaussianRoughness)]
    if not lengths:
        return None
    shortest = min(lengths)
    return Resolution(shortest, shortest / max(grid.spacings), math.sqrt(DECAY / accuracy))
