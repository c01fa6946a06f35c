"""`rough-friction report`: a result file as a self-contained HTML page."""

from __future__ import annotations

import argparse
import json
from pathlib import Path

from verification.cli.output import Parsers, add_json, columns, emit

EPILOG = """example:
  rough-friction verify --tier quick --json results.json
  rough-friction report --results results.json --output report
"""


def add_parser(commands: Parsers) -> None:
    """Declare the subcommand."""
    parser = commands.add_parser(
        "report",
        help="make the validation report",
        description="Make the validation report, one HTML file, from a result file of 'verify'.",
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument(
        "--results", metavar="FILE", type=Path, default=Path("results.json"), help="result file"
    )
    parser.add_argument(
        "--output", metavar="DIR", type=Path, default=Path("report"), help="folder for the report"
    )
    add_json(parser)
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Make the report and print its path; the exit status is about that, not about the verdicts in it."""
    from refimpl.errors import InputError
    from reports.generator import render
    from reports.results import ResultFileError
    from verification.files import write_text

    try:
        results = json.loads(options.results.read_text(encoding="utf-8"))
    except FileNotFoundError as missing:
        allowed = "a result file; make one with 'rough-friction verify --json FILE'"
        raise InputError("--results", str(options.results), allowed) from missing
    except (json.JSONDecodeError, UnicodeDecodeError, IsADirectoryError) as broken:
        raise InputError("--results", str(options.results), f"JSON ({broken})") from broken
    try:
        page = render(results)
    except ResultFileError as alien:
        raise InputError(
            "--results", str(options.results), f"a result file of 'verify' ({alien})"
        ) from alien
    try:
        options.output.mkdir(parents=True, exist_ok=True)
    except (FileExistsError, NotADirectoryError, PermissionError) as refused:
        raise InputError("--output", str(options.output), "a folder that can be written to") from refused
    path = options.output / "report.html"
    write_text(page, path)
    rows = [[status, str(number)] for status, number in results["counts"].items()]
    document = {"report": str(path), "counts": results["counts"]}
    emit(document, options.json, f"{columns(rows, indent='')}\n{path.resolve()}")
    return 0
