"""Text files of heights: separators, decimal commas, headers, index columns, maps and x-y-z triples."""

from __future__ import annotations

import io
import re
from array import array
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import islice
from pathlib import Path

import numpy as np

from refimpl.errors import InputError
from refimpl.grid import Array

MAX_HEADER = 400  # lines before the numbers
_INDEXED = 50  # lines by whose first entries an index column is known
_PIECE = 2**20  # characters read at a time
NOT_MEASURED = ("nan", "bad", "na", "n/a", "inf", "-inf", "null", "none", "---", "***", "*", "-")
_NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eEdD][-+]?\d+)?")
_COMMA_NUMBER = re.compile(r"[-+]?\d+,\d+([eE][-+]?\d+)?")
_WHOLE = re.compile(r"\d+")


@dataclass(frozen=True)
class TextTable:
    """Numbers of a text file as they stand, missing entries NaN; the lines before them; what was changed.

    ``interrupted``: a line of text that is followed by more numbers; empty where there is none.
    """

    rows: Array
    header: tuple[str, ...]
    notes: tuple[str, ...]
    interrupted: str = ""

    def normalised(self) -> bytes:
        """Header and numbers in UTF-8, with blanks between and decimal points."""
        text = io.BytesIO("".join(f"{line}\n" for line in self.header).encode())
        text.seek(0, io.SEEK_END)
        np.savetxt(text, self.rows, fmt="%.17g")
        return text.getvalue()


def encoding_of(path: Path) -> str:
    """UTF-8 or UTF-16 by the file's mark, UTF-8 if it is valid, else Latin-1."""
    with path.open("rb") as file:
        if file.read(2) in (b"\xff\xfe", b"\xfe\xff"):
            return "utf-16"
    try:
        with path.open(encoding="utf-8-sig") as text:
            while text.read(_PIECE):
                pass
    except UnicodeDecodeError:
        return "latin-1"
    return "utf-8-sig"


def _lines(path: Path, encoding: str) -> Iterator[str]:
    """The lines of a text file, one at a time: a list of them takes several times what their numbers do."""
    with path.open(encoding=encoding) as file:
        for line in file:
            yield from (part.strip() for part in line.splitlines())


def read_table(path: Path) -> TextTable:
    """Read the table of numbers in a text file. Raises InputError that says what was found."""
    encoding = encoding_of(path)
    lines = list(islice(_lines(path, encoding), MAX_HEADER + _INDEXED))
    start, layout = _layout(path, lines)
    header = tuple(line for line in lines[:start] if line.strip(",; \t"))
    width = len(layout.cells(lines[start]))

    def data() -> Iterator[str]:
        return filter(None, islice(_lines(path, encoding), start, None))

    rows, interrupted = _plain_numbers(layout, data()), ""
    if rows is None:
        rows, interrupted = _numbers(path, layout, data(), width)
    notes = [f"separator {layout.name}, decimal comma"] if layout.comma else []
    if rows.shape[1] > 1 and _is_index(rows[:, 0], layout, lines[start : start + _INDEXED]):
        rows, notes = rows[:, 1:], [*notes, "a leading index column was dropped"]
    return TextTable(rows, header, tuple(notes), interrupted)


@dataclass(frozen=True)
class _Layout:
    separator: str | None  # None: blanks
    comma: bool  # decimal

    @property
    def name(self) -> str:
        return {None: "blank", "\t": "tab"}.get(self.separator, f"'{self.separator}'")

    def cells(self, line: str) -> list[str]:
        """The entries of a line; a separator at the end of the line separates nothing."""
        line = line.split("#")[0].rstrip() if not line.startswith("#") else line
        if self.separator is None:
            return line.split()
        return [cell.strip() for cell in line.rstrip(self.separator).split(self.separator)]

    def is_data(self, line: str) -> bool:
        cells = self.cells(line)
        known = [cell for cell in cells if cell and cell.lower() not in NOT_MEASURED]
        return bool(known) and bool(cells[0]) and all(self.is_number(cell) for cell in known)

    def is_number(self, cell: str) -> bool:
        return bool(_NUMBER.fullmatch(cell) or (self.comma and _COMMA_NUMBER.fullmatch(cell)))

    def value(self, cell: str) -> float:
        if not cell or cell.lower() in NOT_MEASURED:
            return np.nan
        return float((cell.replace(",", ".") if self.comma else cell).replace("d", "e").replace("D", "E"))


_LAYOUTS = (
    _Layout(";", False), _Layout(";", True), _Layout("\t", False), _Layout("\t", True),
    _Layout(",", False), _Layout(None, False), _Layout(None, True),
)  # fmt: skip


def _layout(path: Path, lines: list[str]) -> tuple[int, _Layout]:
    """Line on which the numbers begin, and how they are separated: the first two lines alike that are."""
    for k, line in enumerate(islice(lines, MAX_HEADER)):
        following = next(filter(None, lines[k + 1 : k + 4]), "")
        for layout in _LAYOUTS:
            if layout.separator is not None and layout.separator not in line:
                continue
            if layout.is_data(line) and (not following or layout.is_data(following)):
                return k, layout
    found = next(filter(None, lines), "")[:60]
    raise InputError(
        "path", str(path), f"rows of numbers (no two lines of numbers; it begins with {found!r})"
    )


def _plain_numbers(layout: _Layout, lines: Iterable[str]) -> Array | None:
    """The numbers by NumPy's reader, 20 times faster; None for what it cannot read."""
    if layout.comma:
        return None
    try:
        ended = lines if layout.separator is None else (line.rstrip(layout.separator) for line in lines)
        return np.loadtxt(ended, delimiter=layout.separator, ndmin=2)
    except ValueError:
        return None


def _numbers(path: Path, layout: _Layout, lines: Iterator[str], width: int) -> tuple[Array, str]:
    """The numbers of lines up to a line of text, and that line where numbers follow it."""
    values, interrupted = array("d"), ""
    for line in lines:
        cells = layout.cells(line)
        try:
            row = [layout.value(cell) for cell in cells]
        except ValueError:
            if line.startswith("#"):
                continue
            interrupted = line if any(map(layout.is_data, lines)) else ""
            break
        if len(row) < width and layout.separator not in (None, ","):
            row += [np.nan] * (width - len(row))  # empty entries at the end of the line
        if len(row) != width:
            number = len(values) // width + 1
            allowed = f"rows of one length (row {number} of numbers has {len(row)}, the first {width})"
            raise InputError("path", str(path), allowed)
        values.extend(row)
    return np.array(values).reshape(-1, width), interrupted


def _is_index(column: Array, layout: _Layout, lines: list[str]) -> bool:
    """Whether the first column counts rows in whole numbers, beside columns that are not all whole."""
    counts = len(column) > 1 and column[0] in (0, 1) and bool(np.all(np.diff(column) == 1))
    cells = [layout.cells(line) for line in lines if line]
    whole = all(_WHOLE.fullmatch(row[0]) for row in cells if row)
    decimals = not all(_WHOLE.fullmatch(cell) for row in cells for cell in row[1:] if cell)
    return bool(counts and whole and decimals)


def is_triples(table: TextTable) -> bool:
    """True if the rows are points x, y, z: a map has four columns at least."""
    return bool(table.rows.shape[1] == 3)


def on_grid(path: Path, points: Array) -> tuple[Array, tuple[float, float]]:
    """Heights ``[i, j]`` of points ``(x, y, z)`` and the pitch of their grid; absent points are NaN.

    The pitch is the median distance between neighbouring distinct coordinates. Raises InputError for a line
    scan, for points more than a tenth of the pitch off the grid and for two points in one place.
    """
    x, y, z = points[np.isfinite(points[:, :2]).all(axis=1)].T
    indices, pitches = [], []
    for name, along in (("x", x), ("y", y)):
        index, pitch = _positions(path, name, along)
        indices.append(index)
        pitches.append(pitch)
    i, j = indices
    shape = int(i.max()) + 1, int(j.max()) + 1
    if shape[0] * shape[1] > 25 * len(z) + 1000:
        what = f"points on a regular grid ({len(z)} points would fill {shape[0]} x {shape[1]} places)"
        raise InputError("path", str(path), what)
    heights = np.full(shape, np.nan)
    heights[i, j] = z
    twice = len(z) - len(np.unique(i * shape[1] + j))
    if twice:
        raise InputError("path", str(path), f"one height a point ({twice} points are given twice)")
    return heights, (pitches[0], pitches[1])


def _positions(path: Path, name: str, along: Array) -> tuple[Array, float]:
    span = float(np.ptp(along)) if len(along) else 0.0
    distinct = np.unique(along)
    steps = np.diff(distinct)
    steps = steps[steps > 1e-6 * span]  # rounding of one coordinate is not a step
    if len(steps) == 0:
        raise InputError("path", str(path), f"a map (a line scan: all points have one {name})")
    pitch = float(np.median(steps))
    pitch = span / round(span / pitch)
    place = (along - along.min()) / pitch
    off = float(np.abs(place - np.rint(place)).max())
    if off > 0.1:
        raise InputError(
            "path", str(path), f"points on a regular grid ({off:.2g} of the pitch in {name} off it)"
        )
    return np.rint(place).astype(np.intp), pitch
