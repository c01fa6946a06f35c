"""The campaign of random faults against the covering design.

``python -m verification.contestants.campaign --log FILE --json FILE`` resumes from its log. A fault stops at
the first problem that it fails. A problem outside its condition gets the right answer, so that only the
others are solved. Problems that the compact solver does not solve when right are not counted.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Iterable, Sequence
from pathlib import Path

from reports.result_files import write_result
from verification.contestants.fault_error import error
from verification.contestants.fault_log import Record, resumed
from verification.contestants.random_faults import COUNTED, SEEDS, random_fault
from verification.contestants.trial import FIRST, TRIED, design_of, first_failure
from verification.framework.code_digest import code_digest
from verification.framework.provenance import provenance

GOAL = 0.95
"""Share of the counted faults that are to be caught."""


def judged(seed: int) -> Record:
    """Return the record of a random fault: its error, and the first problem that catches it, or None."""
    fault = random_fault(seed)
    found = error(fault)
    caught = filter(None, (first_failure(fault.fresh(), fault.when, design) for design in TRIED))
    record = {
        "effect": fault.effect,
        "condition": fault.condition,
        "error": found.peak,
        "claims": found.claims,
        "caught": next(caught, None),
    }
    print({"seed": seed} | record, file=sys.stderr, flush=True)
    return record


def run(seeds: Iterable[int], log: Path) -> list[Record]:
    """Judge the faults that the log does not have of the same code, memories last; return all records."""
    order = list(seeds)
    memories_last = sorted(order, key=lambda seed: random_fault(seed).fresh().hooks.key is not None)
    records = resumed(log, memories_last, judged, code_digest("verification.contestants.campaign"))
    found = {record["fault"]: record for record in records}
    return [found[seed] for seed in order]


def summary(records: Sequence[Record]) -> Record:
    """Counts of faults above `COUNTED`, of those caught, at first as well, and the survivors with all others.

    ``first``: caught by a problem of `FIRST`, of the faults that were judged with them unchanged.
    """
    counted = [r for r in records if r["error"] > COUNTED]
    found = [r for r in counted if r["caught"] is not None]
    first = [r for r in found if design_of(r["caught"]) in FIRST]
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
    kept = {"seed": record["fault"], "effect": record["effect"], "condition": record["condition"]}
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
