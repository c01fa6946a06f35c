"""Measured surfaces: which way up, a window of the file, gaps filled, form removed, on element centres."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from pathlib import Path
from typing import Any, ClassVar, Self

import numpy as np

from refimpl.errors import InputError, require_number, require_one_of, require_size, size_text
from refimpl.grid import Array, Grid
from refimpl.measured.crop import (
    ROUNDING,
    Crop,
    Oriented,
    check_orientation,
    checked_centre,
    extent,
    oriented,
)
from refimpl.measured.detrending import Form, check_level, fit_form
from refimpl.measured.missing_points import fill
from refimpl.measured.preparation import check_preparation, prepare, standing_out
from refimpl.measured.reader_process import read_untrusted, refuse_huge
from refimpl.measured.readers import UNITS, RawHeights, read
from refimpl.surfaces.arrays import MEMORY, resample, resample_periodic
from refimpl.surfaces.from_table import KINDS
from refimpl.surfaces.surface import Surface, pixel_edges

_ALLOWED_FRACTION = "a fraction, 0 <= max_missing < 1"


@dataclass(frozen=True)
class MeasuredSurface(Surface):
    """Measured heights from a file (which: ``readers.read``), treated in this order:

    1. outliers, scan lines, wavelengths (``preparation.prepare``): points further than ``outliers`` spreads
       from the median of their neighbours become missing; lines along ``scan_lines``, ``"x"`` or ``"y"`` of
       the file, are levelled one by one; ``low_pass`` and ``high_pass`` (m) filter the whole map;
    2. orientation: heights point out of the material, x to the right and y up as seen from outside.
       ``replica=True`` negates them; ``mirror="x"`` or ``"y"`` mirrors (x -> -x, y -> -y); ``rotate_deg``
       turns them anticlockwise (unless by quarters interpolated, in a rectangle inside);
       ``turn_over`` turns the specimen over about the x axis, z(x, y) -> -z(x, -y), by default where it is
       the upper body;
    3. window: the scene's domain about ``centre`` (m from the corner of the file's own area, by default its
       middle), moved by the offset; refused where it leaves that area, in which each point counts as one
       pixel. A map that ``repeats`` with its own area (m) has no border;
    4. level: the least-squares ``"mean"``, ``"plane"`` (the default), ``"paraboloid"`` (all six quadratic
       terms), polynomial of total degree ``level = 3 ... 10``, ``"cylinder"`` or ``"sphere"`` of the measured
       points in the window at offset 0 is subtracted everywhere, so that a shifted surface remains the same
       rigid body; ``"none"`` subtracts nothing; of a map that repeats only the mean can be;
    5. gaps: ``missing="fill"`` fills by Laplace's equation (``missing_points.fill``), but refuses a window
       with more than the fraction ``max_missing`` of its points missing; ``missing="refuse"`` refuses any;
    6. bicubic resampling to the element centres: sampled, not averaged; within the outermost half pixel of
       the measured area the spline's end piece goes on.

    Heights are multiplied by ``height_scale``, the instrument's z calibration: 1, and to be varied.
    ``unit`` (of heights: m, mm, um, nm, A, pm) and ``pixel_size`` (m; a number or (x, y)) are for files that
    do not state them, and override those that do; ``channel`` is a name or a number. Read on first use, then
    kept. Periodic scenes refuse it unless it ``repeats``, a whole number of times.
    """

    path: str | Path
    unit: str | None = field(default=None, kw_only=True)
    pixel_size: float | tuple[float, float] | None = field(default=None, kw_only=True)
    channel: str | int | None = field(default=None, kw_only=True)
    outliers: float | None = field(default=None, kw_only=True)
    scan_lines: str | None = field(default=None, kw_only=True)
    low_pass: float | None = field(default=None, kw_only=True)
    high_pass: float | None = field(default=None, kw_only=True)
    level: str | int | None = field(default=None, kw_only=True)
    missing: str = field(default="fill", kw_only=True)
    max_missing: float = field(default=0.05, kw_only=True)
    replica: bool = field(default=False, kw_only=True)
    mirror: str | None = field(default=None, kw_only=True)
    rotate_deg: float = field(default=0.0, kw_only=True)
    turn_over: bool | None = field(default=None, kw_only=True)
    centre: tuple[float, float] | None = field(default=None, kw_only=True)
    repeats: bool = field(default=False, kw_only=True)
    height_scale: float = field(default=1.0, kw_only=True)
    kind: ClassVar[str] = "measured"

    def __post_init__(self) -> None:
        path: object = self.path
        if not isinstance(path, str | Path) or not str(path) or "\0" in str(path):
            raise InputError("path", path, "the path of a file")
        object.__setattr__(self, "path", Path(path))
        if self.unit is not None:
            require_one_of("unit", self.unit, tuple(UNITS))
        if self.pixel_size is not None:
            object.__setattr__(self, "pixel_size", pixel_edges("pixel_size", self.pixel_size))
        for name in ("replica", "repeats"):
            if not isinstance(getattr(self, name), bool):
                raise InputError(name, getattr(self, name), "true or false")
        if self.level is None:
            object.__setattr__(self, "level", "mean" if self.repeats else "plane")
        require_size("height_scale", self.height_scale, "a positive factor on heights (z calibration)")
        check_level(self.level, self.repeats)
        check_preparation(self.channel, self.outliers, self.scan_lines, self.low_pass, self.high_pass)
        check_orientation(self.mirror, self.rotate_deg, self.turn_over, self.repeats)
        object.__setattr__(self, "rotate_deg", float(self.rotate_deg))
        if self.centre is not None:
            object.__setattr__(self, "centre", checked_centre(self.centre))
        require_one_of("missing", self.missing, ("fill", "refuse"))
        require_number("max_missing", self.max_missing, _ALLOWED_FRACTION, at_least=0, below=1)

    @property
    def _file(self) -> Path:
        return Path(self.path)

    @property
    def label(self) -> str:
        return self._file.name

    @cached_property
    def reading(self) -> RawHeights:
        """The content of the file, as it is (read once)."""
        pixel = None if self.pixel_size is None else pixel_edges("pixel_size", self.pixel_size)
        found = read_untrusted(self._file, partial(read, self._file, self.unit, pixel, self.channel))
        refuse_huge(self._file, found.heights)
        return found

    @cached_property
    def prepared(self) -> RawHeights:
        """The map without outliers and with its wavelengths filtered."""
        filters = self.low_pass, self.high_pass, self.repeats
        return prepare(self.reading, self.outliers, *filters, self.scan_lines)

    @cached_property
    def _oriented(self) -> Oriented:
        return self._laid(None)

    def _under(self, lengths: tuple[float, float]) -> Oriented:
        """Return the map as it lies under a domain, which a turned map may hold only in its own ratio."""
        most = extent(self._oriented.reading, self._oriented.centre)
        fits = all(edge <= (1 + ROUNDING) * whole for edge, whole in zip(lengths, most, strict=True))
        if fits or self.rotate_deg % 90 == 0:
            return self._oriented
        found: Oriented = self._last("laid", lengths, partial(self._laid, lengths))
        return found

    def _laid(self, ratio: tuple[float, float] | None) -> Oriented:
        return oriented(
            replace(self.prepared, heights=self.height_scale * self.prepared.heights),
            replica=self.replica,
            mirror=self.mirror,
            rotate_deg=self.rotate_deg,
            turned_over=self.turn_over is True,
            centre=self.centre,
            ratio=ratio,
        )

    def on_upper_body(self) -> MeasuredSurface:
        return self if self.turn_over is not None else self._turned

    @cached_property
    def _turned(self) -> MeasuredSurface:
        return self._with(turn_over=True)

    def _with(self, **changes: Any) -> Self:
        """Return the same file otherwise seen, read and filtered once."""
        other = replace(self, **changes)
        for name in ("reading", "prepared"):  # cached properties
            vars(other)[name] = getattr(self, name)
        return other

    def parameters(self) -> dict[str, float]:
        return {"height_scale": self.height_scale, "rotate_deg": self.rotate_deg}

    def same_realisation(self, periodic: bool) -> tuple[str, ...]:
        return ("height_scale",)

    def with_parameter(self, name: str, value: float) -> Self:
        return self._with(**{name: value})

    def extent(self, offset: tuple[float, float]) -> tuple[float, float]:
        reading = self._oriented.reading
        return reading.area if self.repeats else extent(reading, self._oriented.centre, offset)

    def heights_on(self, grid: Grid, offset: tuple[float, float]) -> Array:
        if self.repeats:
            return self._repeated(grid, offset)
        if grid.periodic:
            raise InputError("periodic", True, f"false: {self._file.name} does not repeat (repeats = true?)")
        window = self._crop(grid.lengths, offset)
        found: Array = self._last("sampled", (grid, offset), partial(self._resampled, grid, window))
        return found.copy()

    def _resampled(self, grid: Grid, window: Crop) -> Array:
        heights, (i, j) = window.filled(self._central(grid.lengths)[1])
        x, y = window.positions(grid.x, 0), window.positions(grid.y, 1)
        return resample(heights, x - i.start, y - j.start)

    @cached_property
    def _results(self) -> dict[str, tuple[object, Any]]:
        return {}

    def _last(self, name: str, key: object, compute: Callable[[], Any]) -> Any:
        """Return the last result of that name where its key is the same."""
        known = self._results.get(name)
        if known is None or known[0] != key:
            self._results[name] = known = key, compute()
        return known[1]

    def _repeated(self, grid: Grid, offset: tuple[float, float]) -> Array:
        reading, centre = self._oriented.reading, self._oriented.centre
        times = [length / period for length, period in zip(grid.lengths, reading.area, strict=True)]
        if grid.periodic and any(abs(n - max(round(n), 1)) > ROUNDING * n for n in times):
            allowed = f"whole multiples of the {size_text(reading.area)} m with which {reading.name} repeats"
            raise InputError("side", max(grid.lengths), allowed)
        x, y = (
            (at - length / 2 + moved + middle) / edge - 0.5
            for at, length, moved, middle, edge in zip(
                (grid.x, grid.y), grid.lengths, offset, centre, reading.pixel, strict=True
            )
        )
        z, form, _ = self._central(grid.lengths)
        filled = fill(np.pad(z, MEMORY, mode="wrap"), reading.pixel)[MEMORY:-MEMORY, MEMORY:-MEMORY]
        return resample_periodic(filled, x, y) - form(x, y)

    def _crop(self, lengths: tuple[float, float], offset: tuple[float, float] = (0.0, 0.0)) -> Crop:
        laid = self._under(lengths)
        reading, centre = laid.reading, laid.centre
        whole = Crop(reading, reading.area)
        window = whole if self.repeats else Crop(reading, lengths, offset, centre if self.centre else None)
        allowed = self.max_missing if self.missing == "fill" else 0.0
        if window.lost > allowed * window.size:
            said = f"{window.lost} of {window.size} points of the window in {self._file.name}"
            raise InputError("missing", said, f"at most a fraction of {allowed:.3g}")
        return window

    def _central(self, lengths: tuple[float, float]) -> tuple[Array, Form, Array]:
        """Return at offset 0 the window's points (missing ones NaN), their form, and what is left of them."""
        found: tuple[Array, Form, Array] = self._last("form", lengths, partial(self._levelled, lengths))
        return found

    def _levelled(self, lengths: tuple[float, float]) -> tuple[Array, Form, Array]:
        window = self._crop(lengths)
        (i, j), reading = window.points, window.reading
        z = reading.heights[i, j]
        x, y = np.arange(i.start, i.stop, dtype=float), np.arange(j.start, j.stop, dtype=float)
        assert self.level is not None  # set in __post_init__
        form = fit_form(x, y, z, self.level, reading.pixel)
        rest = z - form(x, y)
        rest.flags.writeable = False  # kept for the next who asks
        return z, form, rest

    def levelled(self, lengths: tuple[float, float]) -> tuple[Form, Array, tuple[float, float]]:
        """Form of the window of those lengths (m) at offset 0, what is left of its points, their spacings."""
        _, form, rest = self._central(lengths)
        return form, rest, self._under(lengths).reading.pixel

    def describe(self, grid: Grid) -> tuple[str, ...]:
        name, window = self._file.name, self._crop(grid.lengths)
        reading = window.reading
        about = "its middle" if self.centre is None else f"({self.centre[0]:g}, {self.centre[1]:g}) m"
        return (
            f"{name}: {size_text(reading.heights.shape)} points on {size_text(reading.area)} m, "
            f"read {reading.source}",
            f"{name}: the window of {size_text(grid.lengths)} m about {about} is used, "
            f"{size_text(part.stop - part.start for part in window.points)} points, resampled bicubically to "
            f"{grid} elements",
            f"{name}: {reading.orientation}",
            *self.notes(grid),
        )

    @property
    def file_notes(self) -> tuple[str, ...]:
        """Channel, orientation and what was changed in reading and preparing the file."""
        return (self.reading.orientation, *self.prepared.notes)

    def pitch(self, lengths: tuple[float, float]) -> float:
        return min(self._oriented.reading.pixel)

    def data_points(self, grid: Grid) -> tuple[Array, tuple[float, float]]:
        return self._central(grid.lengths)[2], self._under(grid.lengths).reading.pixel

    def notes(self, grid: Grid) -> tuple[str, ...]:
        """Return the notes on preparation, the form subtracted, points that stand out and filled ones."""
        name, window = self._file.name, self._crop(grid.lengths)
        z, form, rest = self._central(grid.lengths)
        pixel = window.reading.pixel
        said = [f"{name}: {note}" for note in window.reading.notes]
        if self.level != "none":
            tilt = size_text(slope / edge for slope, edge in zip(form.slopes, pixel, strict=True))
            bent = "" if form.radius is None else f", radius {form.radius:.4g} m"
            said.append(
                f"{name}: level {self.level!r} fitted in the window (slopes {tilt}{bent}) and subtracted; "
                f"rms height there {np.nanstd(z):.4g} m before, {np.nanstd(rest):.4g} m after"
            )
        said += [f"{name}: {note}" for note in standing_out(fill(rest, pixel), np.isfinite(rest))]
        if window.lost:
            said.append(
                f"{name}: {window.lost} of {window.size} points in the window are missing, filled in here"
            )
        if min(e / p for e, p in zip(grid.spacings, pixel, strict=True)) < 1.0 - ROUNDING:
            said.append(
                f"{name}: the element, {min(grid.spacings):.4g} m, is finer than the measured pixel, "
                f"{size_text(pixel)} m: what lies between the points is interpolated"
            )
        return tuple(said)

    def to_dict(self) -> dict[str, Any]:
        table = super().to_dict() | {"path": str(self._file.absolute())}
        unset = [name for name in ("replica", "rotate_deg", "repeats") if not table[name]]
        unset += ["height_scale"] if self.height_scale == 1 else []
        table = {key: value for key, value in table.items() if key not in unset}
        pairs = {name: table[name] for name in ("pixel_size", "centre") if name in table}
        return table | {name: list(pair) for name, pair in pairs.items()}

    @classmethod
    def from_table(cls, table: dict[str, Any], folder: Path) -> Self:
        path = table["path"]
        return cls(**table | {"path": folder / path if isinstance(path, str) and path else path})


KINDS[MeasuredSurface.kind] = MeasuredSurface
