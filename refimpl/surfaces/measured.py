"""Measured surfaces."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from refimpl.grid import Array, Grid
from refimpl.surfaces.base import Surface


@dataclass(frozen=True)
class MeasuredSurface(Surface):
    """Heights from an instrument's file."""

    path: str
    kind: ClassVar[str] = "measured"

    def _sample(self, grid: Grid, offset: tuple[float, float], periodic: bool) -> Array:
        raise NotImplementedError
