"""Record that every reader returns, units, and how the scene overrides what a file states."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

import numpy as np

from refimpl.errors import InputError, printable, require_size, size_text
from refimpl.grid import Array

T = TypeVar("T")

MAX_BYTES = 256 * 2**20
MAX_POINTS = 2**24
UNITS = {
    "m": 1.0,
    "mm": 1e-3,
    "um": 1e-6,
    "µm": 1e-6,
    "μm": 1e-6,
    "nm": 1e-9,
    "A": 1e-10,
    "Å": 1e-10,
    "pm": 1e-12,
}
ASCII = {"µm": "um", "μm": "um", "Å": "A"}

_NO_DATA = (-999.0, -9999.0, -99999.0, 999.0, 9999.0, 99999.0, -32768.0, 32767.0)  # in the file's unit
_FAR = 10.0  # ranges of all other heights at which one value is no height of them; 0.5 for those numbers

ARRAY = "first index along x, second along y (upwards)"
IMAGE = "lines along x, the first line at the top"
PLAIN = "as a plain table of text"  # source: a text that states nothing about itself
ALONG_Y = "lines along y, upwards, the first at the left"


@dataclass(frozen=True)
class RawHeights:
    """Heights of one file.

    heights      m, ``[i, j]`` along x, y, positive out of the material, missing points NaN
    pixel        edges (m)
    name         the file's name
    source       what read it
    unit         of the file's heights
    orientation  how the file's order became x to the right, y up
    channel      the one that was read; ``channels``: all there are
    notes        what was changed, overridden or worked around
    """

    heights: Array
    pixel: tuple[float, float]
    name: str
    source: str
    unit: str = "m"
    orientation: str = ARRAY
    channel: str = ""
    channels: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()

    @property
    def area(self) -> tuple[float, float]:
        """Edges of the measured area (m): each point counts as one pixel."""
        return self.heights.shape[0] * self.pixel[0], self.heights.shape[1] * self.pixel[1]


@dataclass(frozen=True)
class Overrides:
    """Statements of a scene about a file: unit of heights (a key of UNITS), pixel's edges (m), channel."""

    unit: str | None = None
    pixel_size: tuple[float, float] | None = None
    channel: str | int | None = None

    def resolve(
        self,
        name: str,
        unit: str | None,
        pixel: tuple[float, float] | None,
        what: str = "does not state them",
    ) -> tuple[str, tuple[float, float], tuple[str, ...]]:
        """Return unit, pixel and notes, from what the file states (None: nothing). Raises `InputError`."""
        if (self.unit or unit) is None or (self.pixel_size or pixel) is None:
            example = "for example --unit um --pixel-size 1e-6; in a scene unit and pixel_size"
            raise InputError(
                "unit, pixel_size", (self.unit, self.pixel_size), f"both: {name} {what}; {example}"
            )
        notes = []
        if self.unit is not None and unit is not None and UNITS[self.unit] != UNITS[unit]:
            notes.append(f"unit {self.unit!r} is used; the file states {ASCII.get(unit, unit)!r}")
        if (
            self.pixel_size is not None
            and pixel is not None
            and not np.allclose(self.pixel_size, pixel, 1e-6, 0)
        ):
            sizes = (size_text(pair) for pair in (self.pixel_size, pixel))
            notes.append("a pixel of {} m is used; the file states {} m".format(*sizes))
        used = self.unit or unit or "m"
        edges = self.pixel_size or pixel or (1.0, 1.0)
        for edge in edges:
            require_size(f"pixel of {name}", edge, "a positive length in m")
        return ASCII.get(used, used), edges, tuple(notes)


def unreadable(path: Path, allowed: str) -> InputError:
    """Return the refusal of a file of heights."""
    return InputError("path", str(path), allowed)


def read_or_refuse(path: Path, load: Callable[[], T]) -> T:
    """Return ``load()``, whose failures of any kind become one line of `InputError`."""
    try:
        return load()
    except InputError:
        raise
    except Exception as error:  # other people's parsers raise anything
        raise unreadable(path, f"a file that can be read ({first_line(error)})") from error


def first_line(error: object) -> str:
    """Return one line of an error or a warning: its kind and its own words."""
    lines = [line.strip() for line in str(error).splitlines() if line.strip()] or [""]
    return f"{type(error).__name__}: {printable(lines[0])[:160]}"


def checked(path: Path, raw: Array) -> Array:
    """Return the heights as doubles, missing ones NaN; `InputError` for no map of real numbers."""
    if raw.ndim != 2 or min(raw.shape) < 4 or raw.size > MAX_POINTS or raw.dtype.kind not in "fiu":
        what = f"{raw.dtype} of shape {raw.shape} in {path.name}"
        allowed = f"a 2-D table of real numbers, at least 4 an axis, at most {MAX_POINTS}"
        if raw.ndim == 1 or (raw.ndim == 2 and min(raw.shape) <= 2):
            allowed = f"a map: {allowed} (this looks like a line scan)"
        raise InputError("path", what, allowed)
    heights = np.array(raw, dtype=np.float64)
    heights[~np.isfinite(heights)] = np.nan
    return heights


def far_points(found: RawHeights) -> tuple[str, ...]:
    """Return a note on points of one value far outside all others, which may stand for missing points."""
    z, notes = found.heights[np.isfinite(found.heights)], []
    for value in {float(z.min()), float(z.max())} if z.size else ():
        others = z[z != value]
        if not others.size:
            continue
        low, high, size = float(others.min()), float(others.max()), UNITS[found.unit]
        usual = any(np.isclose(value, mark * size, 1e-6, 0) for mark in _NO_DATA)
        if (usual or high > low) and max(value - high, low - value) > (0.5 if usual else _FAR) * (high - low):
            span = f"far outside all others, {low / size:.4g} to {high / size:.4g}"
            shown = f"{z.size - others.size} points are at {value / size:.6g} {found.unit}, {span}"
            notes.append(f"{shown}: if they are missing points, write nan there")
    return tuple(notes)
