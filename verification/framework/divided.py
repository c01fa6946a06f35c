"""``python -m verification.framework.divided FULL.json``: divide a run of the full tier by result file.

Each row of reports/results/README.md that states a command of cases takes the cases that its patterns select.
"""

from __future__ import annotations

import re
import shlex
import sys
from collections.abc import Sequence
from fnmatch import fnmatchcase
from itertools import pairwise
from pathlib import Path
from typing import Any

from verification.framework.case import Status
from verification.output.result_files import FOLDER, SUFFIX, read_result, write_result

_ROW = re.compile(r"^\| `(\w+)\.json` \| `rough-friction verify ([^`]*)FILE` \|", re.MULTILINE)


def patterns(page: str) -> dict[str, list[str]]:
    """Return the patterns of ids by result file, of the rows that select cases of the full tier."""
    words = {name: shlex.split(options) for name, options in _ROW.findall(page)}
    return {
        name: [pattern for option, pattern in pairwise(row) if option == "--only"]
        for name, row in words.items()
        if "full" in row
    }


def part(run: dict[str, Any], globs: list[str]) -> dict[str, Any]:
    """Return the result file of the cases that the globs select; LookupError where there are none."""
    cases = [case for case in run["cases"] if any(fnmatchcase(case["id"], glob) for glob in globs)]
    if not cases:
        raise LookupError(f"the run has no case of {globs}")
    found = [case["status"] for case in cases]
    return {
        **run,
        "only": globs,
        "counts": {status.value: found.count(status.value) for status in Status},
        "seconds": round(sum(case["seconds"] for case in cases), 3),
        "cases": cases,
        "errata": [one for one in run["errata"] if one["case"] in {case["id"] for case in cases}],
    }


def main(arguments: Sequence[str] | None = None) -> None:
    """Write the result files of the named run."""
    (path,) = sys.argv[1:] if arguments is None else arguments
    run = read_result(Path(path))
    for name, globs in patterns((FOLDER / "README.md").read_text(encoding="utf-8")).items():
        write_result(part(run, globs), FOLDER / f"{name}{SUFFIX}")


if __name__ == "__main__":
    main()
