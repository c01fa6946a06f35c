"""What a scene asks of its grid: elements per correlation length of each Gaussian roughness."""

from __future__ import annotations

import math
from dataclasses import dataclass

from refimpl.scene.scene import Scene
from refimpl.surfaces import GaussianRoughness
from refimpl.surfaces.gaussian import DECAY


@dataclass(frozen=True)
class Resolution:
    """Elements per correlation length: the shortest of the scene, on the grid, and what is asked for."""

    correlation_length: float
    elements: float
    asked: float


def resolution(scene: Scene, M: int, accuracy: float) -> Resolution | None:
    """The roughest demand of the scene on ``M x M`` elements; None without Gaussian roughness.

    Central differences of spacing h see the mean square slope of Eq. (9) too small by ``4.6 (h/l)^2``
    (`refimpl.surfaces.statistics.rms_slopes`), hence the rms slope by half of that, and the contact area
    goes as its inverse: ``l/h >= sqrt(2.3 / accuracy)``.
    """
    parts = (*scene.lower.surface.parts, *scene.upper.surface.parts)
    lengths = [part.correlation_length for part in parts if isinstance(part, GaussianRoughness)]
    if not lengths:
        return None
    shortest = min(lengths)
    return Resolution(shortest, shortest * M / scene.side, math.sqrt(DECAY / accuracy))
