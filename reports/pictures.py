"""The figures of one page: each shown once, with alternative text, its data as CSV, and shared styles."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from reports.drawing import Data, Figure, complete, svg
from reports.exhibit import as_csv, csv_address
from reports.inline_svg import StyleSheet


class Album:
    """Collect the figures of a page."""

    def __init__(self) -> None:
        self._shown: set[str] = set()
        self._tables: dict[int, tuple[Data, str]] = {}
        self._number = 0
        self._sheet = StyleSheet()

    def add(self, figure: Figure, data: Data, title: str = "") -> Mapping[str, Any] | None:
        """The figure for the page; None for one that is on the page already, or whose series are missing.

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
