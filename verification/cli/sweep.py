"""`rough-friction sweep`: the runs of a study, kept in a store, resumable, and exported as a table."""

from __future__ import annotations

import argparse
import json
import math
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from verification.cli.options import Options, option, output_file, output_text, picture
from verification.cli.output import check_outputs, check_workers, emit, refusal
from verification.output.files import StatusLine
from verification.output.text_table import columns, wrapped

if TYPE_CHECKING:
    from verification.sweep.engine import Progress, Sweep
    from verification.sweep.run import Row
    from verification.sweep.study import Study

FAILED = "FAILED"  # status of rows without numbers
MOST_FILES = 7  # curves of a picture, one for each file; more are a mean with its scatter
NAMES = {"friction_coefficient_corrected": "mu", "contact_area_corrected": "A"}
SUFFIXES = {"store": ".sqlite", "csv": ".csv", "parquet": ".parquet", "json": ".json"}

EPILOG = """examples:
  rough-friction sweep table3 --store table3.sqlite --workers 4 --csv table3.csv
  rough-friction sweep study.toml --parquet study.parquet
  rough-friction sweep study.toml --scheduler tcp://127.0.0.1:8786 --csv study.csv
  rough-friction sweep study.toml --plot mu.svg --x load --by lower_rms

A study is a TOML file, or the name of a shipped one. If the command is killed, run it again: it
resumes, and finished runs are not repeated. Exit status 1 if a run failed or did not converge; the
message of a failed run is printed, and the status of the others stands in their rows.

  scene = "table1-rough"      # a shipped scene, or a scene file relative to this file
  realisations = 75           # number per random roughness; seeds from first_seed (default 1;
                              #   with one realisation the scene's own). Without such a
                              #   roughness (smooth, measured) there is one alone
  normalise = true            # scale each realisation to its rms (default: as the scene says)
  [vary]                      # any of: grid load upper_rms lower_rms correlation_length tau beta
  grid = [128, 256]           #   sliding_direction sliding_offset (SI, rad), and by full name
                              #   numbers of surfaces and materials, seeds, and the path of
                              #   a measured surface (relative to this file); without a grid
                              #   256 elements, of measured maps each run's own points, up to
                              #   512; one value needs no list
  lower_rms = [0.504e-6, 1.68e-6]
  "lower.surface[0].lay" = [0.0, 0.7854]
  [solve]                     # optional: method, oblique, slope_correction, tolerance,
                              #   accuracy and quantity (chosen grids; then no grid in [vary])
"""

OPTIONS: Options = {
    "study": option("a study's TOML file, or the name of a shipped study", metavar="STUDY"),
    "--store": option("default: the study's name, .sqlite, here", metavar="FILE.sqlite", type=output_file),
    "--workers": option("worker processes (default 2)", metavar="N", type=int, default=2),
    "--scheduler": option("use the workers of this dask.distributed scheduler instead", metavar="ADDRESS"),
    "--csv": option("export the study's rows as CSV ('-': to stdout)", metavar="FILE", type=output_text),
    "--parquet": option("export the study's rows as Parquet", metavar="FILE", type=output_file),
    "--plot": option("curves as a picture (.png, .svg or .pdf)", metavar="FILE", type=picture),
    "--x": option("with --plot: the column along x (default: what varies)", metavar="COLUMN"),
    "--y": option(
        "with --plot: the column along y (default friction_coefficient_corrected)", metavar="COLUMN"
    ),
    "--by": option("with --plot: column that distinguishes the curves", metavar="COLUMN"),
    "--keep-going": option(
        "skip files that cannot be used; rows of these and of failed runs have the status FAILED and "
        "the reason in place of warnings",
        action="store_true",
    ),
}


def run(options: argparse.Namespace) -> int:
    """Run what is missing and export; status 1 when a run failed, did not converge, or a worker was lost."""
    from verification.sweep import engine, export, posable
    from verification.sweep.store import files_of
    from verification.sweep.study_file import read_study

    check_workers("--workers", options.workers)
    if options.parquet is not None:
        export.require_parquet(options.parquet)
    store = options.store or Path(Path(options.study).stem + ".sqlite")
    study = read_study(options.study, keep_going=options.keep_going)
    check_plot(options, study)
    written = {name: getattr(options, name) for name in ("csv", "parquet", "json", "plot")}
    check_outputs(study.files, store=files_of(store), **written)
    _check_suffixes(store=options.store, **written)
    if options.scheduler is None:  # a cluster's memory is not this machine's
        posable.check_memory(study)
    skipped = (f"skipped: {reason}" for reason in study.unusable.values())
    for note in (*study.notes, *skipped, *directions_note(study)):
        print(f"rough-friction sweep: {note}", file=sys.stderr)
    line = _Line()
    try:
        with line:
            done = engine.sweep(
                study, store, workers=options.workers, scheduler=options.scheduler, tick=line.count
            )
    except KeyboardInterrupt:
        print(f"rough-friction sweep: {line.interrupted(store)}", file=sys.stderr)
        raise
    except engine.WorkersLost as lost:
        print(f"rough-friction sweep: {lost}", file=sys.stderr)
        return 1
    _export(options, done, store, failed_rows(study, done) if options.keep_going else [])
    return 1 if done.failures or done.unconverged or study.unusable else 0


def failed_rows(study: Study, done: Sweep) -> list[Row]:
    """Return a row for each run that failed and each file that was skipped: its inputs and the reason."""
    runs = {run.key: run for run in study.runs()} if done.failures else {}
    failed = [
        {"key": key, **runs[key].coordinates, "status": FAILED, "warnings": reason}
        for key, reason in done.failures.items()
    ]
    return failed + [
        {"parameters": json.dumps({axis: path}), "status": FAILED, "warnings": reason}
        for (axis, path), reason in study.unusable.items()
    ]


def directions_note(study: Study) -> list[str]:
    """Return a hint where directions vary and one has no opposite; else nothing."""
    turns = [float(phi) for phi in study.vary.get("sliding_direction", ())]
    if len(turns) < 2 or all(any(_opposite(one, other) for other in turns) for one in turns):
        return []
    return [
        "mu over the direction holds the mean slope of a single specimen, which looks like lay: average each "
        "phi with phi + pi, where it has the opposite sign"
    ]


def _opposite(one: float, other: float) -> bool:
    return math.cos(one - other) < -1 + 1e-6


def check_plot(options: argparse.Namespace, study: Study) -> None:
    """Choose the columns of the picture; refuse, before any run, what names none or has no picture."""
    from verification.sweep.run import COORDINATES, OUTCOMES

    given = {name: getattr(options, name) for name in ("x", "y", "by") if getattr(options, name)}
    if options.plot is None:
        for name, value in given.items():
            raise refusal(f"--{name}", value, "none without --plot")
        return
    known = (*COORDINATES, *OUTCOMES, *study.own_axes)
    for name, value in given.items():
        if value not in known:
            raise refusal(f"--{name}", value, f"one of {', '.join(known)}")
    several = [axis for axis, values in study.vary.items() if len(values) > 1]
    options.y = options.y or "friction_coefficient_corrected"
    numbers = [axis for axis in several if axis != options.by and not axis.endswith((".path", ".seed"))]
    options.x = options.x or next(iter(numbers), "realisation")
    few = {axis for axis in several if not axis.endswith(".path") or len(study.vary[axis]) <= MOST_FILES}
    others = [axis for axis in several if axis in few and axis != options.x and not axis.endswith(".seed")]
    options.by = options.by or next(iter(others), None)


def _check_suffixes(**written: Path | None) -> None:
    for name, path in written.items():
        for other, suffix in SUFFIXES.items():
            if path is not None and other != name and path.suffix.lower() == suffix:
                allowed = f"no name that ends in {suffix}, as that of --{other} does"
                raise refusal(f"--{name}", str(path), allowed)


def _export(options: argparse.Namespace, done: Sweep, store: Path, failed: list[Row]) -> None:
    """Write and show what was asked for; the rows take the table's place on standard output."""
    from verification.output.provenance import provenance
    from verification.sweep import export

    skipped = len(failed) - len(done.failures) if failed else 0
    table, rows = _table(done, store, skipped), [*done.rows, *failed]
    if options.csv == Path("-"):
        if done.failures or done.unconverged:
            print(table, file=sys.stderr)
        table = export.to_csv(rows).rstrip("\n")
    elif options.csv is not None:
        export.write_csv(rows, options.csv)
    if options.parquet is not None:
        export.write_parquet(rows, options.parquet)
    if options.plot is not None and done.rows:
        from verification.cli.plot_curves import draw_sweep
        from verification.sweep.curves import curves

        found = curves(done.rows, options.x, options.y, options.by)
        draw_sweep(found, options.x, options.y, options.by, options.plot)
    document = {
        "store": str(store),
        **{name: getattr(done, name) for name in ("found", "finished", "failures", "statuses")},
        "seconds": round(done.seconds, 3),
        "rows": rows,
        "provenance": provenance(),
    }
    emit(document, options.json, table)


def _table(done: Sweep, store: Path, skipped: int) -> str:
    rows = [
        ["found in the store", str(done.found)],
        ["finished now", str(done.finished)],
        ["failed", str(len(done.failures))],
        *([["files skipped", str(skipped)]] if skipped else []),
        *([status, str(number)] for status, number in sorted(done.statuses.items())),
    ]
    messages = [f"failed: {text}" for text in sorted(set(done.failures.values()))]
    if bad := done.unconverged:
        messages.append(f"{len(bad)} of {len(done.rows)} runs did not converge: their rows are no solutions")
    return "\n\n".join([f"{store}, {done.seconds:.0f} s", columns(rows), *messages, *_quality(done.rows)])


def _quality(rows: list[Row]) -> list[str]:
    from verification.sweep.quality import quality_of, warnings_of

    table = [
        [
            NAMES[found.name],
            "error bar unbounded" if math.isinf(found.error) else f"error bar {found.error:.2g}",
            "" if found.scatter is None else f"scatter {found.scatter:.2g}",
        ]
        for found in quality_of(rows)
    ]
    parts = [f"relative, median over the study:\n{columns(table)}"] if table else []
    for found in quality_of(rows):
        if found.biased:
            text = (
                "the grid's error bar exceeds the scatter of realisations at "
                f"{found.biased} of {found.points} points: use a finer grid, or accuracy in [solve]"
            )
            parts.append(wrapped(text, f"warning ({NAMES[found.name]}): "))
        elif found.points:
            text = f"the grid's error bar is below the scatter of realisations at all {found.points} points"
            parts.append(wrapped(text, f"{NAMES[found.name]}: "))
    with_any = sum(1 for row in rows if row["warnings"])
    if with_any:
        counted = ", ".join(f"{name} in {number}" for name, number in warnings_of(rows).items())
        parts.append(wrapped(counted, f"{with_any} of {len(rows)} runs with warnings: "))
    return parts


class _Line(StatusLine):
    """Progress of a sweep, and where an interrupted one goes on."""

    _last: Progress | None = None

    def count(self, progress: Progress) -> None:
        """Show how many runs are done."""
        self._last = progress
        failed = f", {progress.failed} failed" if progress.failed else ""
        self.show(f"[{progress.done}/{progress.total}]{failed} {time_left(progress.seconds_left)}")

    def interrupted(self, store: Path) -> str:
        """Return what is done and how it goes on."""
        if self._last is None:
            return "interrupted before the first run; the same command starts again"
        left = time_left(self._last.seconds_left)
        return (
            f"interrupted: {self._last.done} of {self._last.total} runs are kept in {store}; "
            f"the same command resumes{f', {left}' if left else ''}"
        )


def time_left(seconds: float | None) -> str:
    """Return the time left in words.

    >>> time_left(None), time_left(59.4), time_left(3725)
    ('', '59 s left', '1 h 02 min left')
    """
    if seconds is None:
        return ""
    if seconds < 90:
        return f"{seconds:.0f} s left"
    hours, minutes = divmod(round(seconds / 60), 60)
    return f"{hours} h {minutes:02d} min left" if hours else f"{minutes} min left"
