"""What the subcommands share: where output goes, and tables for a terminal."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

from verification.files import to_json, write_text

if TYPE_CHECKING:
    from verification.case import Result

Parsers: TypeAlias = "argparse._SubParsersAction[argparse.ArgumentParser]"


def output_file(text: str) -> Path:
    """Argument type of a file to write: refused at once where it could not be written in the end."""
    path = Path(text)
    if text == "-":
        return path
    if path.is_dir():
        raise argparse.ArgumentTypeError(f"{text!r} is a directory, not a file")
    if not (path.parent.is_dir() and os.access(path.parent, os.W_OK)):
        raise argparse.ArgumentTypeError(f"cannot write to the directory of {text!r}")
    return path


def add_json(parser: argparse.ArgumentParser) -> None:
    """The option that every subcommand has."""
    parser.add_argument(
        "--json",
        metavar="FILE",
        type=output_file,
        help="write the result as JSON ('-' for standard output)",
    )


def emit(document: object, path: Path | None, table: str) -> None:
    """Show the table, and write the document where asked; '-' prints the document in the table's place."""
    if path == Path("-"):
        sys.stdout.write(to_json(document))
        return
    print(table)
    if path is not None:
        write_text(to_json(document), path)


def columns(rows: Sequence[Sequence[str]], indent: str = "  ") -> str:
    """Rows of texts as aligned columns; the last column is free.

    >>> print(columns([["mu", "0.1", "x"], ["approach", "12", "y"]]))
      mu        0.1  x
      approach  12   y
    """
    widths = [max(len(row[k]) for row in rows) for k in range(len(rows[0]))] if rows else []
    lines = ("  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)) for row in rows)
    return "\n".join(indent + line.rstrip() for line in lines)


def judgement(result: Result) -> str:
    """Error and tolerance with the sign between them; empty where nothing could be judged."""
    if result.error is None:
        return ""
    sign = ">=" if result.metric == "at_least" else "<="
    sign = sign if result.status == "pass" else {">=": "<", "<=": ">"}[sign]
    return f"{result.error:.3g} {sign} {result.tolerance:.3g}"
