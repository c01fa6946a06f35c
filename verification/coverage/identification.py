"""Coverage of `refimpl.identification` on `synthetic_tables`, whose tau and beta are known.

`python -m verification.coverage.identification --json FILE` fits every set of tables; `--log` keeps finished
fits, and the study goes on where it was. The result file calls the tables twins.

The three fits of a table share the noise of its rows, so few tables show a coverage poorly: a noise of 2.2
standard uncertainties makes all three miss. An estimate is linear in the rows, ``theta = g + G n`` for their
noise n: so its coverage over all noise follows from one fit, and that is what grid and other errors leave.
"""

from __future__ import annotations

import argparse
import json
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from scipy.stats import norm

from refimpl.errors import InputError
from refimpl.identification import Identification, identify
from refimpl.identification.forward import COVERAGE
from verification.coverage.building import records
from verification.coverage.synthetic_tables import (
    ROUGHNESS_TOLERANCE,
    SyntheticTable,
    drawn_table,
    ensemble_table,
    sharp_table,
    without_friction,
    yielding_table,
)
from verification.framework.case import jsonable
from verification.output.files import Progress
from verification.output.provenance import provenance
from verification.output.result_files import write_result

LEVEL = 0.92  # share of 95 % intervals that must cover, at least
BIAS = 0.2  # mean error of tau in its standard uncertainties, at most
WIDE, NARROW = 0.25, 0.05  # half-widths of tau's interval over tau: above, the warning is due; below, none
DIGITS = 5  # significant, of the numbers in the result file


@dataclass(frozen=True)
class TableSet:
    """A set of tables: its seeds, and the function that makes the table of a seed.

    fit : parameters fitted beside tau and beta; realisations : draws of a surface known by its statistics
    tolerances : relative half-widths (95 %) of inputs, which the tables' scenes are off by
    """

    seeds: range
    make: Callable[[int], SyntheticTable]
    fit: tuple[str, ...] = ()
    realisations: int = 1
    tolerances: Mapping[str, float] = field(default_factory=dict)


SETS: Mapping[str, TableSet] = {
    "drawn": TableSet(range(9900, 10080), drawn_table),
    "sharp": TableSet(range(6000, 6060), sharp_table),
    "hardness": TableSet(range(7000, 7040), yielding_table, ("hardness",)),
    "roughness": TableSet(
        range(8200, 8240),
        ensemble_table,
        realisations=4,
        tolerances={"lower.surface[0].rms": ROUGHNESS_TOLERANCE},
    ),
}


def fitted(tables: TableSet, seed: int) -> dict[str, object]:
    """Return the result of the fit of one table, beside the truth; a refused table holds the message."""
    table = tables.make(seed)
    row: dict[str, object] = {"seed": seed, "kind": table.kind, "grid": table.grid, "error": table.error}
    try:
        found = _identified(tables, table)
    except InputError as refused:
        return row | {"refused": str(refused)}
    tau, beta, mu = found.values["tau"], found.values["beta"], found.predictions[-1].mu
    truth = table.scene.friction
    row |= {
        "noise": table.noise,
        "tau": tau.low <= truth.tau <= tau.high,
        "beta": beta.low <= truth.beta <= beta.high,
        "mu": mu.low <= table.new_mu <= mu.high,
        "tau_half_width": tau.relative if math.isfinite(tau.relative) else None,
        "tau_error": tau.value / truth.tau - 1,
        "tau_deviation": float((tau.value - truth.tau) / math.sqrt(found.covariance[0, 0])),
        "named": table.wrong in found.outliers,
        "named_wrongly": len(set(found.outliers) - {table.wrong}),
        "dropped": None if found.fitted.dropped is None else found.fitted.dropped == table.wrong,
        "warned": any("not determined apart" in text for text in found.warnings),
    }
    if tables.realisations == 1:
        row |= _over_noise(table, found)
    if table.further is not None:  # the parameter fitted beside tau and beta
        one = list(found.values.values())[-1]
        row["further"] = one.low <= table.further <= one.high
        row["further_half_width"] = 0.5 * (one.high - one.low) / one.value
    return row


def _over_noise(table: SyntheticTable, found: Identification) -> dict[str, float]:
    """Return the coverage of tau and beta over the noise of all rows, and tau's deviation without noise."""
    truth, u = table.scene.friction, np.sqrt(np.diag(found.covariance))[:2]
    noise = np.array(table.deviates) * [row.u_mu for row in table.rows]
    without = (found.fitted.free - found.fitted.gain @ noise)[:2] - (truth.tau, truth.beta)
    measured = np.array(found.shares["measurement"])[:2]
    ends = [norm.cdf((end * u - without) / measured) for end in (-COVERAGE, COVERAGE)]
    tau, beta = map(float, ends[1] - ends[0])
    return {"tau_over_noise": tau, "beta_over_noise": beta, "tau_without_noise": float(without[0] / u[0])}


def _identified(tables: TableSet, table: SyntheticTable) -> Identification:
    return identify(
        without_friction(table.scene),
        table.rows,
        table.grid,
        loads=(table.new_load,),
        fit=tables.fit,
        realisations=tables.realisations,
        tolerances=tables.tolerances,
        design=False,
    )


def summary(tables: Iterable[Mapping[str, Any]]) -> dict[str, Any]:
    """Return coverages by number, kind, grid and error, and whether warnings stand where they should.

    The warning follows from the width of tau's interval. ``unwarned_tau_error``, the largest error of tau
    among tables without a warning, is independent of it. ``bias`` is tau's mean error in standard
    uncertainties, ``bias_without_noise`` that without the rows' noise.
    """
    rows = list(tables)
    solved = [row for row in rows if "tau" in row]
    further = "further", "tau_over_noise", "beta_over_noise"
    names = ["tau", "beta", "mu"] + [name for name in further if any(name in row for row in solved)]

    def coverage(chosen: Sequence[Mapping[str, Any]]) -> dict[str, float]:
        return {name: sum(row[name] for row in chosen) / len(chosen) if chosen else 0.0 for name in names}

    def by(key: str) -> dict[str, dict[str, float]]:
        groups = sorted({row[key] for row in solved})
        return {str(group): coverage([row for row in solved if row[key] == group]) for group in groups}

    half_widths = [(row["tau_half_width"], row["warned"]) for row in solved]
    widths = [(math.inf if width is None else width, warned) for width, warned in half_widths]
    unwarned = [abs(row["tau_error"]) for row in solved if not row["warned"]]
    without = [row["tau_without_noise"] for row in solved if "tau_without_noise" in row]
    wrong = [row for row in solved if row["error"] in ("outlier", "unit slip")]
    return {
        "twins": len(rows),
        "failures": sum("failure" in row for row in rows),
        "refused": sum("refused" in row for row in rows),
        "coverage": coverage(solved),
        "by_kind": by("kind"),
        "by_grid": by("grid"),
        "by_error": by("error"),
        "bias": float(np.mean([row["tau_deviation"] for row in solved])),
        "bias_without_noise": float(np.mean(without)) if without else None,
        "with_wrong_row": len(wrong),
        "wrong_row_named": sum(row["named"] for row in wrong),
        "rows_named_wrongly": sum(row["named_wrongly"] for row in solved),
        "rows_dropped_wrongly": sum(row["dropped"] is False for row in solved),
        "wide": sum(width > WIDE for width, _ in widths),
        "wide_without_warning": sum(width > WIDE and not warned for width, warned in widths),
        "narrow": sum(width < NARROW for width, _ in widths),
        "narrow_with_warning": sum(width < NARROW and warned for width, warned in widths),
        "warned": sum(warned for _, warned in widths),
        "unwarned_tau_error": max(unwarned, default=None),
    }


def study(
    tables: TableSet, log: Path | None = None, seeds: Iterable[int] | None = None
) -> list[dict[str, object]]:
    """Return fits of all seeds, or others, or the message of one without a solve; ``log`` keeps them."""
    seeds = list(tables.seeds if seeds is None else seeds)
    found = [row for row in records(log) if row["seed"] in seeds] if log else []
    line = Progress(len(seeds) - len(found))
    for seed in sorted(set(seeds) - {row["seed"] for row in found}):
        try:
            found.append(fitted(tables, seed))
        except ArithmeticError as failure:
            found.append({"seed": seed, "failure": str(failure)})
        if log is not None:
            with log.open("a", encoding="utf-8") as file:
                file.write(json.dumps(jsonable(found[-1])) + "\n")
        line.tick(f"table {seed}")
    line.close()
    return found


def shortened(row: Mapping[str, object]) -> dict[str, object]:
    """Return a fit with its numbers to five digits.

    >>> shortened({"noise": 0.0123456789, "tau": True})
    {'noise': 0.012346, 'tau': True}
    """
    return {
        name: float(f"{value:.{DIGITS}g}") if isinstance(value, float) else value
        for name, value in row.items()
    }


def main() -> None:
    """Run the study and write it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", type=Path, required=True)
    parser.add_argument("--sets", nargs="+", choices=SETS, default=list(SETS), help="default: all")
    parser.add_argument("--log", type=Path, help="finished fits, to go on from")
    options = parser.parse_args()
    document: dict[str, object] = {}
    for name in options.sets:
        fits = study(SETS[name], options.log)
        document[name] = {"summary": summary(fits), "twins": [shortened(row) for row in fits]}
        print(name, summary(fits))
    write_result(document | {"provenance": provenance()}, options.json)


if __name__ == "__main__":
    main()
