"""Runs of somebody else's solver through the suite: who it is, and the command that runs one case again."""

from __future__ import annotations

import shlex
from collections.abc import Iterator, Mapping
from typing import Any

ELSEWHERE = ("--only", "--tier", "--jobs", "--json")
"""Options of `verify` that are no part of which solver is run, and how; each has a value."""


def solver(results: Mapping[str, Any]) -> str | None:
    """Name of the solver under test: its MODULE:FUNCTION or command; None for the project's own cases."""
    solver = results.get("solver")
    return None if solver is None else str(solver["name"])


def rerun(command: str, case_id: str) -> str:
    """The command that runs one case with the solver, its abilities and limits as in ``command``.

    >>> rerun("rough-friction verify --solver a:b --only 'x/*' --able load --json y", "solver/pins")
    'rough-friction verify --solver a:b --able load --only solver/pins'
    """
    words = iter(shlex.split(command)[1:])
    return shlex.join(["rough-friction", *_kept(words), "--only", case_id])


def _kept(words: Iterator[str]) -> Iterator[str]:
    for word in words:
        option, equals, _ = word.partition("=")
        # argparse takes a beginning that is no other option's, so whatever begins one of these is meant by it
        if len(option) > 2 and any(name.startswith(option) for name in ELSEWHERE):
            if not equals:
                next(words, None)
        else:
            yield word
