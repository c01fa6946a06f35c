"""Committed result files: those cut from one run of the full tier, and the commands of the others.

``python -m verification.cli.results RUN.json``, the second half of ``make results``. Many of the committed
files are made by `verify --tier full` with patterns of cases; a whole run has solved them all, with one
revision of the code. `reports/results/README.md` has the command of each file.
"""

from __future__ import annotations

import argparse
import re
import shlex
from collections.abc import Mapping, Sequence
from fnmatch import fnmatchcase
from itertools import pairwise
from pathlib import Path
from typing import Any

from refimpl.errors import InputError
from reports import results_page
from reports.result_files import FOLDER, SUFFIX, read_result, write_result
from verification.cli.verify import SELF_TEST
from verification.framework.case import Status
from verification.framework.runner import FORMAT
from verification.framework.text_table import columns

_ROW = re.compile(r"^\| `(\w+)\.json` \| `([^`]*\bFILE\b[^`]*)`", flags=re.M)


def main(arguments: Sequence[str] | None = None) -> int:
    """Write the files whose cases the run holds, and list the commands that make the others.

    Returns 1 where a case of a file failed.
    """
    parser = argparse.ArgumentParser(prog="python -m verification.cli.results", description=main.__doc__)
    parser.add_argument("run", metavar="RUN", type=Path, help="what `verify --tier full --json RUN` wrote")
    path = parser.parse_args(arguments).run
    try:
        run = read_run(path)
    except InputError as refused:
        parser.error(str(refused))
    failed, written, others = 0, [], []
    for name, command in commands().items():
        selected = patterns_of(command)
        if selected is None:
            others.append([command.replace("FILE", f"reports/results/{name}{SUFFIX}")])
            continue
        found = cases_of(run, *selected)
        write_result(found, FOLDER / f"{name}{SUFFIX}")
        bad = found["counts"]["fail"] + found["counts"]["error"]
        failed += bad
        written.append([f"{name}.json", f"{len(found['cases'])} cases", f"{bad} did not pass" if bad else ""])
    results_page.main()
    print(f"{columns(written, indent='')}\n\nnot made by cases, by hand from here:\n{columns(others)}")
    return int(failed > 0)


def commands() -> dict[str, str]:
    """Return the first command in each file's row of the results' README, by name without suffix."""
    return dict(_ROW.findall((FOLDER / "README.md").read_text(encoding="utf-8")))


def read_run(path: Path) -> Mapping[str, Any]:
    """Return the document of a whole run of the full tier; raises InputError for any other file."""
    allowed = "the result file of `rough-friction verify --tier full --json FILE`, all cases"
    try:
        document = read_result(path)
    except (OSError, ValueError) as unreadable:
        raise InputError("RUN", str(path), f"{allowed} ({unreadable})") from unreadable
    if not isinstance(document, dict) or document.get("format") != FORMAT:
        raise InputError("RUN", str(path), allowed)
    if document["tier"] != "full" or document["only"]:
        raise InputError("RUN", str(path), f"{allowed}; this one holds some")
    return document


def patterns_of(command: str) -> tuple[str, tuple[str, ...]] | None:
    """Return the tier and the patterns of the cases that a `verify` command runs; None for another command.

    >>> patterns_of("rough-friction verify --tier full --jobs 1 --only 'a/*' --only b/c --json FILE")
    ('full', ('a/*', 'b/c'))
    >>> patterns_of("python -m verification.properties --json FILE")
    """
    words = shlex.split(command)
    if words[:3] == ["rough-friction", "verify", "--self-test"]:
        return "full", (SELF_TEST,)
    if words[:3] != ["rough-friction", "verify", "--tier"]:
        return None
    only = tuple(after for word, after in pairwise(words) if word == "--only")
    return words[3], only


def cases_of(run: Mapping[str, Any], tier: str, only: Sequence[str]) -> dict[str, Any]:
    """Return the cases of a whole run that a tier and patterns select, as the file of their own run.

    Its seconds are the sum over its cases.
    """
    cases = [
        each
        for each in run["cases"]
        if (tier == "full" or each["tier"] == tier)
        and (not only or any(fnmatchcase(each["id"], pattern) for pattern in only))
    ]
    ids = {each["id"] for each in cases}
    counts = {status.value: sum(each["status"] == status for each in cases) for status in Status}
    return {
        **run,
        "tier": tier,
        "only": list(only),
        "counts": counts,
        "seconds": round(sum(each["seconds"] for each in cases), 3),
        "cases": cases,
        "errata": [each for each in run["errata"] if each["case"] in ids],
    }


if __name__ == "__main__":
    raise SystemExit(main())
