"""Every fault of the table against the covering designs: is it caught, and is its dimension named?

``python -m verification.contestants.named --log FILE --json FILE`` resumes from its log. Each fault is put to
all problems of up to 64 elements a side that the compact solver solves when right. Those of large grids are
put to problems of up to 176 as well.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from reports.result_files import write_result
from verification.contestants.campaign import TRIED, fails, problems, right
from verification.contestants.short_list import short_list
from verification.contestants.table_faults import TABLE, TableFault
from verification.framework.provenance import provenance

SMALL = 64
"""Most elements a side of the problems that every fault is put to."""
OF_LARGE = "large grids"
Record = dict[str, Any]


def verdicts(fault: TableFault, designs: Iterable[str] = TRIED) -> dict[str, bool]:
    """Return whether each problem of the designs fails, by slug, in the order of the suite."""
    solver = fault.fresh()
    failed: dict[str, bool] = {}
    for design in designs:
        for slug, problem in problems(design):
            if (problem.M > SMALL and fault.hole != OF_LARGE) or right(slug) is None:
                continue
            case = slug.rstrip("abc")
            failed[case] = fails(solver, slug, problem) or failed.get(case, False)
    return failed


def named(listed: Sequence[str], dimensions: Sequence[Sequence[str]]) -> bool:
    """Return whether the list names a dimension of every group.

    >>> named(["beta above 1", "edge below 1e-06"], [["beta"], ["edge", "heights"]])
    True
    """
    text = " and ".join(listed).split(" and ")
    return all(
        any(condition == name or condition.startswith(f"{name} ") for condition in text for name in group)
        for group in dimensions
    )


def tried(name: str) -> Record:
    """Return the record of a fault: problems judged and failed, the short list, and whether it names it."""
    fault = TABLE[name]
    failed = verdicts(fault)
    listed = short_list(failed)
    record = {"fault": name, "hole": fault.hole, "judged": len(failed), "failed": sum(failed.values())}
    return record | {"listed": listed, "named": named(listed, fault.dimensions)}


def run(names: Iterable[str], log: Path) -> list[Record]:
    """Try the faults that the log (JSON lines) does not hold; return the records of all."""
    lines = log.read_text(encoding="utf-8").splitlines() if log.exists() else []
    known = {record["fault"]: record for record in map(json.loads, lines)}
    records = []
    for name in names:
        if name not in known:
            known[name] = tried(name)
            with log.open("a", encoding="utf-8") as file:
                file.write(json.dumps(known[name]) + "\n")
            print(known[name], file=sys.stderr, flush=True)
        records.append(known[name])
    return records


def summary(records: Sequence[Record]) -> Record:
    """Numbers of faults, of those caught and of those named, and the table."""
    return {
        "faults": len(records),
        "caught": sum(r["failed"] > 0 for r in records),
        "named": sum(r["named"] for r in records),
        "table": list(records),
    }


def main() -> int:
    """Run, with a line a fault on stderr; status 1 where one is not caught or not named."""
    parser = argparse.ArgumentParser(prog="python -m verification.contestants.named", description=__doc__)
    parser.add_argument("--log", type=Path, required=True, help="JSON lines: every fault; resumed from")
    parser.add_argument("--json", type=Path, help="result to write")
    options = parser.parse_args()
    found = summary(run(TABLE, options.log))
    if options.json:
        write_result(found | {"provenance": provenance()}, options.json)
    print(json.dumps(found, indent=1))
    return int(not found["faults"] == found["caught"] == found["named"])


if __name__ == "__main__":
    sys.exit(main())
