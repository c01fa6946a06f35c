"""Text files of heights: separators, decimal commas, headers, missing points.

One rule for a table: once it has begun, every line that is neither blank nor a comment (``#``) is one of its
rows, of as many entries as the first. An entry is a number, a mark of NOT_MEASURED or, between separators
other than blanks and at the end of such a line, nothing; all else is refused with its line.
"""

from __future__ import annotations

import io
import re
from array import array
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import islice, pairwise
from pathlib import Path

import numpy as np

from refimpl.grid import Array
from refimpl.measured.point_tables import POINT
from refimpl.measured.reading import unreadable
from refimpl.measured.table_labels import is_title, refuse_ambiguous, without_labels, word_in_corner
from refimpl.measured.text_lines import NOT_MEASURED, encoding_of, in_english, lines_of

MAX_HEADER = 400  # lines before the numbers
_SAMPLE = 50  # lines by whose entries labels of rows and columns are known
_NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eEdD][-+]?\d+)?", re.ASCII)
_NO_DATA = re.compile(rf"(nodata_value)\s+({_NUMBER.pattern})", re.IGNORECASE)
_COMMA_NUMBER = re.compile(r"[-+]?(\d+,\d*|,\d+)([eEdD][-+]?\d+)?")


@dataclass(frozen=True)
class TextTable:
    """Numbers of a text file as they stand, missing entries NaN; the lines before them; what was changed.

    ``comments``: lines that begin with ``#`` after the first row, each with the number of rows before it.
    """

    rows: Array
    header: tuple[str, ...]
    notes: tuple[str, ...]
    comments: tuple[tuple[int, str], ...] = ()

    @property
    def is_sized(self) -> bool:
        """True if the header states the edges of an image, as Gwyddion does."""
        return {"# Width", "# Height"} <= {line.partition(":")[0] for line in self.header}

    def normalised(self) -> bytes:
        """Return the header, numbers and comments in UTF-8, with blanks between and decimal points."""
        text, begun = io.BytesIO(), 0
        text.write("".join(f"{line}\n" for line in self.header).encode())
        for row, comment in (*self.comments, (len(self.rows), "")):
            np.savetxt(text, self.rows[begun:row], fmt="%s")
            text.write(f"{comment}\n".encode())
            begun = row
        return text.getvalue()

    @property
    def blocks(self) -> tuple[int, ...]:
        """Numbers of rows between comments that repeat a line of the header: images of one file."""
        again = {row for row, comment in self.comments if comment in self.header}
        return tuple(b - a for a, b in pairwise(sorted({0, *again, len(self.rows)})))


def read_table(path: Path) -> TextTable:
    """Read the table of numbers in a text file. Raises InputError that says what was found."""
    encoding = encoding_of(path)
    head = list(islice(lines_of(path, encoding), MAX_HEADER + _SAMPLE))
    lines = [line for _, line in head]
    layout, start, width = _layout(path, lines)
    shown = [line for line in lines[start : start + _SAMPLE] if line and line[0] != "#"]
    sample = [layout.cells(line) for line in shown]
    titled, corner = is_title(sample), word_in_corner(sample, layout.unknown(sample[0]))
    comments: list[tuple[int, str]] = []
    blanks = set[int]()

    def data() -> Iterator[tuple[int, str]]:
        comments.clear()
        blanks.clear()
        count = 0
        for number, line in islice(lines_of(path, encoding), start + titled, None):
            if line.startswith("#") and not layout.is_row(line, width):
                comments.append((count, in_english(line)))
            elif line.strip() or len(layout.cells(line)) == width:  # tabs alone: missing points
                if layout.splits_row(line):
                    allowed = f"comments that begin a line or follow a row (line {number}: {line[:40]!r})"
                    raise unreadable(path, allowed)
                count += 1
                yield number, line.replace(corner, "nan", 1) if corner and count == 1 else line
            else:
                blanks.add(count)

    refuse_ambiguous(path, lambda: (line for _, line in data()), layout.separator, shown)
    notes: list[str] = []
    rows = _plain_numbers(layout, (line for _, line in data()))
    if rows is None:
        rows, notes = _numbers(path, layout, data(), width)
    elif layout.ends(lines[start]):
        notes = [_EMPTY.format("last")]
    rows[np.isinf(rows)] = np.nan
    _refuse_blocks(path, rows, blanks)
    header = tuple(in_english(line) for line in lines[:start] if line.strip(",; \t"))
    if stated := _NO_DATA.search("\n".join(header)):
        absent = rows == float(stated[2])
        rows[absent] = np.nan
        notes.append(f"{np.count_nonzero(absent)} points of {stated[0]}, as the header states, are missing")
    rows, labels = without_labels(path, rows, sample, corner)
    return TextTable(rows, header, (*notes, *labels), tuple(comments))


_SHORT = "lines with fewer entries than the first row: {}, from line {} on; is the file cut off?"
_EMPTY = "the {} column, empty in all lines, was dropped"


@dataclass(frozen=True)
class _Layout:
    separator: str | None  # None: blanks

    @property
    def name(self) -> str:
        return {None: "blank", "\t": "tab"}.get(self.separator, f"'{self.separator}'")

    def cells(self, line: str) -> list[str]:
        """Return the entries of a line, without a comment at its end."""
        line = line.split("#")[0] if not line.startswith("#") else line
        return [cell.strip() for cell in line.split(self.separator)]

    def splits_row(self, line: str) -> bool:
        """Return whether a comment's mark stands before another entry: an unknown spelling, not a comment."""
        before, mark, after = line.partition("#")
        if not mark or line.startswith("#"):
            return False
        if self.separator is not None:
            return before.rstrip(" ").endswith(self.separator)
        return all(map(self.is_number, after.split()[1:])) and len(after.split()) > 1

    def ends(self, line: str) -> bool:
        return self.separator is not None and line.endswith(self.separator)

    def is_number(self, cell: str) -> bool:
        return bool(_NUMBER.fullmatch(cell) or (self.separator != "," and _COMMA_NUMBER.fullmatch(cell)))

    def unknown(self, cells: Iterable[str]) -> list[str]:
        return [c for c in cells if c and c.lower() not in NOT_MEASURED and not self.is_number(c)]

    def is_data(self, line: str) -> bool:
        cells = self.cells(line)
        return any(map(self.is_number, cells)) and not self.unknown(cells)

    def is_row(self, line: str, width: int) -> bool:
        """Return whether a line is a row of that width, alien marks or not: texts of a header differ."""
        cells = self.cells(line)
        unknown = self.unknown(cells)
        known = len(unknown) + sum(map(self.is_number, cells))
        return len(cells) == width and (not unknown or 2 * len(set(unknown)) < known)

    def value(self, cell: str) -> float:
        """Return NaN for what is missing. Raises ValueError."""
        if not cell.isascii():
            raise ValueError(cell)
        try:
            return float(cell)
        except ValueError:
            if not cell or cell.lower() in NOT_MEASURED:
                return np.nan
            return float(cell.lower().replace("d", "e", 1))


_LAYOUTS = tuple(map(_Layout, (";", "\t", ",", None)))


def _layout(path: Path, lines: list[str]) -> tuple[_Layout, int, int]:
    """Find separator, first line and width by the first two lines of numbers; rows above belong."""
    for k, line in enumerate(islice(lines, MAX_HEADER)):
        following = next(filter(None, lines[k + 1 : k + 4]), "")
        for layout in _LAYOUTS:
            if layout.separator is not None and layout.separator not in line:
                continue
            if layout.is_data(line) and (not following or layout.is_data(following)):
                width, start = len(layout.cells(line)), k
                for above in range(k - 1, -1, -1):
                    if layout.is_row(lines[above], width):
                        start = above
                    elif lines[above]:
                        break
                _refuse_blank(path, [layout.cells(line) for line in lines[:k]], start, width)
                return layout, start, width
    found = next(filter(str.strip, lines), "").strip()[:60]
    raise unreadable(path, f"rows of numbers (no two lines of numbers; it begins with {found!r})")


def _refuse_blank(path: Path, above: list[list[str]], start: int, width: int) -> None:
    """Refuse a line of separators alone below a header that is padded by them, as spreadsheets do."""
    padded = any(len(cells) == width and not cells[-1] for cells in above[:start])
    if padded and any(not any(cells) for cells in above[start:]):
        found = f"line {start + 1} has none: write nan in a row of missing points, delete a blank line"
        raise unreadable(path, f"entries between separators ({found})")


def _refuse_blocks(path: Path, rows: Array, blanks: set[int]) -> None:
    """Raise InputError for tables with a blank line between, and for two separators between entries."""
    inner = [row for row in blanks if 0 < row < len(rows)]
    if rows.shape[1] <= POINT:
        return
    if 0 < len(inner) < len(rows) - 1:
        raise unreadable(path, f"one table (a blank line stands below its row {min(inner)})")
    if np.isnan(rows[:, 1::2]).all() and not np.isnan(rows[:, ::2]).all(axis=0).any():
        raise unreadable(path, "one separator between entries (every second column is empty)")


def _plain_numbers(layout: _Layout, lines: Iterator[str]) -> Array | None:
    """Return the numbers by NumPy's reader, 20 times faster; None for what it cannot read."""
    separator = layout.separator
    try:
        ended = lines if separator is None else (line.removesuffix(separator) for line in lines)
        return np.loadtxt(ended, delimiter=separator, ndmin=2)
    except ValueError:
        return None


def _numbers(
    path: Path, layout: _Layout, lines: Iterator[tuple[int, str]], width: int
) -> tuple[Array, list[str]]:
    """Return the numbers of all lines, each of ``width`` entries, and notes. Raises `InputError`."""
    values, decimals, filled, short = array("d"), set[str](), [False, False], list[int]()
    for number, line in lines:
        if layout.separator != ",":
            decimals |= {mark for mark in ".," if mark in line}
            line = line.replace(",", ".")
        cells = layout.cells(line)
        if layout.separator is not None and len(cells) < width:
            short.append(number)
            cells += [""] * (width - len(cells))
        if len(cells) != width or len(decimals) > 1:
            found = f"line {number} has {len(cells)}, the first row {width}"
            if len(decimals) > 1:
                found = f"decimal points and commas, line {number}: {line[:40]!r}"
            raise unreadable(path, f"rows of one length and kind ({found})")
        try:
            values.extend([layout.value(cell) for cell in cells])
        except ValueError:
            alien = layout.unknown(cells)[0][:40]
            allowed = f"numbers and {', '.join(NOT_MEASURED)} in the table (line {number}: {alien!r})"
            raise unreadable(path, allowed) from None
        filled = [filled[0] or cells[0] != "", filled[1] or cells[-1] != ""]
    notes = [f"separator {layout.name}, decimal comma"] if "," in decimals else []
    if short:
        notes.append(_SHORT.format(len(short), short[0]))
    rows = np.frombuffer(values).reshape(-1, width)
    for k, side in ((1, "last"), (0, "first")):
        if layout.separator is not None and not filled[k]:
            rows, notes = rows[:, :-1] if k else rows[:, 1:], [*notes, _EMPTY.format(side)]
    return rows, notes
