"""The campaign of random faults against the covering design.

``python -m verification.contestants.campaign --log FILE --json FILE`` resumes from its log. A fault stops at
the first problem that it fails. A problem outside its condition gets the right answer, so that only the
others are solved. Problems that the compact solver does not solve when right are not counted.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Iterable, Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any

from refimpl.grid import Array
from reports.result_files import write_result
from verification.contestants import compact, referee
from verification.contestants.design import in_turn, posed, rows
from verification.contestants.fault_error import CLAIM, error
from verification.contestants.protocol import ContactProblem
from verification.contestants.random_faults import COUNTED, SEEDS, RandomFault, random_fault
from verification.framework.provenance import provenance

FIRST = ("plain", "sliding", "oblong")
"""Designs that were fixed before any fault beyond the first 51 was judged."""
TRIED = (*FIRST, "tiny", "triples", "memory")
"""Designs of the campaign: all but those of large grids, and those with a hardness."""
GOAL = 0.95
Record = dict[str, Any]


@cache
def problems(design: str) -> tuple[tuple[str, ContactProblem], ...]:
    """Slugs and problems of a design, in the order of the suite; those in turn with a letter."""
    return tuple(
        (f"design-{design}-{number:02}{letter if design == 'memory' else ''}", posed(row, number, CLAIM))
        for number, base in enumerate(rows()[design], start=1)
        for letter, row in zip("abc", in_turn(base), strict=False)
    )


@cache
def right(slug: str) -> compact.Solved | None:
    """The compact solver's solution without a fault; None where it does not meet the claim."""
    problem = dict(problems(_design(slug)))[slug]
    if compact.solve.abilities.lacking(problem):
        return None
    found = compact.solve.solved(problem)
    return found if found.converged and residual(problem, found.pressure) <= CLAIM else None


def _design(slug: str) -> str:
    return slug.removeprefix("design-").rpartition("-")[0]


def residual(problem: ContactProblem, pressure: Array) -> float:
    """The worst recomputed residual; infinite where there is none."""
    try:
        return referee.residual(problem, pressure).worst
    except ValueError:
        return float("inf")


def fails(solver: compact.Compact, slug: str, problem: ContactProblem) -> bool:
    """Return whether a faulty solver misses its claim in a problem that the right one solves."""
    exact = right(slug)
    if exact is None or solver.changes_nothing(problem, exact):
        return False
    return not residual(problem, solver.solved(problem).pressure) <= 1.01 * CLAIM


def caught(fault: RandomFault, designs: Iterable[str]) -> str | None:
    """Slug of the first problem of the designs that a fault fails, or None.

    Problems are posed small ones first; to a memory in the order of the suite.
    """
    solver = fault.fresh()
    posed_ = [item for design in designs for item in problems(design)]
    if solver.hooks.key is None:
        posed_ = sorted((item for item in posed_ if fault.when(item[1])), key=lambda item: item[1].gap.size)
    return next((slug for slug, problem in posed_ if fails(solver, slug, problem)), None)


def judged(seed: int, known: Mapping[str, Any]) -> Record:
    """Return the record of a fault: its error, what catches it, and the designs that it was put to.

    ``known`` is an earlier record, or empty; only designs that it does not name are put to a survivor.
    """
    fault, record = random_fault(seed), dict(known)
    if not record:
        found = error(fault)
        record = {"seed": seed, "effect": fault.effect, "condition": fault.condition}
        record |= {"error": found.peak, "claims": found.claims, "caught": None, "designs": []}
    for design in TRIED:
        if record["caught"] is None and design not in record["designs"]:
            record["caught"] = caught(fault, [design])
            record["designs"] = [*record["designs"], design]
    return record


def run(seeds: Iterable[int], log: Path) -> list[Record]:
    """Judge the faults that the log (JSON lines) does not hold whole, memories last; return all records."""
    lines = log.read_text(encoding="utf-8").splitlines() if log.exists() else []
    known = {record["seed"]: record for record in map(json.loads, lines)}
    order = list(seeds)
    for seed in sorted(order, key=lambda seed: random_fault(seed).fresh().hooks.key is not None):
        before = known.get(seed, {})
        known[seed] = judged(seed, before)
        if known[seed] != before:
            with log.open("a", encoding="utf-8") as file:
                file.write(json.dumps(known[seed]) + "\n")
            print(known[seed], file=sys.stderr, flush=True)
    return [known[seed] for seed in order]


def summary(records: Sequence[Record]) -> Record:
    """Counts of faults above `COUNTED`, of those caught, at first as well, and the survivors with all others.

    ``first``: caught by a problem of `FIRST`, of the faults that were judged with them unchanged.
    """
    counted = [r for r in records if r["error"] > COUNTED]
    found = [r for r in counted if r["caught"] is not None]
    first = [r for r in found if _design(r["caught"]) in FIRST]
    missed = [r for r in counted if r["caught"] is None]
    lesser = [r for r in records if r["error"] <= COUNTED]
    return {
        "faults": len(records),
        "counted": len(counted),
        "caught": len(found),
        "caught_first": len(first),
        "share": round(len(found) / len(counted), 4) if counted else None,
        "lesser": len(lesser),
        "lesser_caught": sum(r["caught"] is not None for r in lesser),
        "survivors": [_told(r) for r in missed],
        "lesser_survivors": [_told(r) for r in lesser if r["caught"] is None],
    }


def _told(record: Record) -> Record:
    kept = {name: record[name] for name in ("seed", "effect", "condition")}
    return kept | {name: float(f"{record[name]:.2g}") for name in ("error", "claims")}


def main() -> int:
    """Run, with a line a fault on stderr; status 1 below the goal."""
    parser = argparse.ArgumentParser(prog="python -m verification.contestants.campaign", description=__doc__)
    parser.add_argument("--log", type=Path, required=True, help="JSON lines: every fault; resumed from")
    parser.add_argument("--json", type=Path, help="result to write")
    parser.add_argument("--seeds", type=int, default=len(SEEDS), help="only the first so many")
    options = parser.parse_args()
    found = summary(run(list(SEEDS)[: options.seeds], options.log))
    if options.json:
        write_result(found | {"provenance": provenance()}, options.json)
    print(json.dumps(found, indent=1))
    return 0 if found["share"] is not None and found["share"] >= GOAL else 1


if __name__ == "__main__":
    sys.exit(main())
