"""Exhibit of a study in a chapter: sentences, tables and figures from its own result file, ready to print."""

from __future__ import annotations

import base64
import csv
import io
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from reports.drawing import Data, Figure

Cell = str | float | int | bool | None
Document = Mapping[str, Any]


@dataclass(frozen=True)
class Table:
    """A table: what it shows, its head, and rows of texts and numbers; None is shown as not available."""

    caption: str
    head: Sequence[str]
    rows: Sequence[Sequence[Cell]]


@dataclass(frozen=True)
class Exhibit:
    """A study in the report: a title, paragraphs of plain text, tables, and figures with their series."""

    title: str
    paragraphs: Sequence[str] = ()
    tables: Sequence[Table] = ()
    figures: Sequence[tuple[Figure, Data]] = field(default=())


Build = Callable[[Document], Exhibit]
"""From the study's result file to what is shown of it; KeyError where the file lacks what it should hold."""


def as_csv(figure: Figure, data: Data) -> str:
    """The figure's series as CSV: lists as columns, mappings as two columns, arrays row by row.

    >>> from reports.drawing import lines
    >>> pair = Figure("*", ("h", "error"), lines("h", {"error": "e"}, xlabel="", ylabel=""), "")
    >>> print(as_csv(pair, {"h": [1, 2], "error": [0.1, None]}))
    h,error
    1,0.1
    2,
    <BLANKLINE>
    """
    buffer = io.StringIO()
    write = csv.writer(buffer, lineterminator="\n").writerow
    columns = {name: data[name] for name in figure.needs if _is_column(data[name])}
    if columns:
        write(columns)
        for k in range(max(map(len, columns.values()))):
            write([values[k] if k < len(values) else None for values in columns.values()])
    for name in figure.needs:
        if name not in columns:
            _write_block(write, name, data[name])
    return buffer.getvalue()


def address(text: str, kind: str) -> str:
    """The text as a ``data:`` address of the given media type."""
    return f"data:{kind};base64,{base64.b64encode(text.encode()).decode()}"


def _is_column(values: object) -> bool:
    return isinstance(values, list) and not any(isinstance(value, list | Mapping) for value in values)


def _write_block(write: Callable[[Sequence[Any]], Any], name: str, values: Any) -> None:
    """What is no column: a mapping, an array of rows, or a single value, below its name."""
    write([name])
    if isinstance(values, Mapping):
        for key, value in values.items():
            write([key, *(value if isinstance(value, list) else [value])])
    elif isinstance(values, list):
        for row in values:
            write(row if isinstance(row, list) else [row])
    else:
        write([values])
