"""Measured surfaces: the central window of a file, gaps filled, form removed, on the element centres."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any, ClassVar, Self

import numpy as np

from refimpl.errors import InputError
from refimpl.grid import Array, Grid
from refimpl.surfaces.bicubic import resample
from refimpl.surfaces.crop import ROUNDING, Crop, by
from refimpl.surfaces.detrending import DEGREES, Form, fit
from refimpl.surfaces.readers import UNITS, Reading, read
from refimpl.surfaces.surface import Surface, finite, positive
from refimpl.surfaces.untrusted import read_untrusted, refuse_huge

_ALLOWED_PIXEL = "a positive length in m, or two (x, y)"
_ALLOWED_FRACTION = "a fraction, 0 <= max_missing < 1"


@dataclass(frozen=True)
class MeasuredSurface(Surface):
    """Measured heights from a file (which: ``readers.read``), treated in this order:

    1. window: the square of the scene's side about the middle of the measured area, moved by the offset;
       refused where it leaves that area, in which each point counts as one pixel;
    2. gaps: ``missing="fill"`` fills by Laplace's equation (``gaps.fill``), but refuses a window with more
       than the fraction ``max_missing`` of its points missing; ``missing="refuse"`` refuses any;
    3. level: the least-squares ``"mean"``, ``"plane"`` or ``"paraboloid"`` (all six quadratic terms) of the
       points in the window at offset 0 is taken off everywhere, so that a shifted surface remains the same
       rigid body; ``"none"`` takes nothing off;
    4. bicubic resampling to the element centres: sampled, not averaged; within the outermost half pixel of
       the measured area the spline's end piece goes on.

    ``unit`` (of heights: m, mm, um, nm, pm) and ``pixel_size`` (m; a number or (x, y)) are for files that do
    not state them. Read on first use, then kept. Periodic scenes refuse it: measured heights do not repeat.
    """

    path: str | Path
    unit: str | None = field(default=None, kw_only=True)
    pixel_size: float | tuple[float, float] | None = field(default=None, kw_only=True)
    level: str = field(default="plane", kw_only=True)
    missing: str = field(default="fill", kw_only=True)
    max_missing: float = field(default=0.05, kw_only=True)
    kind: ClassVar[str] = "measured"

    def __post_init__(self) -> None:
        if not isinstance(self.path, str | Path) or not str(self.path) or "\0" in str(self.path):
            raise InputError("path", self.path, "the path of a file")
        object.__setattr__(self, "path", Path(self.path))
        if self.unit is not None:
            _require_one_of("unit", self.unit, tuple(UNITS))
        if self.pixel_size is not None:
            object.__setattr__(self, "pixel_size", _pixel(self.pixel_size))
        _require_one_of("level", self.level, tuple(DEGREES))
        _require_one_of("missing", self.missing, ("fill", "refuse"))
        if not 0 <= finite("max_missing", self.max_missing, _ALLOWED_FRACTION) < 1:
            raise InputError("max_missing", self.max_missing, _ALLOWED_FRACTION)

    @property
    def _file(self) -> Path:
        return Path(self.path)

    @cached_property
    def reading(self) -> Reading:
        """What the file holds, as it is (read once)."""
        pixel = None if self.pixel_size is None else _pixel(self.pixel_size)
        found = read_untrusted(self._file, lambda: read(self._file, self.unit, pixel))
        refuse_huge(self._file, found.heights)
        return found

    def _sample(self, grid: Grid, offset: tuple[float, float]) -> Array:
        if grid.periodic:
            raise InputError("periodic", True, f"false: {self._file.name} does not repeat")
        window = self._crop(grid.lengths, offset)
        heights, (i, j) = window.filled()
        x, y = window.positions(grid.x, 0), window.positions(grid.y, 1)
        return resample(heights, x - i.start, y - j.start) - self._central(grid.lengths)[1](x, y)

    def _crop(self, lengths: tuple[float, float], offset: tuple[float, float] = (0.0, 0.0)) -> Crop:
        window = Crop(self.reading, lengths, offset)
        allowed = self.max_missing if self.missing == "fill" else 0.0
        if window.lost > allowed * window.size:
            said = f"{window.lost} of {window.size} points of the window in {self._file.name}"
            raise InputError("missing", said, f"at most a fraction of {allowed:.3g}")
        return window

    def _central(self, lengths: tuple[float, float]) -> tuple[Array, Form, Array]:
        """At offset 0: the window's points with gaps filled, their form, and what is left of them."""
        window = self._crop(lengths)
        (i, j), (heights, (around_i, around_j)) = window.points, window.filled()
        z = heights[i.start - around_i.start :, j.start - around_j.start :]
        z = z[: i.stop - i.start, : j.stop - j.start]
        x, y = np.arange(i.start, i.stop, dtype=float), np.arange(j.start, j.stop, dtype=float)
        form = fit(x, y, z, DEGREES[self.level])
        return z, form, z - form(x, y)

    def describe(self, grid: Grid) -> tuple[str, ...]:
        name, reading = self._file.name, self.reading
        z, form, rest = self._central(grid.lengths)
        tilt = by(tuple(slope / pixel for slope, pixel in zip(form.slopes, reading.pixel, strict=True)))
        return (
            f"{name}: {by(reading.heights.shape)} points on {by(reading.area)} m, read {reading.source}",
            f"{name}: the central window of {by(grid.lengths)} m is used, {by(z.shape)} points, "
            f"resampled bicubically to {grid} elements",
            f"{name}: level {self.level!r} fitted in that window (slopes {tilt}) and subtracted; "
            f"rms height there {z.std():.4g} m before, {rest.std():.4g} m after",
            *self.cautions(grid),
        )

    def pitch(self, lengths: tuple[float, float]) -> float:
        return min(self.reading.pixel)

    def cautions(self, grid: Grid) -> tuple[str, ...]:
        name, window = self._file.name, Crop(self.reading, grid.lengths)
        said = []
        if window.lost:
            said.append(
                f"{name}: {window.lost} of {window.size} points in the window are missing, filled in here"
            )
        if min(e / p for e, p in zip(grid.spacings, self.reading.pixel, strict=True)) < 1.0 - ROUNDING:
            said.append(
                f"{name}: the element, {min(grid.spacings):.4g} m, is finer than the measured pixel, "
                f"{by(self.reading.pixel)} m: what lies between the points is interpolated"
            )
        return tuple(said)

    def to_dict(self) -> dict[str, Any]:
        table = super().to_dict() | {"path": str(self._file.absolute())}
        return table if self.pixel_size is None else table | {"pixel_size": list(_pixel(self.pixel_size))}

    @classmethod
    def from_table(cls, table: dict[str, Any], folder: Path) -> Self:
        path = table["path"]
        return cls(**table | {"path": folder / path if isinstance(path, str) and path else path})


def _pixel(value: object) -> tuple[float, float]:
    pair = tuple(value) if isinstance(value, list | tuple) else (value, value)
    if len(pair) != 2:
        raise InputError("pixel_size", value, _ALLOWED_PIXEL)
    return positive("pixel_size", pair[0], _ALLOWED_PIXEL), positive("pixel_size", pair[1], _ALLOWED_PIXEL)


def _require_one_of(name: str, value: object, allowed: tuple[str, ...]) -> None:
    if not isinstance(value, str) or value not in allowed:
        raise InputError(name, value, "one of " + ", ".join(allowed))
