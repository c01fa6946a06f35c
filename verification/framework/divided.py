"""``python -m verification.framework.divided FULL.json``: divide a run of the full tier by result file.

Each row of reports/results/README.md that states a command of cases takes the cases that its patterns select.
"""

from __future__ import annotations

import re
import shlex
import sys
from collections import Counter
from collections.abc import Sequence
from fnmatch import fnmatchcase
from itertools import pairwise
from pathlib import Path
from typing import Any

from verification.framework.case import Status
from verification.output.result_files import FOLDER, SUFFIX, read_result, write_result

_ROW = re.compile(r"\| `(\w+)\.json` \| `rough-friction verify ([^`]*)FILE` \|")
_FULL = re.compile(r"\|.*verify.*--tier\W+full")


def patterns(page: str) -> dict[str, list[str]]:
    """Return the patterns of ids by result file, of the rows that select cases of the full tier.

    Raises ValueError for a row of another form, or a file with two.
    """
    found: dict[str, list[str]] = {}
    for line in filter(_FULL.match, page.splitlines()):
        row = _ROW.match(line)
        if row is None or row[1] in found:
            raise ValueError(f"expected one row a file, of the form of the others: {line[:100]}")
        words = pairwise(shlex.split(row[2]))
        found[row[1]] = [pattern for option, pattern in words if option == "--only"]
    return found


def part(run: dict[str, Any], globs: list[str]) -> dict[str, Any]:
    """Return the result file of the cases that the globs select; LookupError for a glob without a case."""
    ids = [case["id"] for case in run["cases"]]
    empty = [glob for glob in globs if not any(fnmatchcase(id, glob) for id in ids)]
    if empty or not globs:
        raise LookupError(f"the run has no case of {empty or 'a row without --only'}")
    cases = [case for case in run["cases"] if any(fnmatchcase(case["id"], glob) for glob in globs)]
    found = [case["status"] for case in cases]
    return {
        **run,
        "only": globs,
        "counts": {status.value: found.count(status.value) for status in Status},
        "seconds": round(sum(case["seconds"] for case in cases), 3),
        "cases": cases,
        "errata": [one for one in run["errata"] if one["case"] in {case["id"] for case in cases}],
    }


def parts(run: dict[str, Any], rows: dict[str, list[str]]) -> dict[str, dict[str, Any]]:
    """Return all result files by name.

    Raises ValueError unless the run is all of the full tier, or where two files have a case.
    """
    if run["tier"] != "full" or run["only"]:
        raise ValueError(f"expected all of the full tier: tier {run['tier']}, only {run['only']}")
    found = {name: part(run, globs) for name, globs in rows.items()}
    files = Counter(case["id"] for one in found.values() for case in one["cases"])
    twice = [id for id, number in files.items() if number > 1]
    if twice:
        raise ValueError(f"cases in two files: {', '.join(twice)}")
    return found


def main(arguments: Sequence[str] | None = None) -> None:
    """Write the result files of the named run, once all of them are there."""
    (path,) = sys.argv[1:] if arguments is None else arguments
    rows = patterns((FOLDER / "README.md").read_text(encoding="utf-8"))
    for name, document in parts(read_result(Path(path)), rows).items():
        write_result(document, FOLDER / f"{name}{SUFFIX}")


if __name__ == "__main__":
    main()
