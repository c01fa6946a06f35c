"""Heights from files: plain arrays, text, and instrument files through SurfaceTopography.

Files come from anywhere. Before a byte is interpreted, the file's size, and what a zip archive says it
unpacks to (Python's zipfile never unpacks more than that), are held against MAX_BYTES. Nothing is unpickled.
"""

from __future__ import annotations

import io
import os
import zipfile
from dataclasses import replace
from pathlib import Path

import numpy as np

from refimpl.errors import InputError, size_text
from refimpl.grid import Array
from refimpl.measured.instrument_files import claimed_by_magic, library_for, read_as, read_instrument
from refimpl.measured.point_tables import POINT, points_map
from refimpl.measured.reading import (
    IMAGE,
    MAX_BYTES,
    MAX_POINTS,
    PLAIN,
    UNITS,
    Overrides,
    RawHeights,
    checked,
    far_points,
    kind_of,
    read_or_refuse,
    unreadable,
)
from refimpl.measured.text_lines import WYKO
from refimpl.measured.text_tables import TextTable, read_table
from refimpl.measured.workarounds import wyko_header

__all__ = ["MAX_BYTES", "MAX_POINTS", "UNITS", "Overrides", "RawHeights", "read"]

_HEAD = 2**16  # bytes that tell text from binary
_UTF16 = (b"\xff\xfe", b"\xfe\xff")


def read(
    path: Path,
    unit: str | None = None,
    pixel_size: tuple[float, float] | None = None,
    channel: str | int | None = None,
) -> RawHeights:
    """Return the heights of one file, x to the right and y up as seen from outside.

    ``unit`` of the heights (a key of UNITS) and ``pixel_size`` (m) serve files that state none and override
    those that do, with a note. ``.npy`` and text without a header have row i at x_i, column j at y_j; text
    with a header has an image's lines, from the top; three columns are points. All else is read by
    SurfaceTopography. Raises `InputError`.
    """
    given = Overrides(unit, pixel_size, channel)
    found = read_or_refuse(path, lambda: _read(path, given))
    return replace(found, notes=(*found.notes, *far_points(found)))


def _read(path: Path, given: Overrides) -> RawHeights:
    _check_size(path)
    if path.suffix.lower() == ".npy":
        # mapped, so that a header that promises more than the file holds is refused before memory is taken
        raw = np.lib.format.open_memmap(path, mode="r")
        return _plain(path, checked(path, raw), given, "as a plain array")
    with path.open("rb") as file:
        head = file.read(_HEAD)
    is_text = head.startswith(_UTF16) or b"\0" not in head
    if is_text and not claimed_by_magic(path, head):
        return _text(path, given, head)
    return read_instrument(path, given, head)


def _check_size(path: Path) -> None:
    if not os.path.isfile(path):  # a name may have any length
        raise unreadable(path, "an existing file")
    size = path.stat().st_size
    if zipfile.is_zipfile(path):
        with zipfile.ZipFile(path) as archive:
            size = max(size, sum(member.file_size for member in archive.infolist()))
    if not 0 < size <= MAX_BYTES:
        raise unreadable(path, f"at least 1 and at most {MAX_BYTES} bytes, unpacked as well (this: {size})")


def _plain(
    path: Path, raw: Array, given: Overrides, source: str, table: TextTable | None = None
) -> RawHeights:
    header, notes = (table.header, table.notes) if table else ((), ())
    seen = f" in words known here (header: {'; '.join(header)[:200]})" if header else ""
    unit, pixel, _ = given.resolve(path.name, None, None, f"does not state them{seen}")
    return RawHeights(raw * UNITS[unit], pixel, path.name, source, unit, notes=notes)


def _text(path: Path, given: Overrides, head: bytes) -> RawHeights:
    if kind := kind_of(path, head):
        raise unreadable(path, kind)
    try:
        table = read_table(path)
    except UnicodeError as error:
        allowed = f"text in UTF-8, UTF-16 or Latin-1: {path.name} begins as UTF-16, but its bytes are none"
        raise unreadable(path, allowed) from error
    rows, columns = table.rows.shape
    if path.suffix.lower() == ".xyz" and columns not in (2, 3):
        raise unreadable(path, f"points in two or three columns (found {columns})")
    if columns < 3:
        raise unreadable(path, f"a map (a line scan: {rows} rows of {columns} columns were found)")
    if columns == POINT and not table.is_sized:
        return points_map(path, table.rows, given, table.header, table.notes)
    if not table.header:
        return _plain(path, checked(path, table.rows), given, PLAIN, table)
    try:
        return _with_header(path, table, given)
    except InputError as refused:
        if refused.field == "channel" or table.header[0].startswith(WYKO):
            raise
    if len(table.blocks) > 1:
        raise unreadable(path, f"one image, or images with names (blocks of {table.blocks} lines)")
    image = checked(path, table.rows).T[:, ::-1]
    reading = _plain(path, np.ascontiguousarray(image), given, "as text with a header", table)
    return replace(reading, orientation=IMAGE)


def _with_header(path: Path, table: TextTable, given: Overrides) -> RawHeights:
    """Return the text whose header says what the library knows: Gwyddion's, SPIP's, Wyko's and others."""
    library = library_for(path)
    if table.header[0].startswith(WYKO):
        table = replace(table, header=wyko_header(path, table.header))
    text = io.BytesIO(table.normalised())
    found = read_or_refuse(path, lambda: read_as(library, path, "asc", given, text, table.notes))
    if not set(found.heights.shape) & set(table.blocks):
        allowed = (
            f"an image of {' or '.join(map(str, table.blocks))} lines, not {size_text(found.heights.shape)}"
        )
        raise unreadable(path, allowed)
    return found
