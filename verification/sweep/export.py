"""Rows as CSV and Parquet. Numbers are written so that they read back exactly."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from pathlib import Path

from refimpl.errors import InputError
from verification.framework.files import replacing, write_text
from verification.sweep.run import Row
from verification.sweep.store import COLUMNS


def to_csv(rows: Sequence[Row]) -> str:
    """CSV text with a header; floats in their shortest exact form, None as an empty field.

    >>> to_csv([]).split(",")[:3]
    ['key', 'realisation', 'grid']
    """
    buffer = io.StringIO()
    writer = csv.writer(buffer, lineterminator="\n")
    writer.writerow(COLUMNS)
    writer.writerows([row[name] for name in COLUMNS] for row in rows)
    return buffer.getvalue()


def write_csv(rows: Sequence[Row], path: Path) -> None:
    """Write the CSV in one step."""
    write_text(to_csv(rows), path)


def write_parquet(rows: Sequence[Row], path: Path) -> None:
    """Write a Parquet file in one step; raises InputError where pyarrow is not installed."""
    require_parquet(path)
    import pyarrow
    import pyarrow.parquet

    table = pyarrow.table({name: [row[name] for row in rows] for name in COLUMNS})
    with replacing(path) as temporary:
        pyarrow.parquet.write_table(table, temporary)


def require_parquet(path: Path) -> None:
    """Raise InputError at once, before any work, where Parquet is unavailable."""
    try:
        import pyarrow.parquet  # noqa: F401  # only whether it is there
    except ModuleNotFoundError as missing:
        allowed = "pyarrow installed (pip install 'rough-friction[parquet]'), or --csv instead"
        raise InputError("--parquet", str(path), allowed) from missing
