"""Marks within the numbers of a text table: decimal ones, or of thousands, or between numbers."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from pathlib import Path

from refimpl.measured.reading import unreadable

_GROUPED = r"[-+]?[1-9]\d{0,2}[.,]\d{3}"
_THOUSANDS, _ROW = re.compile(_GROUPED), re.compile(rf"(?:{_GROUPED}[\s;]+)*{_GROUPED}[\s;]*")
_WHOLE = re.compile(r"[-+]?\d{1,3}")
# 0.5, 1234.5, 1.32, 1.3205, 1.320e-3
_DECIMAL = re.compile(r"(?<![\d.,])(?:0\d*[.,]|\d{4,}[.,]|\d*[.,](?:\d{0,2}(?!\d)|\d{4}|\d*[ed]))", re.I)
_TIGHT = re.compile(r"\d,\d")


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
            elif _WHOLE.fullmatch(cell):
                whole.add(k)
    return first if marked & whole or commas else ""
