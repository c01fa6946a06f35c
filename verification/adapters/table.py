"""The cross-code table: ``python -m verification.adapters.table --json FILE``.

Every installed peer and our own solvers go through the suite of `verification.contestants`. For each case:
the verdict, the error, the seconds in the solver alone, and the worst residual recomputed from the pressures
of all problems that the case posed.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from refimpl.grid import Array
from verification.adapters import aspher, contactmechanics, tamaas, traps
from verification.adapters.peer import Peer
from verification.contestants import own, referee
from verification.contestants.protocol import Abilities, Answer, ContactProblem, abilities_of
from verification.contestants.suite import suite
from verification.framework.case import Result, Status, jsonable
from verification.framework.files import Progress, write_result
from verification.framework.provenance import provenance

Solver = Peer | own.Own
ENTRANTS: dict[str, Solver] = {
    "refimpl": own.solve,
    "refimpl, dense": own.dense,
    "Tamaas": tamaas.solve,
    "ContactMechanics": contactmechanics.solve,
    "ASPHER": aspher.solve,
    "Tamaas, registered only": traps.registered_only,
    "ContactMechanics, no mean stiffness": traps.no_mean_stiffness,
}
OURS = {"refimpl": "nested FFT solver, its defaults", "refimpl, dense": "dense matrices, active sets"}
TRAPS = ("Tamaas, registered only", "ContactMechanics, no mean stiffness")


@dataclass
class Watched:
    """A contestant whose seconds and recomputed residuals are noted, problem by problem."""

    solver: Solver
    seconds: list[float] = field(default_factory=list)
    residuals: list[float] = field(default_factory=list)

    @property
    def abilities(self) -> Abilities:
        """Those of the solver."""
        return abilities_of(self.solver)

    def __call__(self, problem: ContactProblem) -> Answer:
        """The solver's answer, unchanged."""
        start = time.perf_counter()
        answer = self.solver(problem)
        self.seconds.append(time.perf_counter() - start)
        self.residuals.append(recomputed(problem, np.asarray(answer.pressure, dtype=np.float64)))
        return answer


def recomputed(problem: ContactProblem, pressure: Array) -> float:
    """The worst residual by the referee; NaN where it has none to give (too large, or no elastic energy)."""
    if pressure.shape != problem.gap.shape or (referee.is_large(problem) and not problem.periodic):
        return float("nan")
    try:
        return referee.residual(problem, pressure).worst
    except ValueError:
        return float("nan")


def measured() -> dict[str, object]:
    """The whole table, ready for JSON."""
    progress = Progress(len(ENTRANTS))
    entrants = []
    for name, solver in ENTRANTS.items():
        entrants.append(_entrant(name, solver))
        progress.tick(name)
    progress.close()
    cases = [{"id": f"contestant/{c.slug}", "title": c.title, "metric": c.metric} for c in suite()]
    return {"provenance": provenance(), "cases": cases, "entrants": entrants}


def _entrant(name: str, solver: Solver) -> dict[str, object]:
    ours = isinstance(solver, own.Own)
    head: dict[str, object] = {
        "name": name,
        "version": solver.version,
        "setup": OURS[name] if isinstance(solver, own.Own) else solver.setup,
        "role": "ours" if ours else "trap" if name in TRAPS else "peer",
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
        "results": rows,
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
