"""Grid of a command without `--grid`: a measured map's own points, up to a limit."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from refimpl import Scene
    from refimpl.surfaces import Surface

_OF_FORMULAS = 256
_MOST = 512  # along the longer side, of a map with more points
DEFAULT_TEXT = f"default {_OF_FORMULAS}; of a measured map its own points, up to {_MOST}"


def default_grid(scene: Scene) -> int:
    """Return the elements along the longer side: one per point of the finest map, else a fixed number."""
    return own_points((*scene.parts("lower"), *scene.parts("upper")), scene.lengths)


def own_points(parts: Iterable[Surface], lengths: tuple[float, float]) -> int:
    """Return the points of the finest map along the longer of those lengths (m), up to the limit."""
    pitches = [pitch for part in parts if (pitch := part.pitch(lengths)) is not None]
    if not pitches:
        return _OF_FORMULAS
    return max(1, min(_MOST, round(max(lengths) / min(pitches))))
