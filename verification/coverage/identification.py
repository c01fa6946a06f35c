"""Coverage of `refimpl.identification` on twins with known tau and beta (`verification.coverage.twins`).

`python -m verification.coverage.identification --json FILE` runs every set of twins; `--log` keeps finished
twins, and the study goes on where it was.
"""

from __future__ import annotations

import argparse
import json
import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from refimpl.identification import Identification, identify
from verification.coverage.twins import (
    ROUGHNESS_TOLERANCE,
    Twin,
    blind,
    ensemble_twin,
    sharp_twin,
    twin,
    yielding_twin,
)
from verification.framework.case import jsonable
from verification.framework.files import Progress, write_result
from verification.framework.provenance import provenance

LEVEL = 0.92  # share of 95 % intervals that must cover, at least
WIDE, NARROW = 0.25, 0.05  # half-widths of tau's interval over tau: above, the warning is due; below, none
DIGITS = 5  # significant, of the numbers in the result file


@dataclass(frozen=True)
class TwinSet:
    """A set of twins: its seeds, and the function that makes the twin of a seed.

    fit : parameters fitted beside tau and beta; realisations : draws of a surface known by its statistics
    tolerances : relative half-widths (95 %) of inputs, which the twins are off by
    """

    seeds: range
    make: Callable[[int], Twin]
    fit: tuple[str, ...] = ()
    realisations: int = 1
    tolerances: Mapping[str, float] = field(default_factory=dict)


SETS: Mapping[str, TwinSet] = {
    "drawn": TwinSet(range(5000, 5300), twin),
    "sharp": TwinSet(range(6000, 6060), sharp_twin),
    "hardness": TwinSet(range(7000, 7040), yielding_twin, ("hardness",)),
    "roughness": TwinSet(
        range(8200, 8240),
        ensemble_twin,
        realisations=4,
        tolerances={"lower.surface[0].rms": ROUGHNESS_TOLERANCE},
    ),
}


def judged(twins: TwinSet, seed: int) -> dict[str, object]:
    """Return the result of the fit of one twin, beside the truth."""
    case = twins.make(seed)
    found = identify(
        blind(case.scene),
        case.rows,
        case.grid,
        loads=(case.new_load,),
        fit=twins.fit,
        realisations=twins.realisations,
        tolerances=twins.tolerances,
        design=False,
    )
    tau, beta, mu = found.values["tau"], found.values["beta"], found.predictions[-1].mu
    truth = case.scene.friction
    measured = found.shares["measurement"]
    return {
        "seed": seed,
        "kind": case.kind,
        "loads": len(case.rows),
        "noise": case.noise,
        "tau": tau.low <= truth.tau <= tau.high,
        "beta": beta.low <= truth.beta <= beta.high,
        "mu": mu.low <= case.new_mu <= mu.high,
        "tau_half_width": tau.relative if math.isfinite(tau.relative) else None,
        "tau_error": tau.value / truth.tau - 1,
        "beta_error": beta.value / truth.beta - 1,
        "measurement_share": measured[0] / math.sqrt(found.covariance[0, 0]),
        "warned": _warns(found),
        "solves": found.solves,
        **_further(found, case.further),
    }


def _further(found: Identification, truth: float | None) -> dict[str, object]:
    """Error and coverage of the parameter fitted beside tau and beta, if there is one."""
    if truth is None:
        return {}
    one = list(found.values.values())[-1]
    return {
        "further": one.low <= truth <= one.high,
        "further_half_width": 0.5 * (one.high - one.low) / one.value,
        "further_error": one.value / truth - 1,
    }


def _warns(found: Identification) -> bool:
    return any("not determined apart" in text for text in found.warnings)


def summary(twins: Iterable[Mapping[str, object]]) -> dict[str, object]:
    """Return coverages by number and kind, and whether the warning stands where it should.

    The warning follows from the width of tau's interval. ``unwarned_tau_error``, the largest error of tau
    among twins without a warning, is independent of it.
    """
    rows = list(twins)
    solved = [row for row in rows if "failure" not in row]
    kinds = sorted({str(row["kind"]) for row in solved})

    def share(name: str, kind: str | None = None) -> float:
        chosen = [bool(row[name]) for row in solved if kind is None or row["kind"] == kind]
        return float(np.mean(chosen)) if chosen else 0.0

    def number(row: Mapping[str, object], name: str) -> float:
        return math.inf if row[name] is None else float(str(row[name]))

    names = ["tau", "beta", "mu"] + ["further"] * any("further" in row for row in solved)
    widths = [number(row, "tau_half_width") for row in solved]
    warned = [bool(row["warned"]) for row in solved]
    return {
        "twins": len(rows),
        "failures": len(rows) - len(solved),
        "coverage": {name: share(name) for name in names},
        "by_kind": {kind: {name: share(name, kind) for name in names} for kind in kinds},
        "wide": sum(width > WIDE for width in widths),
        "wide_without_warning": sum(w > WIDE and not said for w, said in zip(widths, warned, strict=True)),
        "narrow": sum(width < NARROW for width in widths),
        "narrow_with_warning": sum(w < NARROW and said for w, said in zip(widths, warned, strict=True)),
        "narrow_whole": sum(2 * width < NARROW for width in widths),
        "warned": sum(warned),
        "unwarned_tau_error": max(
            (abs(number(row, "tau_error")) for row, said in zip(solved, warned, strict=True) if not said),
            default=None,
        ),
        "most_solves_per_load": max((number(row, "solves") - 1) / number(row, "loads") for row in solved),
    }


def study(
    twins: TwinSet, log: Path | None = None, seeds: Iterable[int] | None = None
) -> list[dict[str, object]]:
    """Return the twins of all seeds, or of others; one without a converged solve holds its message.

    ``log`` keeps finished twins, a line each: the study goes on where it was.
    """
    seeds = list(twins.seeds if seeds is None else seeds)
    found = [json.loads(line) for line in log.read_text().splitlines()] if log and log.exists() else []
    found = [row for row in found if row["seed"] in seeds]
    line = Progress(len(seeds) - len(found))
    for seed in sorted(set(seeds) - {row["seed"] for row in found}):
        try:
            found.append(judged(twins, seed))
        except ArithmeticError as failure:
            found.append({"seed": seed, "failure": str(failure)})
        if log is not None:
            with log.open("a") as file:
                file.write(json.dumps(jsonable(found[-1])) + "\n")
        line.tick(f"twin {seed}")
    line.close()
    return found


def shortened(row: Mapping[str, object]) -> dict[str, object]:
    """Return a twin with its numbers to five digits.

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
    parser.add_argument("--log", type=Path, help="finished twins, to go on from")
    options = parser.parse_args()
    document: dict[str, object] = {}
    for name in options.sets:
        twins = study(SETS[name], options.log)
        document[name] = {"summary": summary(twins), "twins": [shortened(row) for row in twins]}
        print(name, summary(twins))
    write_result(document | {"provenance": provenance()}, options.json)


if __name__ == "__main__":
    main()
