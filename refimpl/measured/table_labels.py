"""Labels of rows and columns in a table of heights: counts, which are dropped, and coordinates."""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path

import numpy as np

from refimpl.errors import InputError
from refimpl.grid import Array
from refimpl.measured.point_tables import POINT

_NUMBER = re.compile(r"[-+]?(\d+[.,]?\d*|[.,]\d+)([eEdD][-+]?\d+)?")
_WHOLE = re.compile(r"\d+")


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


def without_labels(path: Path, rows: Array, sample: list[list[str]]) -> tuple[Array, list[str]]:
    """Rows without an index column. Raises InputError for coordinates beside the heights."""
    column, titled = rows[:, 0], is_title(sample)
    notes = ["a leading index row was dropped"] if titled else []
    body = sample[1:] if titled else sample
    counts = column[0] in (0, 1) and bool(np.all(np.diff(column) == 1)) and min(rows.shape) > 1
    if counts and all(_WHOLE.fullmatch(row[0]) for row in body) and _are_heights(body):
        return rows[:, 1:], [*notes, "a leading index column was dropped"]
    cornered = titled and not _NUMBER.fullmatch(sample[0][0])
    if cornered or (np.isnan(rows[0, 0]) and _is_even(rows[0, 1:]) and _is_even(rows[1:, 0])):
        found = f"the first row begins with {sample[0][:4]}, the first column with {rows[:4, 0].tolist()}"
        raise InputError("path", str(path), f"heights without their coordinates ({found})")
    return rows, notes


def _is_even(values: Array) -> bool:
    """Return whether values rise or fall by one step, as coordinates do."""
    steps = np.diff(values)
    return len(steps) > 1 and steps[0] != 0 and bool(np.allclose(steps, steps[0], rtol=1e-3, atol=0))
