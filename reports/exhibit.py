"""Exhibit of a study in a chapter: sentences, tables and figures from its own result file, ready to print."""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any
from urllib.parse import quote

from reports.drawing import Data, Figure, complete, svg
from reports.inline_svg import StyleSheet

_UNQUOTED = "!$&'()*+,-./:;=?@_~"
"""Characters that need no quoting in a ``data:`` address in HTML."""
Cell = str | float | int | bool | None
Column = str | Callable[[Any], Cell]
Document = Mapping[str, Any]


@dataclass(frozen=True)
class Table:
    """A table: what it shows, its head, and rows of texts and numbers; None is shown as not available."""

    caption: str
    head: Sequence[str]
    rows: Sequence[Sequence[Cell]]


def table(caption: str, records: Iterable[Any], columns: Mapping[str, Column]) -> Table:
    """Return a table with a row a record; ``columns`` has the heads, and what stands below each.

    A column is a key of the record, a format of its values, or a function of it.

    >>> table("", [{"M": 64, "s": 0.5}], {"grid": "{M}²", "s": "s", "ms": lambda row: 1000 * row["s"]})
    Table(caption='', head=('grid', 's', 'ms'), rows=[('64²', 0.5, 500.0)])
    """
    rows = [tuple(_cell(record, column) for column in columns.values()) for record in records]
    return Table(caption, tuple(columns), rows)


def _cell(record: Any, column: Column) -> Cell:
    if callable(column):
        return column(record)
    found: Cell = column.format_map(record) if "{" in column else record[column]
    return found


@dataclass(frozen=True)
class Exhibit:
    """A study in the report: a title, paragraphs of plain text, tables, and figures with their series."""

    title: str
    paragraphs: Sequence[str] = ()
    tables: Sequence[Table] = ()
    figures: Sequence[tuple[Figure, Data]] = field(default=())


def as_csv(figure: Figure, data: Data) -> str:
    """Return all data as CSV, the figure's own first: lists and mappings as columns; six digits."""
    buffer = io.StringIO()
    write = csv.writer(buffer, lineterminator="\n").writerow
    names = dict.fromkeys((*figure.needs, *(name for name, v in data.items() if not isinstance(v, str))))
    columns = {name: data[name] for name in names if _is_column(data[name])}
    if columns:
        write(columns)
        for k in range(max(map(len, columns.values()))):
            write([_six(values[k]) if k < len(values) else None for values in columns.values()])
    for name in names:
        if name not in columns:
            _write_block(write, name, data[name])
    return buffer.getvalue()


def _six(value: Any) -> Any:
    return f"{value:.6g}" if isinstance(value, float) else value


def csv_address(text: str) -> str:
    """Return the CSV as a ``data:`` address."""
    return f"data:text/csv;charset=utf-8,{quote(text, safe=_UNQUOTED)}"


def _is_column(values: object) -> bool:
    return isinstance(values, list) and not any(isinstance(value, list | Mapping) for value in values)


def _write_block(write: Callable[[Sequence[Any]], Any], name: str, values: Any) -> None:
    write([name])
    if isinstance(values, Mapping):
        for key, value in values.items():
            write([key, *map(_six, value if isinstance(value, list) else [value])])
    elif isinstance(values, list):
        for row in values:
            write([*map(_six, row if isinstance(row, list) else [row])])
    else:
        write([_six(values)])


class Album:
    """Collect the figures of a page."""

    def __init__(self) -> None:
        self._shown: set[str] = set()
        self._tables: dict[int, tuple[Data, str]] = {}
        self._number = 0
        self._sheet = StyleSheet()

    def add(self, figure: Figure, data: Data, title: str = "") -> Mapping[str, Any] | None:
        """Return the figure for the page; None for one already there, or without its series.

        A figure that is shown has ``svg``, ``caption``, ``name``, and ``csv``: an address of all data of its
        case, or a link to the figure, ``table``, that has them. ``title`` is the case's.
        """
        caption = figure.caption.replace("{title}", title)
        if not figure.available(data):
            return {"caption": caption, "svg": None, "csv": None, "name": "", "table": ""}
        key = repr((figure.caption, [data[name] for name in figure.needs]))
        if key in self._shown:
            return None
        drawn = svg(figure, data, f"f{self._number}", caption)
        self._shown.add(key)
        self._number += 1
        name = f"figure-{self._number}"
        first = self._tables.setdefault(id(data), (data, name))[1]  # holds the data: an id is used once
        return {
            "caption": caption,
            "svg": self._sheet.shared(drawn) if drawn else None,
            "csv": csv_address(as_csv(figure, complete(figure, data))) if first == name else f"#{first}",
            "name": name,
            "table": first,
        }

    @property
    def styles(self) -> str:
        """Rules for the styles of all figures."""
        return self._sheet.rules
