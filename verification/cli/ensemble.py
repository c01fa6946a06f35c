"""`rough-friction sweep --target-error`: an ensemble's means, as a table and as JSON."""

from __future__ import annotations

import argparse
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

from verification.cli.output import columns, emit

if TYPE_CHECKING:
    from verification.multilevel.ensemble import Ensemble
    from verification.sweep.study import Study


def found(options: argparse.Namespace, study: Study, store: Path, **sweep: Any) -> Ensemble:
    """Run an ensemble to its target; ``sweep`` are options of `verification.sweep.engine.sweep`."""
    from refimpl.errors import InputError
    from verification.multilevel.ensemble import ensemble

    if options.csv is not None or options.parquet is not None:
        raise InputError(
            "--target-error", options.target_error, "no --csv or --parquet beside it: use --json"
        )
    return ensemble(study, store, options.target_error, **sweep)


def reported(options: argparse.Namespace, found: Ensemble) -> int:
    """Print and write what was found; status 1 when a run failed or the target was not met."""
    from verification.framework.provenance import provenance

    document = {**asdict(found), "cost": found.cost if found.means else None, "provenance": provenance()}
    emit(document, options.json, table(found))
    return 0 if found.met else 1


def table(found: Ensemble) -> str:
    """Means with their errors, what was solved on each grid; or why there is none."""
    failed = [f"failed: {text}" for text in sorted(set(found.failures.values()))]
    if not found.means:
        return "\n".join(failed)
    rows = [["mean", "value", "standard error", "95 % interval", "cost over plain sampling"]]
    for name, e in found.means.items():
        error, half_width = (f"{x / abs(e.mean):.2%}" if x else "0" for x in (e.standard_error, e.half_width))
        plain = found.plain[name]
        share = f"{found.cost / plain:.0%}" if plain else "nothing scatters"
        rows.append([name, f"{e.mean:.6g}", error, f"+- {half_width}", share])
    terms = [["grid", "realisations", "processor time of one (s)"]]
    for grid, number, seconds in zip(found.grids, found.samples, found.seconds, strict=True):
        terms.append([str(grid), str(number), f"{seconds:.3g}"] if number else [str(grid), "dropped", "-"])
    end = f"\nfinding out what to drop took {found.dropped:.3g} s" if found.dropped else ""
    end += "" if found.met else "\nthe target was not met"
    return f"{columns(rows)}\n\n{columns(terms)}{end}"
