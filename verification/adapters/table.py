"""The cross-code table: ``python -m verification.adapters.table --json FILE``.

Every installed peer and our own solvers go through the suite: verdict, error, seconds in the solver alone,
and the worst residual recomputed from the pressures of all problems of a case.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from refimpl.grid import Array
from verification.adapters import aspher, contactmechanics, negative_controls, slippy, tamaas
from verification.adapters.published_code import PublishedCode
from verification.framework.case import Metric, Result, Status, jsonable
from verification.output.files import Progress
from verification.output.provenance import provenance
from verification.output.result_files import write_result
from verification.solver_suite import own, reference_solution
from verification.solver_suite.protocol import Abilities, Answer, ContactProblem, abilities_of
from verification.solver_suite.suite import identity, suite

Solver = PublishedCode | own.Own
ENTRANTS: dict[str, Solver] = {
    "refimpl": own.solve,
    "refimpl, dense": own.dense,
    "Tamaas": tamaas.solve,
    "ContactMechanics": contactmechanics.solve,
    "ASPHER": aspher.solve,
    "SlipPY": slippy.solve,
    "Tamaas, registered only": negative_controls.registered_only,
    "ContactMechanics, no mean stiffness": negative_controls.no_mean_stiffness,
    "SlipPY, its default in free space": slippy.by_default,
}
OURS = {"refimpl": "nested FFT solver, its defaults", "refimpl, dense": "dense matrices, active sets"}
NEGATIVE_CONTROLS = (
    "Tamaas, registered only",
    "ContactMechanics, no mean stiffness",
    "SlipPY, its default in free space",
)
WORST = ("fail", "error", "pass", "unavailable")
"""Of the problems of a covering design the first that occurs is the design's verdict."""


@dataclass
class Watched:
    """A solver under test whose seconds and recomputed residuals are noted, problem by problem."""

    solver: Solver
    seconds: list[float] = field(default_factory=list)
    residuals: list[float] = field(default_factory=list)

    @property
    def abilities(self) -> Abilities:
        """Abilities of the solver."""
        return abilities_of(self.solver)

    def __call__(self, problem: ContactProblem) -> Answer:
        start = time.perf_counter()
        answer = self.solver(problem)
        self.seconds.append(time.perf_counter() - start)
        self.residuals.append(recomputed(problem, np.asarray(answer.pressure, dtype=np.float64)))
        return answer


def recomputed(problem: ContactProblem, pressure: Array) -> float:
    """Return the worst residual recomputed by the suite; NaN without one (too large, or no energy)."""
    too_large = reference_solution.is_large(problem) and not problem.periodic
    if pressure.shape != problem.gap.shape or too_large or reference_solution.stores_no_energy(problem):
        return float("nan")
    try:
        return reference_solution.residual(problem, pressure).worst
    except ValueError:
        return float("nan")


def measured() -> dict[str, object]:
    """Return the whole table, ready for JSON."""
    progress = Progress(len(ENTRANTS))
    entrants = []
    for name, solver in ENTRANTS.items():
        entrants.append(_entrant(name, solver))
        progress.tick(name)
    progress.close()
    cases = [{"id": c.id, "title": c.title, "metric": c.metric} for c in suite() if not _design(c.id)]
    for design in dict.fromkeys(filter(None, (_design(c.id) for c in suite()))):
        title = f"Covering design, {design.rpartition('-')[2]}: all problems"
        cases.append({"id": design, "title": title, "metric": Metric.AT_MOST})
    return {"provenance": provenance(), "suite": identity(), "cases": cases, "entrants": entrants}


def _design(case: str) -> str | None:
    """Return ``solver/design-NAME`` of a problem of a covering design; None of other cases."""
    head, _, number = case.rpartition("-")
    return head if "/design-" in case and number.isdigit() else None


def _entrant(name: str, solver: Solver) -> dict[str, object]:
    ours = isinstance(solver, own.Own)
    head: dict[str, object] = {
        "name": name,
        "version": solver.version,
        "setup": OURS[name] if isinstance(solver, own.Own) else solver.setup,
        "role": "ours" if ours else "trap" if name in NEGATIVE_CONTROLS else "peer",
        "checksum": None if isinstance(solver, own.Own) else solver.checksum,
        "wrong": "" if isinstance(solver, own.Own) or name in NEGATIVE_CONTROLS else solver.wrong,
        "abilities": asdict(solver.abilities),
        "installed": isinstance(solver, own.Own) or solver.installed is not None,
    }
    if not head["installed"]:
        return head
    rows = []
    for check in suite():
        watched = Watched(solver)
        rows.append(_row(check.case(watched).run(), watched))
    counts = {status.value: sum(row["status"] == status for row in rows) for status in Status}
    residuals = [row["residual"] for row in rows if row["residual"] is not None]
    return head | {
        "counts": counts,
        "seconds": sum(row["seconds"] for row in rows),
        "worst residual": max(residuals) if residuals else None,
        "results": [{name: _short(value) for name, value in row.items()} for row in summarised(rows)],
    }


def summarised(rows: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
    """Return the rows of the cases, and one a covering design: its worst error, and what failed."""
    single = [dict(row) for row in rows if _design(row["id"]) is None]
    designs: dict[str, list[Mapping[str, Any]]] = {}
    for row in rows:
        if (design := _design(row["id"])) is not None:
            designs.setdefault(design, []).append(row)
    return single + [_of_design(design, found) for design, found in designs.items()]


def _short(value: Any) -> Any:
    return float(f"{value:.4g}") if isinstance(value, float) else value


def _of_design(design: str, rows: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    def worst(name: str) -> float | None:
        return max((row[name] for row in rows if row[name] is not None), default=None)

    failed = [
        f"{row['status']}: {row['id'].rpartition('-')[2]}" for row in rows if row["status"] in WORST[:2]
    ]
    reasons = list(dict.fromkeys(row["note"] for row in rows if row["status"] == "error"))[:3]
    return {
        "id": design,
        "status": min((row["status"] for row in rows), key=WORST.index),
        "error": worst("error"),
        "tolerance": rows[0]["tolerance"],
        "seconds": sum(row["seconds"] for row in rows),
        "residual": worst("residual"),
        "note": "; ".join([*failed, *reasons]),
    }


def _row(result: Result, watched: Watched) -> dict[str, Any]:
    known = [residual for residual in watched.residuals if np.isfinite(residual)]
    return {
        "id": result.id,
        "status": result.status,
        "error": result.error,
        "tolerance": result.tolerance,
        "seconds": sum(watched.seconds),
        "residual": max(known) if known else None,
        "note": result.note,
    }


def main(arguments: Sequence[str] | None = None) -> None:
    """Measure and write the file."""
    parser = argparse.ArgumentParser(prog="python -m verification.adapters.table", description=__doc__)
    parser.add_argument("--json", type=Path, required=True, help="file to write")
    options = parser.parse_args(arguments)
    write_result(jsonable(measured()), options.json)


if __name__ == "__main__":
    main()
