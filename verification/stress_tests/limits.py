"""Limits of the implementation as a reference: the states that are not solved, as data in ``limits.toml``."""

from __future__ import annotations

import tomllib
from enum import StrEnum
from fnmatch import fnmatchcase
from pathlib import Path
from typing import NamedTuple


class Kind(StrEnum):
    """Kind of a state that is not solved: what stands behind it."""

    NO_PROBLEM = "no such problem, or no digits"
    EXCLUDED = "only a state with more than half of the contact without tau"
    NONE_FOUND = "no state found, and none proved impossible"
    BEYOND = "a state exists; this solver is made for p < E* and beta < 10, and says that it failed"
    MISSED = "a state exists"


class Limit(NamedTuple):
    """One limit: its ``kind``, a glob over its ``states``, ``what`` happens there, and ``why``."""

    kind: Kind
    states: str
    what: str
    why: str


ROWS = tomllib.loads(Path(__file__).with_suffix(".toml").read_text(encoding="utf-8"))["limit"]
LIMITS = tuple(Limit(**row | {"kind": Kind[row["kind"]]}) for row in ROWS)


def limit_of(unique: str) -> Limit | None:
    """Return the limit that a state shows; of several the last, which is the more special one."""
    found = [limit for limit in LIMITS if fnmatchcase(unique, limit.states)]
    return found[-1] if found else None
