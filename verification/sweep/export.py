"""Rows as CSV, Parquet and a DataFrame, with units. Numbers are written so that they read back exactly."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from refimpl.errors import require_installed
from refimpl.scene.scene_file import FRICTION, MATERIAL, SCENE, SURFACES
from refimpl.solution.quantities import QUANTITIES
from verification.output.files import replacing, write_text
from verification.output.text_table import csv_text
from verification.sweep.run import Row
from verification.sweep.store import COLUMNS
from verification.sweep.study_file import TEXTS

UNITS: dict[str, str] = {
    **{name: unit for name, (unit, _) in (SCENE | FRICTION).items()},
    **{name: "" if quantity.unit == "1" else quantity.unit for name, quantity in QUANTITIES.items()},
    **{name: unit for name, (unit, _) in TEXTS["vary"].items()},
    "seconds": "s",
}
"""Units of the columns; those of an error or a cycle are its number's, all others have none."""
KEY_UNITS = {name: unit for texts in (MATERIAL, *SURFACES.values()) for name, (unit, _) in texts.items()}
"""Units of numbers varied by their full names, by the last part of the name."""


def unit_of(name: str) -> str:
    """Return a column's unit, empty without one.

    >>> unit_of("contact_area_error"), unit_of("load"), unit_of("status")
    ('m^2', 'N', '')
    >>> unit_of("lower.material.hardness"), unit_of("upper.surface[0].correlation_length[1]")
    ('Pa', 'm')
    """
    if "." in name:
        return KEY_UNITS.get(name.rpartition(".")[2].partition("[")[0], "")
    return UNITS.get(name.removesuffix("_error").removesuffix("_cycle"), "")


def header(name: str) -> str:
    """Return a column's header with its unit.

    >>> header("load"), header("key")
    ('load [N]', 'key')
    """
    unit = unit_of(name)
    return f"{name} [{unit}]" if unit else name


def to_dataframe(rows: Sequence[Row]) -> Any:
    """Return a `pandas.DataFrame`, full names as own columns; InputError without pandas."""
    allowed = "pandas installed (pip install '.[arrays]' in a checkout)"
    require_installed("to_dataframe", "pandas", allowed, "pandas")
    import pandas

    frame = pandas.DataFrame([row | named(row) for row in rows])
    frame.attrs["units"] = {name: unit_of(name) for name in frame.columns}
    return frame


def named(row: Row) -> Row:
    """Return the numbers of a row that the study varies by their full names."""
    found: Row = json.loads(row.get("parameters") or "{}")
    return found


def _with_own_columns(rows: Sequence[Row]) -> tuple[list[Row], list[str]]:
    """Return the rows, and names of their columns: after all others, what the study varies by full names."""
    own = dict.fromkeys(name for row in rows for name in named(row))
    return [row | named(row) for row in rows], [*COLUMNS, *own]


def to_csv(rows: Sequence[Row]) -> str:
    """Return CSV text with a header, as `csv_text` writes it.

    >>> to_csv([]).split(",")[:3]
    ['key', 'realisation', 'grid']
    """
    rows, names = _with_own_columns(rows)
    return csv_text([map(header, names), *([row.get(name) for name in names] for row in rows)])


def write_csv(rows: Sequence[Row], path: Path) -> None:
    """Write the CSV in one step."""
    write_text(to_csv(rows), path)


def write_parquet(rows: Sequence[Row], path: Path) -> None:
    """Write a Parquet file in one step; raises InputError where pyarrow is not installed."""
    require_parquet(path)
    import pyarrow
    import pyarrow.parquet

    rows, names = _with_own_columns(rows)
    table = pyarrow.table({header(name): [row.get(name) for row in rows] for name in names})
    with replacing(path) as temporary:
        pyarrow.parquet.write_table(table, temporary)


def require_parquet(path: Path) -> None:
    """Raise InputError at once, before any work, where Parquet is unavailable."""
    allowed = "pyarrow installed (pip install '.[parquet]' in a checkout), or --csv instead"
    require_installed("--parquet", str(path), allowed, "pyarrow.parquet")
