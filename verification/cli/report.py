"""`rough-friction report`: result files as a self-contained HTML page."""

from __future__ import annotations

import argparse
import os
from datetime import UTC, datetime
from importlib import resources
from pathlib import Path
from typing import TYPE_CHECKING, Any

from verification.cli.options import Options, option
from verification.cli.output import check_outputs, emit, read_or_refuse, refusal
from verification.output.files import StatusLine
from verification.output.text_table import columns, wrapped

if TYPE_CHECKING:
    from verification.framework.case import Case
    from verification.solver_suite.check import Check

EPILOG = """examples:
  rough-friction verify --tier quick --json results.json
  rough-friction report --results results.json --output report
  rough-friction report --results results.json --against older.json
"""

OPTIONS: Options = {
    "--results": option("result file", metavar="FILE", type=Path, default=Path("results.json")),
    "--output": option("folder for the report", metavar="DIR", type=Path, default=Path("report")),
    "--committed": option("committed results (default: those of the package)", metavar="DIR", type=Path),
    "--against": option("add a section with the changes since this result file", metavar="OLD", type=Path),
}


def run(options: argparse.Namespace) -> int:
    """Make the report and print its path; the exit status is about that, not about the verdicts in it."""
    from reports.evidence import departures, gathered
    from reports.generator import render
    from reports.results import CaseDataError, ResultFileError, shown_counts
    from verification.output.files import write_text
    from verification.output.provenance import is_known
    from verification.output.result_files import name_of, result_paths

    results = read_run(options.results)
    against = None if options.against is None else read_run(options.against, "--against")
    folder = options.committed or Path(str(resources.files("reports").joinpath("results")))
    if not folder.is_dir():
        raise refusal("--committed", str(folder), "a folder of result files")
    try:
        files = result_paths(folder)
    except ValueError as twice:
        raise refusal("--committed", str(folder), f"one result file of a name ({twice})") from twice
    committed = {name_of(path): read_run(path, "--committed") for path in files}
    path = options.output / "report.html"
    read = [options.results, *([] if options.against is None else [options.against]), *files]
    check_outputs(read, output=[path], json=options.json)
    above = (options.output, *options.output.absolute().parents)
    nearest = next(folder for folder in above if os.path.exists(folder))
    if not (nearest.is_dir() and os.access(nearest, os.W_OK | os.X_OK)):
        raise refusal("--output", str(options.output), "a folder that can be written to")
    try:
        evidence = gathered(results, committed)
        said = departures(evidence, registered(evidence.solver), is_known, datetime.now(UTC))
        with StatusLine() as line:
            page = render(results, committed, against, line.show, said)
    except ResultFileError as alien:  # data that no figure can show
        if isinstance(alien, CaseDataError) and alien.origin is None:
            raise refusal("--results", str(options.results), f"a result file ({alien})") from alien
        raise refusal("--committed", str(folder), f"result files ({alien})") from alien
    try:
        options.output.mkdir(parents=True, exist_ok=True)
    except (FileExistsError, NotADirectoryError, PermissionError) as refused:
        raise refusal("--output", str(options.output), "a folder that can be written to") from refused
    write_text(page, path)
    rows = [[status, str(number)] for status, number in shown_counts(results["cases"]).items()]
    document = {"report": str(path), "counts": results["counts"], "departures": said}
    notes = [wrapped(text, "other than the code: ") for text in said]
    emit(document, options.json, "\n".join([columns(rows, indent=""), *notes, str(path.resolve())]))
    return 0


def registered(solver: str | None) -> dict[str, dict[str, Any]]:
    """Return claim, metric, tolerance and tier of our cases; of a run of a solver, the suite's too."""
    from verification.framework.registry import load
    from verification.solver_suite import convergence, suite

    checks = () if solver is None else (*suite.thorough(), *convergence.CASES)
    rows: list[tuple[Case | Check, str, str]] = [(check, check.description, "") for check in checks]
    rows += [(case, case.claim, case.tier.value) for case in load()]
    return {
        case.id: {"claim": claim, "metric": case.metric.value, "tolerance": case.tolerance, "tier": tier}
        for case, claim, tier in rows
    }


def read_run(path: Path, option: str = "--results") -> Any:
    """Return a checked result file of `verify`, or a study's; raises InputError, naming the option."""
    from reports.results import FORMAT, ResultFileError, check

    found = read_or_refuse(option, path)
    if option == "--committed":
        if not isinstance(found, dict):
            raise refusal(option, str(path), "a result file: a JSON object")
        if found.get("format") != FORMAT:
            return found
    try:
        return check(found)
    except ResultFileError as wrong:
        raise refusal(option, str(path), f"a result file of 'verify' ({wrong})") from wrong
