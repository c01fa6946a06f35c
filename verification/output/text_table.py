"""Tables of text for people: aligned columns within a width."""

from __future__ import annotations

import csv
import io
import textwrap
from collections.abc import Iterable, Sequence

WIDTH = 100
"""Columns that tables and texts keep within."""


def columns(rows: Sequence[Sequence[str]], indent: str = "  ") -> str:
    """Return the rows of texts as aligned columns within `WIDTH`: the last one is wrapped where it must be.

    >>> print(columns([["mu", "0.1", "x"], ["approach", "12", "y"]]))
      mu        0.1  x
      approach  12   y
    """
    widths = [max(len(row[k]) for row in rows) for k in range(len(rows[0]) - 1)] if rows else []
    lines = []
    for row in rows:
        cells = (cell.ljust(width) + "  " for cell, width in zip(row[:-1], widths, strict=True))
        lines.append(wrapped(row[-1], indent + "".join(cells)))
    return "\n".join(lines)


def markdown_row(cells: Iterable[str]) -> str:
    r"""Return a row of a table in Markdown.

    >>> markdown_row(["a|b", "c"]) == "| a" + chr(92) + "|b | c |"
    True
    """
    return f"| {' | '.join(cell.replace('|', chr(92) + '|') for cell in cells)} |"


def csv_text(rows: Iterable[Iterable[object]]) -> str:
    """Return rows as CSV: floats in their shortest exact form, None as an empty field.

    >>> csv_text([("x", "y"), (0.1, None)])
    'x,y\\n0.1,\\n'
    """
    buffer = io.StringIO()
    csv.writer(buffer, lineterminator="\n").writerows(rows)
    return buffer.getvalue()


def wrapped(text: str, first: str) -> str:
    """Return the text after its first words, wrapped within `WIDTH`; what follows starts below it.

    >>> print(wrapped("word " * 20, "reason: "))
    reason: word word word word word word word word word word word word word word word word word word
            word word
    """
    room = max(WIDTH - len(first), 20)  # beside a very wide table, a narrow column is as good as it gets
    lines = textwrap.wrap(text, room, break_long_words=False, break_on_hyphens=False) or [""]
    return f"\n{' ' * len(first)}".join(lines).join((first, "")).rstrip()
