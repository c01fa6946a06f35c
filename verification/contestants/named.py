"""Every fault of the table against the covering designs: is it caught, and is its dimension named?

``python -m verification.contestants.named --log FILE --json FILE`` resumes from its log, which has the
problems that each fault fails. Each fault is put to all problems of up to 64 elements a side that the compact
solver solves when right. Those of large grids are put to larger problems as well.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Collection, Iterable, Sequence
from pathlib import Path

from reports.result_files import write_result
from verification.contestants.fault_log import Record, resumed
from verification.contestants.short_list import short_list
from verification.contestants.table_faults import TABLE
from verification.contestants.trial import verdicts
from verification.framework.code_digest import code_digest
from verification.framework.provenance import provenance

JUDGING = ("verification.contestants.table_faults", "verification.contestants.trial")
"""Modules that decide which problems a fault fails; the short list is made anew at each run."""


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
    """Return the slugs of the problems that a fault is put to, and of those that it fails."""
    fault = TABLE[name]
    found = verdicts(fault.fresh(), fault.largest)
    print(f"{name}: {sum(found.values())} of {len(found)} problems failed", file=sys.stderr, flush=True)
    return {"problems": [*found], "failed": [slug for slug in found if found[slug]]}


def judged(name: str, problems: Sequence[str], failed: Collection[str]) -> Record:
    """Return the numbers of problems judged and failed, the short list, and whether it names the fault."""
    listed = short_list({slug: slug in failed for slug in problems})
    return {
        "fault": name,
        "hole": TABLE[name].hole,
        "judged": len(problems),
        "failed": len(failed),
        "listed": listed,
        "named": named(listed, TABLE[name].dimensions),
    }


def run(names: Iterable[str], log: Path) -> list[Record]:
    """Return the records of faults by name; those that the log has of the same code are not tried again."""
    records = resumed(log, names, tried, code_digest(*JUDGING))
    return [judged(each["fault"], each["problems"], each["failed"]) for each in records]


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
