"""Heights from files: plain tables of numbers, and instrument files through SurfaceTopography.

Files come from anywhere. Before a byte is interpreted, the file's size, and what a zip archive says it
unpacks to (Python's zipfile never unpacks more than that), are held against MAX_BYTES. Nothing is unpickled.
"""

from __future__ import annotations

import math
import os
import struct
import tokenize
import warnings
import zipfile
import zlib
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import Any, TypeVar

import numpy as np

from refimpl.errors import InputError
from refimpl.grid import Array

T = TypeVar("T")

MAX_BYTES = 256 * 2**20
MAX_POINTS = 2**24
UNITS = {"m": 1.0, "mm": 1e-3, "um": 1e-6, "µm": 1e-6, "nm": 1e-9, "pm": 1e-12}
PLAIN = (".npy", ".csv")  # by nature; text (.asc, .txt) is a plain table if its unit and pixel size are given
TEXT = (".asc", ".txt")
TEXT_FORMATS = ("asc", "xyz")

# Errors that a reader may raise on bytes of another format than claimed. SurfaceTopography's own errors are
# plain Exceptions and join these where it is imported.
_BROKEN: tuple[type[Exception], ...] = (
    ArithmeticError, AssertionError, AttributeError, EOFError, LookupError, MemoryError, OSError,
    RuntimeError, SyntaxError, TypeError, ValueError, struct.error, tokenize.TokenError, zipfile.BadZipFile,
    zlib.error,
)  # fmt: skip


@dataclass(frozen=True)
class Reading:
    """Heights (m), ``[i, j]`` along x, y, missing points NaN; the pixel's edges (m);
    the file's name; what read it."""

    heights: Array
    pixel: tuple[float, float]
    name: str
    source: str

    @property
    def area(self) -> tuple[float, float]:
        """Edges of the measured area (m): each point counts as one pixel."""
        return self.heights.shape[0] * self.pixel[0], self.heights.shape[1] * self.pixel[1]


def read(path: Path, unit: str | None, pixel_size: tuple[float, float] | None) -> Reading:
    """Heights of one file.

    ``unit`` of the heights (a key of UNITS) and ``pixel_size`` (m) belong to plain tables: ``.npy``, ``.csv``
    (commas), ``.asc`` and ``.txt`` (blanks), row i at x_i, column j at y_j, nan where nothing was measured.
    Other files, and text without both of these, are an instrument's, indexed as SurfaceTopography does; unit
    and pixel size then serve only files that state none. Raises InputError.
    """
    _inspect(path)
    suffix = path.suffix.lower()
    if suffix in PLAIN or (suffix in TEXT and unit is not None and pixel_size is not None):
        if unit is None or pixel_size is None:
            allowed = f"both, for {path.name}: a table of numbers states neither"
            raise InputError("unit, pixel_size", (unit, pixel_size), allowed)
        load = _npy if suffix == ".npy" else _text
        heights = _heights(path, _guarded(path, load, _BROKEN)) * UNITS[unit]
        return Reading(heights, pixel_size, path.name, "as a plain table")
    return _instrument(path, unit, pixel_size)


def _inspect(path: Path) -> None:
    if not os.path.isfile(path):  # a name may have any length
        raise InputError("path", str(path), "an existing file")
    try:
        size = path.stat().st_size
        if zipfile.is_zipfile(path):
            with zipfile.ZipFile(path) as archive:
                size = max(size, sum(member.file_size for member in archive.infolist()))
    except _BROKEN as error:
        raise InputError("path", str(path), f"a readable file ({_brief(error)})") from error
    if not 0 < size <= MAX_BYTES:
        raise InputError(
            "path", str(path), f"at least 1 and at most {MAX_BYTES} bytes, unpacked as well (this: {size})"
        )


def _npy(path: Path) -> Array:
    # mapped, so that a header that promises more than the file holds is refused before any memory is taken
    return np.lib.format.open_memmap(path, mode="r")


def _text(path: Path) -> Array:
    # with or without a byte order mark; of no rows NumPy warns, `_heights` refuses them
    with path.open(encoding="utf-8-sig") as lines, warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        return np.loadtxt(lines, delimiter="," if path.suffix.lower() == ".csv" else None, ndmin=2)


def _instrument(path: Path, unit: str | None, pixel_size: tuple[float, float] | None) -> Reading:
    library = _library(path)
    own = library.Exceptions  # with no base in common
    broken = (*_BROKEN, own.ReadFileError, own.UnknownFileFormat, own.CannotPerformAnalysisError)

    def load(name: str | None) -> Reading:
        with np.errstate(all="ignore"), library.open_topography(str(path), format=name) as reader:
            return _from_reader(path, reader, unit, pixel_size)

    *others, last = _formats(library, path)
    for name in others:
        try:
            return load(name)
        except broken as error:
            if isinstance(error, InputError):
                raise
    return _guarded(path, lambda _: load(last), broken)


def _formats(library: ModuleType, path: Path) -> list[str | None]:
    """The formats that the suffix may mean, or [None], all that the library knows, for an unknown suffix.

    Text readers take a minute to find out that 50 MB hold no numbers; the first MiB tells as much.
    """
    head = _guarded(path, _head, _BROKEN)
    binary = b"\0" in head
    if not binary and not any(_begins_with_numbers(line) for line in head.splitlines()):
        raise InputError("path", str(path), "rows of numbers, or the binary file of an instrument")
    known = [r.format() for r in library.IO.readers if path.suffix.lower()[1:] in r.file_extensions()]
    possible = [name for name in known if not (binary and name in TEXT_FORMATS)]
    return sorted(possible, key=lambda name: name in TEXT_FORMATS) or [None]  # the last one's error is shown


def _head(path: Path) -> bytes:
    with path.open("rb") as file:
        return file.read(2**20)


def _begins_with_numbers(line: bytes) -> bool:
    words = line.replace(b",", b" ").replace(b";", b" ").split(maxsplit=3)[:3]
    try:
        return len([float(word) for word in words]) == 3
    except ValueError:
        return False


def _library(path: Path) -> ModuleType:
    try:
        import SurfaceTopography
        import SurfaceTopography.Exceptions
    except ImportError as error:
        allowed = (
            'a plain .npy or .csv, or the package that reads it (pip install "rough-friction[instrument]")'
        )
        raise InputError("path", str(path), allowed) from error
    module: ModuleType = SurfaceTopography
    return module


def _from_reader(
    path: Path, reader: Any, unit: str | None, pixel_size: tuple[float, float] | None
) -> Reading:
    channel, given = reader.default_channel, (unit, pixel_size)
    if channel.dim != 2 or not channel.is_uniform or math.prod(channel.nb_grid_pts) > MAX_POINTS:
        raise InputError("path", str(path), f"heights on a regular 2-D grid of at most {MAX_POINTS} points")
    if channel.unit is not None and channel.physical_sizes is not None:
        if given != (None, None):
            raise InputError("unit, pixel_size", given, f"neither: {path.name} states its own")
        topography = reader.topography().to_unit("m")
        (lx, ly), (nx, ny) = topography.physical_sizes, topography.nb_grid_pts
        unit, pixel_size = "m", (float(lx / nx), float(ly / ny))
    else:
        if unit is None or pixel_size is None:
            raise InputError("unit, pixel_size", given, f"both: {path.name} does not state them")
        sizes = tuple(n * edge for n, edge in zip(channel.nb_grid_pts, pixel_size, strict=True))
        topography = reader.topography(
            **({"physical_sizes": sizes} if channel.physical_sizes is None else {})
        )
    if not all(0 < edge < np.inf for edge in pixel_size):
        raise InputError("path", f"pixels of {pixel_size} m in {path.name}", "pixels of positive size")
    heights = np.ma.filled(np.ma.asarray(topography.heights(), dtype=np.float64), np.nan)
    source = f"by SurfaceTopography's {reader.format()} reader"
    return Reading(_heights(path, heights) * UNITS[unit], pixel_size, path.name, source)


def _guarded(path: Path, load: Callable[[Path], T], broken: tuple[type[Exception], ...]) -> T:
    try:
        return load(path)
    except InputError:
        raise
    except broken as error:
        raise InputError("path", str(path), f"a file that can be read ({_brief(error)})") from error


def _heights(path: Path, raw: Array) -> Array:
    if raw.ndim != 2 or min(raw.shape) < 4 or raw.size > MAX_POINTS or raw.dtype.kind not in "fiu":
        what = f"{raw.dtype} of shape {raw.shape} in {path.name}"
        raise InputError(
            "path", what, f"a 2-D table of real numbers, at least 4 an axis, at most {MAX_POINTS}"
        )
    heights = np.array(raw, dtype=np.float64)
    heights[~np.isfinite(heights)] = np.nan
    return heights


def _brief(error: Exception) -> str:
    lines = str(error).strip().splitlines() or [""]
    return f"{type(error).__name__}: {lines[0][:160]}"
