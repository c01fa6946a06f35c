"""Limits of the implementation as a reference: the states that are not solved, as data in ``limits.toml``."""

from __future__ import annotations

import tomllib
from collections.abc import Callable
from enum import StrEnum
from fnmatch import fnmatchcase
from pathlib import Path
from typing import NamedTuple

from verification.stress_tests.oracle import EXACT
from verification.stress_tests.state import NO_DIGITS, NO_STATE, NOT_FOUND, Judged


class Kind(StrEnum):
    """Kind of a state that is not solved: what stands behind it."""

    NO_PROBLEM = "no such problem, or no digits"
    EXCLUDED = "a state with more than half of the contact without tau"
    NONE_FOUND = "no state found, and none proved impossible"
    BEYOND = "a state exists; this solver is made for p < E* and beta < 10, and says that it failed"
    MISSED = "a state exists"


def _exact_but_for_tau(judged: Judged) -> bool:
    exact = judged.oracle == EXACT and judged.error is not None and judged.error <= judged.limit
    sought = judged.note.startswith((NO_STATE, NOT_FOUND))
    return exact and sought and judged.data.get("without tau", 0.0) > 0.5


RULES: dict[str, Callable[[Judged], bool]] = {
    "exact, but more than half of the contact carries no tau, and no other found": _exact_but_for_tau,
    "the input lost more than 3e-3 of itself": lambda judged: judged.data.get("lost", 0.0) > NO_DIGITS,
}
"""Limits that the returned state shows, whatever its id."""


class Limit(NamedTuple):
    """One limit: its ``kind``, ``what`` happens there and ``why``, and the ``evidence`` for the kind.

    Its states are those of a ``rule``, or those whose ids match one of the globs in ``states``.
    """

    kind: Kind
    what: str
    why: str
    evidence: str
    rule: str = ""
    states: tuple[str, ...] = ()

    def holds(self, unique: str, judged: Judged) -> bool:
        """Return whether a state shows the limit."""
        by_rule = bool(self.rule) and RULES[self.rule](judged)
        return by_rule or any(fnmatchcase(unique, glob) for glob in self.states)


ROWS = tomllib.loads(Path(__file__).with_suffix(".toml").read_text(encoding="utf-8"))["limit"]
LIMITS = tuple(Limit(**row | {"kind": Kind[row["kind"]]}) for row in ROWS)


def limits_of(unique: str, judged: Judged) -> list[Limit]:
    """Return the limits that a state shows: one where it is not solved, else none."""
    return [limit for limit in LIMITS if limit.holds(unique, judged)]
