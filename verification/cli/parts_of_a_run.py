"""Result files that hold some cases of the full tier, cut from one run of all of them.

`rough-friction remake --from RUN.json`: many of the committed files are made by `verify --tier full` with
patterns of cases. A whole run has solved them all, with one revision of the code.
"""

from __future__ import annotations

import shlex
from collections.abc import Iterator, Mapping, Sequence
from fnmatch import fnmatchcase
from itertools import pairwise
from pathlib import Path
from typing import Any

from refimpl.errors import InputError
from reports.result_files import read_result
from verification.cli.verify import SELF_TEST
from verification.framework.case import Status
from verification.framework.runner import FORMAT


def read_run(path: Path) -> Mapping[str, Any]:
    """Return the document of a whole run of the full tier; raises InputError for any other file."""
    allowed = "the result file of `rough-friction verify --tier full --json FILE`, all cases"
    try:
        document = read_result(path)
    except (OSError, ValueError) as unreadable:
        raise InputError("--from", str(path), f"{allowed} ({unreadable})") from unreadable
    if not isinstance(document, dict) or document.get("format") != FORMAT:
        raise InputError("--from", str(path), allowed)
    if document["tier"] != "full" or document["only"]:
        raise InputError("--from", str(path), f"{allowed}; this one holds some")
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


def part(document: Mapping[str, Any], tier: str, only: Sequence[str]) -> dict[str, Any]:
    """Return the cases of a whole run that a tier and patterns select, as the file of their own run.

    Its seconds are the sum over its cases.
    """
    cases = [
        each
        for each in document["cases"]
        if (tier == "full" or each["tier"] == tier)
        and (not only or any(fnmatchcase(each["id"], pattern) for pattern in only))
    ]
    ids = {each["id"] for each in cases}
    counts = {status.value: sum(each["status"] == status for each in cases) for status in Status}
    return {
        **document,
        "tier": tier,
        "only": list(only),
        "counts": counts,
        "seconds": round(sum(each["seconds"] for each in cases), 3),
        "cases": cases,
        "errata": [each for each in document["errata"] if each["case"] in ids],
    }


def parts(document: Mapping[str, Any], commands: Mapping[str, str]) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield the name and the document of each file whose command selects cases of the run."""
    for name, command in commands.items():
        if (found := patterns_of(command)) is not None:
            yield name, part(document, *found)
