"""Instruments' own formats, through SurfaceTopography: format, channel, orientation, units."""

from __future__ import annotations

import contextlib
import io
import logging
import math
import struct
import tokenize
import warnings
import zipfile
import zlib
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any, TypeVar

import numpy as np
import scipy

from refimpl.errors import InputError
from refimpl.grid import Array
from refimpl.measured.reading import ARRAY, IMAGE, MAX_POINTS, UNITS, Overrides, RawHeights, checked
from refimpl.measured.workarounds import NMS_UNIT, Source, refuse_changed, rewritten

T = TypeVar("T")

TEXT_FORMATS = ("asc", "xyz")  # read by `text_tables`

# Formats of coordinates or of plain arrays: the second index runs up y. All others are images: the library
# returns their lines from the top, as Gwyddion shows them.
UPWARDS = ("x3p", "sdf", "nc", "npy", "npz", "mat", "h5")

MARKLESS = ("mat", "nms", "hgt")  # read for their suffix alone

# Errors that a reader may raise on bytes that do not have the format of their mark. SurfaceTopography's own
# errors are plain Exceptions and join these where it is imported.
CORRUPT: tuple[type[Exception], ...] = (
    ArithmeticError, AssertionError, AttributeError, EOFError, LookupError, MemoryError, OSError,
    RuntimeError, SyntaxError, TypeError, ValueError, struct.error, tokenize.TokenError, zipfile.BadZipFile,
    zlib.error,
)  # fmt: skip


def read_instrument(path: Path, given: Overrides, head: bytes) -> RawHeights:
    """Heights of a binary instrument file; ``head``: its first bytes. Raises InputError."""
    library = library_for(path)
    formats = _formats(library, path, head)
    failures = []
    for name in formats:
        try:
            refuse_changed(path, name)
            return read_as(library, path, name, given, *rewritten(path, name))
        except InputError:
            raise
        except corrupt(library) as error:
            failures.append(f"{name}: {first_line(error)}")
    likely = failures[0] if failures else f"none of SurfaceTopography {library.__version__}'s formats fits"
    raise InputError("path", str(path), f"a file that can be read ({likely})")


def claimed_by_magic(path: Path, head: bytes) -> bool:
    """True if the first bytes are the mark of an instrument's format; False without the library."""
    try:
        library = library_for(path)
    except InputError:
        return False
    yes = library.IO.MagicMatch.YES
    return any(r.can_read(head[:512]) == yes for r in library.IO.readers if r.format() not in TEXT_FORMATS)


def _formats(library: ModuleType, path: Path, head: bytes) -> list[str]:
    """Formats to try: those whose mark the first bytes are, then those of the suffix; if there is none, all
    that the bytes allow but those without a mark, which take any bytes."""
    match, suffix = library.IO.MagicMatch, path.suffix.lower()[1:]
    marked, own, others = [], [], []
    for reader in library.IO.readers:
        name, answer = reader.format(), reader.can_read(head[:512])
        if name in TEXT_FORMATS:
            continue
        if answer == match.YES:
            marked.append(name)
        elif suffix in reader.file_extensions():
            own.append(name)
        elif answer == match.MAYBE and name not in MARKLESS:
            others.append(name)
    return marked + own or others


def read_as(
    library: ModuleType, path: Path, name: str, given: Overrides, source: Source, notes: tuple[str, ...] = ()
) -> RawHeights:
    """Heights of one file, read as the format ``name`` from ``source``."""
    quiet = contextlib.redirect_stdout(io.StringIO())  # SciPy prints what it cannot reshape
    with quiet, warnings.catch_warnings(record=True) as said, np.errstate(all="ignore"):
        warnings.simplefilter("always")
        with library.open_topography(source, format=name) as reader:
            index, channel = _choose(path, reader, given)
            heights, unit, pixel = _loaded(path, reader, index, channel)
    if pixel and name == "nms":
        pixel = NMS_UNIT * pixel[0], NMS_UNIT * pixel[1]
    notes += ("NMS: its spacing is in nm",) if name == "nms" else ()
    stated = unit if unit is None else library.Support.UnitConversion.get_unit_conversion_factor(unit, "m")
    unit, pixel, overridden = given.resolve(path.name, unit, pixel)
    if given.unit is not None or stated is None:
        stated = UNITS[unit]
    remarks = [
        f"SurfaceTopography: {first_line(w.message)}" for w in said if issubclass(w.category, UserWarning)
    ]
    upwards = name in UPWARDS
    heights = heights * stated
    return RawHeights(
        np.ascontiguousarray(heights if upwards else heights[:, ::-1]),
        pixel, path.name, f"by SurfaceTopography's {name} reader", unit, ARRAY if upwards else IMAGE,
        str(channel.name), tuple(str(c.name) for c in reader.channels),
        (*notes, *overridden, *remarks),
    )  # fmt: skip


def _choose(path: Path, reader: Any, given: Overrides) -> tuple[int, Any]:
    """The channel of the given name or number, by default the first map of heights from the library's own."""
    channels = list(reader.channels)
    names = [str(c.name) for c in channels]
    listed = ", ".join(f"{k} {name!r}" for k, name in enumerate(names))
    if given.channel is None:
        default = reader._default_channel_index
        order = [default, *range(len(channels))] if default < len(channels) else range(len(channels))
        index = next((k for k in order if _is_height(channels[k])), None)
        if index is None:
            raise InputError("path", str(path), f"a map of heights (found: {listed or 'no channel'})")
    elif isinstance(given.channel, int):
        index = given.channel
    else:
        index = next((k for k, name in enumerate(names) if name.casefold() == given.channel.casefold()), -1)
    if not 0 <= index < len(channels):
        raise InputError("channel", given.channel, f"a channel of {path.name}: {listed}")
    channel = channels[index]
    if channel.dim != 2 or not channel.is_uniform:
        what = "a line scan" if channel.dim == 1 else "no regular map"
        raise InputError("path", str(path), f"a map of heights (channel {names[index]!r} is {what})")
    if not _is_height(channel):
        raise InputError("channel", given.channel, f"a channel of heights in {path.name}: {listed}")
    if math.prod(channel.nb_grid_pts) > MAX_POINTS:
        raise InputError("path", str(path), f"heights on a grid of at most {MAX_POINTS} points")
    return index, channel


def _is_height(channel: Any) -> bool:
    return channel.dim == 2 and str(getattr(channel.data_kind, "name", "HEIGHT")) == "HEIGHT"


def _loaded(
    path: Path, reader: Any, index: int, channel: Any
) -> tuple[Array, str | None, tuple[float, float] | None]:
    """Heights in the file's unit (missing: NaN), that unit, and the pixel's edges (m)."""
    sizes = channel.physical_sizes
    given = {} if sizes is not None else {"physical_sizes": tuple(map(float, channel.nb_grid_pts))}
    topography = reader.topography(channel_index=index, **given)
    heights = checked(path, np.ma.filled(np.ma.asarray(topography.heights(), dtype=np.float64), np.nan))
    unit, pixel = topography.unit, None
    if sizes is not None and unit is not None:
        edges = zip(topography.to_unit("m").physical_sizes, topography.nb_grid_pts, strict=True)
        dx, dy = (float(length / n) for length, n in edges)
        pixel = dx, dy
    return heights, unit, pixel


def read_or_refuse(path: Path, load: Callable[[Path], T], kinds: tuple[type[Exception], ...] = CORRUPT) -> T:
    """``load(path)``, whose failures become one line of InputError."""
    try:
        return load(path)
    except InputError:
        raise
    except kinds as error:
        raise InputError("path", str(path), f"a file that can be read ({first_line(error)})") from error


def library_for(path: Path) -> ModuleType:
    """SurfaceTopography. Raises InputError where it is not installed."""
    try:
        import SurfaceTopography
        import SurfaceTopography.Exceptions
    except ImportError as error:
        allowed = (
            'a plain .npy or .csv, or the package that reads it (pip install ".[instrument]" in a checkout)'
        )
        raise InputError("path", str(path), allowed) from error
    logging.getLogger("SurfaceTopography").addHandler(logging.NullHandler())  # nothing on stderr
    module: ModuleType = SurfaceTopography
    return module


def corrupt(library: ModuleType) -> tuple[type[Exception], ...]:
    """All that the library raises on files that are not what they claim to be."""
    own = library.Exceptions  # with no base in common
    return (
        *CORRUPT,
        scipy.io.matlab.MatReadError,
        own.ReadFileError,
        own.UnknownFileFormat,
        own.CannotPerformAnalysisError,
    )


def first_line(error: object) -> str:
    """One line of an error or a warning: its kind and its own words."""
    lines = [line.strip() for line in str(error).splitlines() if line.strip()] or [""]
    return f"{type(error).__name__}: {lines[0][:160]}"
