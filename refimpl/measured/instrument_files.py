"""Instruments' own formats, through SurfaceTopography: format, channel, orientation, units."""

from __future__ import annotations

import contextlib
import io
import logging
import warnings
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from refimpl.errors import InputError
from refimpl.measured.channels import (
    ARRAYS,
    choose,
    chosen,
    is_container,
    taken,
    topography,
    with_coordinates,
)
from refimpl.measured.point_tables import points_map
from refimpl.measured.reading import (
    ALONG_Y,
    ARRAY,
    IMAGE,
    UNITS,
    Overrides,
    RawHeights,
    checked,
    first_line,
    kind_of,
    unreadable,
)
from refimpl.measured.text_lines import WYKO
from refimpl.measured.workarounds import NMS_UNIT, Source, rewritten

TEXT_FORMATS = ("asc", "xyz")  # read by `text_tables`

# Formats of coordinates or of plain arrays: the second index runs up y. All others are images: the library
# returns their lines from the top, as Gwyddion shows them.
UPWARDS = ("x3p", "sdf", "nc", "npy", "npz", "mat", "h5")

MARKLESS = ("mat", "nms", "hgt")  # read for their suffix alone


def read_instrument(path: Path, given: Overrides, head: bytes) -> RawHeights:
    """Return the heights of a binary instrument file; ``head``: its first bytes. Raises InputError."""
    library = library_for(path)
    if is_container(path):
        return _of_container(library, path, given)
    claiming, others = _formats(library, path, head)
    failures = []
    for name in claiming or others:
        try:
            return read_as(library, path, name, given, *rewritten(path, name, given))
        except InputError:
            raise
        except Exception as error:  # other people's parsers raise anything; the next format may fit
            failures.append(f"{name}: {first_line(error)}")
    if kind := kind_of(path, head):
        raise unreadable(path, kind)
    if claiming:
        raise unreadable(path, f"a file that can be read ({failures[0]})")
    formats = f"a format of SurfaceTopography {library.__version__}"
    raise unreadable(
        path, f"a map of heights: {path.name} is neither text (UTF-8, UTF-16, Latin-1) nor {formats}"
    )


def claimed_by_magic(path: Path, head: bytes) -> bool:
    """Return True if the first bytes are the mark of an instrument's format; False without the library."""
    try:
        library = library_for(path)
    except InputError:
        return False
    yes = library.IO.MagicMatch.YES
    return any(r.can_read(head[:512]) == yes for r in library.IO.readers if r.format() not in TEXT_FORMATS)


def _formats(library: ModuleType, path: Path, head: bytes) -> tuple[list[str], list[str]]:
    """Return the formats of the mark, then of the suffix; and all others that do not take any bytes."""
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
    return marked + own, others


def read_as(
    library: ModuleType, path: Path, name: str, given: Overrides, source: Source, notes: tuple[str, ...] = ()
) -> RawHeights:
    """Return the heights of one file, read as the format ``name`` from ``source``."""
    with _quietly() as said, library.open_topography(source, format=name) as reader:
        index, channel = choose(path, name, reader, given)
        notes += taken(reader, channel)
        if name in ARRAYS and (points := with_coordinates(reader, channel)) is not None:
            return points_map(path, points, given, notes=notes)
        found = topography(reader, index)
        wyko = name == "asc" and channel.info["raw_metadata"].get("format_flavor") == "wyko"
        form = WYKO if wyko else name
        reading = _record(path, form, found, channel.physical_sizes is not None, given, said)
    names = tuple(str(c.name) for c in reader.channels)
    return replace(reading, channel=str(channel.name), channels=names, notes=(*notes, *reading.notes))


@contextlib.contextmanager
def _quietly() -> Iterator[list[warnings.WarningMessage]]:
    """Collect the library's warnings; SciPy prints what it cannot reshape."""
    quiet = contextlib.redirect_stdout(io.StringIO())
    with quiet, warnings.catch_warnings(record=True) as said, np.errstate(all="ignore"):
        warnings.simplefilter("always")
        yield said


def _record(
    path: Path, form: str, found: Any, sized: bool, given: Overrides, said: list[warnings.WarningMessage]
) -> RawHeights:
    """Return the library's map: heights (m), pixel, unit, words; ``sized``: the file states its size."""
    heights = checked(path, np.ma.filled(np.ma.asarray(found.heights(), dtype=np.float64), np.nan))
    metre, pixel = None, None
    if found.unit is not None:
        metre = found.to_unit("m").physical_sizes[0] / found.physical_sizes[0]
        if sized:
            dx, dy = (
                length * metre / n for length, n in zip(found.physical_sizes, heights.shape, strict=True)
            )
            pixel = (NMS_UNIT * dx, NMS_UNIT * dy) if form == "nms" else (dx, dy)
    if form == WYKO:  # one x per line, from the bottom: the library takes lines for rows from the top
        heights, pixel = heights.T, None if pixel is None else pixel[::-1]
    unit, pixel, overridden = given.resolve(path.name, found.unit, pixel)
    heights = heights * (UNITS[unit] if given.unit is not None or metre is None else metre)
    upwards = form == WYKO or form in UPWARDS
    remarks = [
        f"SurfaceTopography: {first_line(w.message)}" for w in said if issubclass(w.category, UserWarning)
    ]
    return RawHeights(
        np.ascontiguousarray(heights if upwards else heights[:, ::-1]),
        pixel, path.name, f"by SurfaceTopography's {form} reader", unit,
        ALONG_Y if form == WYKO else ARRAY if upwards else IMAGE,
        notes=(*(("NMS: its spacing is in nm",) if form == "nms" else ()), *overridden, *remarks),
    )  # fmt: skip


def _of_container(library: ModuleType, path: Path, given: Overrides) -> RawHeights:
    """Return a measurement of a contact.engineering container, scaled and detrended as it says."""
    from SurfaceTopography.Container.IO import CEReader

    with _quietly() as said:
        reader = CEReader(str(path))
        containers = range(reader.nb_containers)
        members = [(k, j, m) for k in containers for j, m in enumerate(reader.members(k))]
        k, j, member = members[chosen(path, [m.name for *_, m in members], given.channel)]
        found = reader.container(k)[j]
        if found.dim != 2 or not found.is_uniform:
            raise unreadable(path, f"a map of heights ({member.name!r} is a line scan)")
        stream = member.open
        form = library.IO.detect_format(stream)
        if form == "asc" and stream().read(len(WYKO)) in (WYKO, WYKO.encode()):
            raise unreadable(path, f"{member.name!r} unpacked: Wyko's text is read on its own")
        reading = _record(path, form, found, True, given, said)
    names = tuple(m.name for *_, m in members)
    prepared = found.info.get("detrend_mode") or "none"
    note = f"{form} file {member.name!r} of a container of contact.engineering, its detrending {prepared!r}"
    source = "by SurfaceTopography from a container"
    return replace(reading, channel=member.name, channels=names, source=source, notes=(note, *reading.notes))


def library_for(path: Path) -> ModuleType:
    """Import SurfaceTopography. Raises InputError where it is not installed."""
    try:
        import SurfaceTopography
        import SurfaceTopography.Exceptions
    except ImportError as error:
        allowed = (
            'a plain .npy or .csv, or the package that reads it (pip install ".[instrument]" in a checkout)'
        )
        raise unreadable(path, allowed) from error
    logging.getLogger("SurfaceTopography").addHandler(logging.NullHandler())  # nothing on stderr
    module: ModuleType = SurfaceTopography
    return module
