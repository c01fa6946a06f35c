"""`rough-friction identify`: tau and beta from measured friction, with their uncertainty in parts."""

from __future__ import annotations

import argparse
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING

from verification.cli.options import (
    DEFAULT_GRID,
    SCENE,
    Options,
    loads,
    names,
    option,
    output_file,
    picture,
)
from verification.cli.output import check_outputs, emit, files_of
from verification.output.files import StatusLine
from verification.output.text_table import columns, wrapped

if TYPE_CHECKING:
    from refimpl.identification import Identification, Interval

EPILOG = """examples:
  rough-friction identify pair.toml friction.csv
  rough-friction identify pair.toml friction.csv --loads 5,80 --plot fit.png --json fit.json
  rough-friction identify pair.toml friction.csv --store fit.json
  rough-friction identify pair.toml friction.csv --fit hardness

DATA.csv has the columns load,mu,u_mu or load,friction_force,u_friction_force: N, and standard
uncertainties (68 %). Optional columns: sliding_direction (rad), sliding_offset (m), upper_file,
lower_file (measured surfaces, relative to the table). The scene's friction is the first guess, its
load is not used, its [tolerances] add to the uncertainty. With --store a stopped fit goes on.
"""

OPTIONS: Options = {
    "scene": SCENE,
    "data": option("the measured friction", metavar="DATA.csv", type=Path),
    "--grid": option(f"elements along the longer side ({DEFAULT_GRID})", metavar="M", type=int),
    "--loads": option("loads (N) at which mu is predicted", metavar="P,P,...", type=loads, default=()),
    "--fit": option("fit the hardness as well", metavar="NAME,...", type=names, default=()),
    "--realisations": option("draws of random surfaces (default 1)", metavar="N", type=int, default=1),
    "--store": option("keep finished solves there, and go on", metavar="FILE.json", type=output_file),
    "--plot": option("draw data, fit, ellipse and residuals", metavar="FILE.png", type=picture),
}


def run(options: argparse.Namespace) -> int:
    """Read, fit and show. Raises InputError and ArithmeticError as `refimpl.identification.identify` does."""
    from refimpl.identification import identify, read_rows
    from refimpl.scene.scene_file import read_scene, read_tolerances
    from verification.cli.identify_store import SolveStore, key
    from verification.output.provenance import provenance

    scene, tolerances = read_scene(options.scene), read_tolerances(options.scene)
    inputs = [Path(options.scene), options.data, *files_of(scene)]
    check_outputs(inputs, store=options.store, plot=options.plot, json=options.json)
    rows = read_rows(options.data)
    store = None if options.store is None else SolveStore(options.store)
    with StatusLine() as line:
        found = identify(
            scene,
            rows,
            options.grid,
            loads=options.loads,
            fit=options.fit,
            tolerances=tolerances,
            realisations=options.realisations,
            memory=store,
            key=key,
            report=line.show,
        )
    if options.plot is not None:
        from verification.cli.plot_curves import draw_identification

        draw_identification(found, options.plot)
    emit(document(found) | {"provenance": provenance()}, options.json, table(found))
    return 0


def document(found: Identification) -> dict[str, object]:
    """Return SI units; intervals of 95 %, shares as standard uncertainties; None for what is unbounded."""
    intervals = {name: asdict(one) for name, one in found.values.items()}
    dropped, further = found.fitted.dropped, None
    if (proposal := found.proposal) is not None:
        further = {"loads": proposal.loads, "tau": proposal.widths[0], "beta": proposal.widths[1]}
    return {
        "tau": intervals.pop("tau"),
        "beta": intervals.pop("beta"),
        "fitted": intervals,
        "covariance": found.covariance.tolist(),
        "identified": found.is_identified,
        "method": found.method,
        "shares": {name: dict(zip(found.values, part, strict=True)) for name, part in found.shares.items()},
        "combination": {"factor": found.factor, **asdict(found.combination)},
        "predictions": [{"load": p.load, **asdict(p.mu)} for p in found.predictions],
        "residuals": found.residuals,
        "deleted_residuals": found.deleted,
        "outliers": [
            {"row": k + 1, "load": found.rows[k].load, "deviation": found.deleted[k], "dropped": k == dropped}
            for k in found.outliers
        ],
        "chi_square": found.chi_square,
        "degrees_of_freedom": found.degrees,
        "probability": found.probability,
        "laws": [{"law": law.pop("name"), **law} for law in map(asdict, found.laws)],
        "further_loads": further,
        "warnings": found.warnings,
        "solves": found.solves,
        "passes": found.passes,
    }


def _cells(interval: Interval, unit: float = 1.0) -> list[str]:
    value, low, high = (f"{end / unit:.4g}" for end in (interval.value, interval.low, interval.high))
    return [value, f"{low} to {high}"]


def table(found: Identification) -> str:
    """Return the values, parts of their uncertainty, rows, laws and warnings."""
    from refimpl.identification.result import MEGA, scaled

    scales = {name: scaled(name) for name in found.values}
    values = [["", "value", "95 % interval"]]
    values += [[label, *_cells(found.values[name], unit)] for name, (label, unit) in scales.items()]
    values.append([f"{found.factor * MEGA:.3g} tau/MPa + beta", *_cells(found.combination)])
    parts = [["standard uncertainty", *(label for label, _ in scales.values())]]
    for name, part in found.shares.items():
        parts.append([name, *(f"{u / unit:.2g}" for u, (_, unit) in zip(part, scales.values(), strict=True))])
    rows = [["load (N)", "mu measured", "mu of the model", "95 % interval", "residual / u"]]
    for k, prediction in enumerate(found.predictions):
        is_row = k < len(found.rows)
        measured = f"{found.rows[k].mu:.4g}" if is_row else "-"
        residual = f"{found.residuals[k]:+.1f}" if is_row else "-"
        rows.append([f"{prediction.load:.4g}", measured, *_cells(prediction.mu), residual])
    laws = [["law", "chi-square", "AIC", "BIC"]]
    laws += [[one.name, f"{one.chi_square:.3g}", f"{one.aic:.3g}", f"{one.bic:.3g}"] for one in found.laws]
    ended = (
        f"chi-square {found.chi_square:.3g} of {found.degrees} degrees of freedom "
        f"(probability {found.probability:.2g}); intervals by {found.method}; "
        f"{found.solves} solves, {found.passes} passes"
    )
    blocks = [columns(values), columns(parts), columns(rows), wrapped(ended, "  "), columns(laws)]
    return "\n\n".join(blocks + [wrapped(text, "warning: ") for text in found.warnings])
