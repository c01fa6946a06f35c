"""Labels of rows and columns in a table of heights; marks within its numbers: decimal, or of thousands."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

import numpy as np

from refimpl.grid import Array
from refimpl.measured.point_tables import POINT
from refimpl.measured.reading import unreadable

_NUMBER = re.compile(r"[-+]?(\d+[.,]?\d*|[.,]\d+)([eEdD][-+]?\d+)?")
_WHOLE = re.compile(r"\d+")
UNEVEN = 10  # values; of maps of ten smooth rows one in 300 has such a line, of longer or rougher ones none
_GROUPED = r"[-+]?[1-9]\d{0,2}[.,]\d{3}"
_THOUSANDS, _ROW = re.compile(_GROUPED), re.compile(rf"(?:{_GROUPED}[\s;]+)*{_GROUPED}[\s;]*")
_GROUP = re.compile(r"[-+]?\d{1,3}")
# 0.5, 1234.5, 1.32, 1.3205, 1.320e-3
_DECIMAL = re.compile(r"(?<![\d.,])(?:0\d*[.,]|\d{4,}[.,]|\d*[.,](?:\d{0,2}(?!\d)|\d{4}|\d*[ed]))", re.I)
_TIGHT = re.compile(r"\d,\d")


def _counts(cells: list[str]) -> bool:
    """Return whether entries are the whole numbers from 0 or 1 on."""
    whole = len(cells) > 1 and all(map(_WHOLE.fullmatch, cells)) and int(cells[0]) in (0, 1)
    return whole and [int(cell) for cell in cells] == list(range(int(cells[0]), int(cells[0]) + len(cells)))


def _are_heights(cells: Iterable[list[str]]) -> bool:
    """Return whether entries beside labels are not all whole, as labels are."""
    return not all(_WHOLE.fullmatch(cell) for row in cells for cell in row[1:] if cell)


def is_title(sample: list[list[str]]) -> bool:
    """Return whether the first row counts the columns, all of them or all but one without a number."""
    first = sample[0]
    if len(first) == POINT or len({len(row) for row in sample}) > 1:
        return False
    names = first if _NUMBER.fullmatch(first[0]) else first[1:]
    return _counts(names) and _are_heights(sample[1:])


def word_in_corner(sample: list[list[str]], unknown: list[str]) -> str:
    """Return the first entry of the first row where it is the only one that is no number; else nothing."""
    first = sample[0]
    return first[0] if len(first) > POINT and unknown == first[:1] and not is_title(sample) else ""


def without_labels(
    path: Path, rows: Array, sample: list[list[str]], corner: str = ""
) -> tuple[Array, list[str]]:
    """Return heights without index row or column, or points of a frame; `InputError` for other labels."""
    column, titled = rows[:, 0], is_title(sample)
    notes = ["a leading index row was dropped"] if titled else []
    body = sample[1:] if titled else sample
    counts = column[0] in (0, 1) and bool(np.all(np.diff(column) == 1)) and min(rows.shape) > 1
    if counts and all(_WHOLE.fullmatch(row[0]) for row in body) and _are_heights(body):
        return rows[:, 1:], [*notes, "a leading index column was dropped"]
    if rows.shape[1] <= POINT:
        return rows, notes
    if _are_places(rows[:, :2]):
        found = f"{rows.shape[1]} columns, of which the first two are places on a grid"
        raise unreadable(path, f"points in three columns, x, y, z ({found})")
    x, y = rows[0, 1:], rows[1:, 0]
    even = [_is_even(x) and not _goes_on(x, rows[1, 1:]), _is_even(y) and not _goes_on(y, rows[1:, 1])]
    if all(even) and not titled:
        said = f"the first row and column, corner {sample[0][0]!r}, are x and y, in the unit of the heights"
        points = [np.tile(x, len(y)), np.repeat(y, len(x)), rows[1:, 1:].ravel()]
        return np.stack(points, axis=1), [f"{said} unless a pixel is given"]
    cornered = bool(corner) or (titled and not _NUMBER.fullmatch(sample[0][0]))
    axis = any(_is_axis(*lines) for lines in ((rows[0], rows[1]), (column, rows[:, 1])))
    if cornered or axis or (np.isnan(rows[0, 0]) and any(even)):
        found = f"the first row begins with {sample[0][:4]}, the first column with {rows[:4, 0].tolist()}"
        raise unreadable(path, f"heights without their coordinates ({found})")
    return rows, notes


def _are_places(pairs: Array) -> bool:
    """Return whether pairs are the places of a grid, each once, of which a few may be absent."""
    counts = [len(np.unique(along)) for along in pairs.T]
    few = min(counts) > 1 and max(counts) <= len(pairs) // 2 and math.prod(counts) <= 2 * len(pairs)
    return few and len(np.unique(pairs, axis=0)) == len(pairs)


def _is_even(values: Array, share: float = 0.1) -> bool:
    """Return whether values rise or fall by one step, to a ``share`` of it; missing ones are left out."""
    at = np.flatnonzero(np.isfinite(values))
    if len(at) < POINT:
        return False
    step = (values[at[-1]] - values[at[0]]) / (at[-1] - at[0])
    off = values[at] - values[at[0]] - step * (at - at[0])
    return bool(step != 0 and np.abs(off).max() <= share * abs(step))


def _goes_on(first: Array, second: Array) -> bool:
    """Return whether the next line rises as the first: both are heights of a slope, or one is missing."""
    if not np.isfinite(first).all() or not np.isfinite(np.diff(second)).any():
        return True
    rise, other = (float(np.nanmedian(np.diff(line))) for line in (first, second))
    alike = rise**2 <= 2 * rise * other <= 4 * rise**2  # half to twice the rise
    return bool(np.isclose(rise, other, 1e-6, 0)) or (_is_even(second) and alike)


def _is_axis(first: Array, second: Array) -> bool:
    """Return whether a whole line is even, to rounding, or rises steadily, as none of heights does.

    Even ones count from four values on, others from `UNEVEN` on, where the next line is not like them.
    """
    if len(first) <= POINT or _goes_on(first, second):
        return False
    steps, other = np.diff(first), np.diff(second)
    steady = (steps * steps[0] > 0).all() and not (other * steps[0] > 0).all()
    unlike = np.nanstd(second - first) >= first.std()
    return bool(_is_even(first, 1e-6) or (len(first) >= UNEVEN and steady and unlike))


def refuse_ambiguous(
    path: Path, rows: Callable[[], Iterator[str]], separator: str | None, sample: list[str]
) -> None:
    """Raise `InputError` where marks within numbers may be decimal, of thousands, or separators."""
    if separator == ",":
        found = _grouped((row.replace(",", ";") for row in rows()), ";")
    else:
        found = _grouped(rows(), separator)
    if found:
        raise unreadable(path, f"decimal points (is {found!r} a thousand times as much?)")
    if separator == "," and not any("." in row for row in sample):
        zeros = any(len(cell) > 1 and cell[0] == "0" for row in sample for cell in row.split(","))
        if zeros or (any(", " in row for row in sample) and any(map(_TIGHT.search, sample))):
            said = f"are the commas in {sample[0][:40]!r} separators or decimal marks?"
            raise unreadable(path, f"decimal points, or semicolons between entries ({said})")


def _grouped(rows: Iterator[str], separator: str | None) -> str:
    """Return a number whose mark may be of thousands, of a table without decimal ones; else nothing."""
    marked, whole, first, commas, width = set[int](), set[int](), "", False, 0
    for row in (row.partition("#")[0] for row in rows):
        has_mark = "." in row or "," in row
        known = len(marked) == width and _ROW.fullmatch(row) if has_mark else len(whole) == width
        if width and known:
            continue
        if has_mark and _DECIMAL.search(row):
            return ""
        cells = [cell.strip() for cell in row.split(separator)]
        width = max(width, len(cells))
        for k, cell in enumerate(cells):
            if _THOUSANDS.fullmatch(cell):
                first, commas = first or cell, commas or "," in cell
                marked.add(k)
            elif _GROUP.fullmatch(cell):
                whole.add(k)
    return first if marked & whole or commas else ""
