"""Tables of the page of numbers (`reports.results_page`), as Markdown: sections, rows, numbers, links."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from reports.exhibit import Column, table
from reports.results import Case
from verification.output.result_files import SUFFIX

RUN = "quick"
"""The run that the report is made of; the other files are beside it."""

Row = Sequence[object]


def listing(title: str, text: str, records: Iterable[Any], columns: Mapping[str, Column]) -> str:
    """Return a section with the table of the records (`reports.exhibit.table`)."""
    made = table(text, records, columns)
    return section(title, text, made.head, made.rows)


def section(title: str, text: str, head: Sequence[str], rows: Iterable[Row]) -> str:
    """Return a heading, a paragraph, and a table."""
    return "\n\n".join((f"## {title}", text, markdown(head, rows)))


def markdown(head: Sequence[str], rows: Iterable[Row]) -> str:
    """Return a table as Markdown."""
    return "\n".join(_lines(head, rows))


def _lines(head: Sequence[str], rows: Iterable[Row]) -> Iterator[str]:
    yield f"| {' | '.join(head)} |"
    yield "|" + "---|" * len(head)
    for row in rows:
        yield f"| {' | '.join(str(cell).replace('|', chr(92) + '|') for cell in row)} |"


def number(value: float | None, digits: str = ".2g") -> str:
    """Return a number in a table, without an exponent; a dash where there is none."""
    return "-" if value is None else f"{float(format(value, digits)):g}"


def link(name: str) -> str:
    """Return a link to a result file."""
    return f"[{name}.json](results/{name}{SUFFIX})"


def origin(case: Case) -> str:
    """Return a link to the file that holds the case."""
    return link(RUN if case["origin"] is None else case["origin"]["file"].removesuffix(".json"))
