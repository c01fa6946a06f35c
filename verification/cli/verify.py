"""`rough-friction verify`: run the verification cases."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from verification.cli import export, suite_run
from verification.cli.options import Options, option
from verification.cli.output import check_workers, emit, judgement, refusal, select_or_refuse
from verification.output.text_table import columns

if TYPE_CHECKING:
    from verification.framework.runner import Run

EPILOG = """examples:
  rough-friction verify --tier quick --json results.json
  rough-friction verify --tier full --only 'hertz/*' --only 'kernels/love-*'
  rough-friction verify --list
  rough-friction verify --solver verification.solver_suite.own:solve
  rough-friction verify --exec './my-solver --quiet' --able aperiodic,load --largest 32
  rough-friction verify --self-test
  rough-friction verify --export reference-data
"""
SELF_TEST = "solver_suite/*"
"""The cases that run the suite for other solvers on our own, and on broken ones."""

OPTIONS: Options = {
    "--tier": option("full includes the quick cases", choices=("quick", "full"), default="quick"),
    "--only": option("only these; may be repeated", metavar="ID-GLOB", action="append", default=[]),
    "--jobs": option("worker processes (default 2)", metavar="N", type=int, default=2),
    "--list": option("list the selected cases and run nothing", action="store_true"),
    "--export": option(
        "run no case; write the problems of the suite for other solvers (of the cases that --only\n"
        "selects, up to 64 elements a side) with certified pressures and proven bounds",
        metavar="DIR",
        type=Path,
    ),
}


def run(options: argparse.Namespace) -> int:
    """Run or list the cases; status 1 when one failed or broke, or none passed."""
    from verification.framework import registry, runner
    from verification.framework.case import Tier

    check_workers("--jobs", options.jobs)
    if options.export is not None:
        if options.solver or options.exec or options.self_test or options.list:
            raise refusal("--export", str(options.export), "no other action beside it")
        return export.run(options)
    if suite_run.chosen(options):
        return suite_run.run(options)
    if options.self_test:
        options.tier, options.only = "full", options.only or [SELF_TEST]
    tier, only = Tier(options.tier), options.only
    chosen = select_or_refuse(only, lambda: registry.select(registry.load(), tier, only))
    if options.list:
        document = [{"id": c.id, "tier": c.tier.value, "title": c.title} for c in chosen]
        emit(document, options.json, columns([[c.id, c.tier.value, c.title] for c in chosen], indent=""))
        return 0
    done = runner.run(options.tier, only=options.only, jobs=options.jobs)
    emit(done.document(), options.json, table(done))
    return done.exit_status


def table(done: Run) -> str:
    """Return one line per case, the reasons of those not judged, and the counts."""
    from reports.results import shown_counts, shown_status

    rows = [[shown_status(vars(r)), r.id, judgement(r), f"{r.seconds:.1f} s"] for r in done.results]
    reasons = [[r.id, r.note] for r in done.results if r.status in ("error", "unavailable")]
    counted = shown_counts(map(vars, done.results))
    counts = ", ".join(f"{number} {status}" for status, number in counted.items())
    parts = [columns(rows, indent=""), columns(reasons), f"{counts}; {done.seconds:.0f} s"]
    return "\n\n".join(part for part in parts if part)
