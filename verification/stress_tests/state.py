"""States of the stress tests, and their verdicts."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from enum import StrEnum

DIGITS_MOST = 17.0
"""Digits given to an error of exactly zero: a double holds 15.95."""
NO_DIGITS = 3e-3
"""Relative error of the input beyond which nothing is right: results may change by 30 times that, a tenth."""
EXISTS = "a state exists: found by continuation"
NO_STATE = "no state exists: integer programming over all contact sets"
NOT_FOUND = "continuation finds no state"
"""Notes on a state that no solver found; the second proves it, the third is said of states with slopes."""


class Verdict(StrEnum):
    """Verdict on a state. WRONG must never occur: a number with an error, reported as good."""

    RIGHT = "right"
    DETECTED = "detected failure"  # refused, a documented error, or a status that says no
    UNJUDGED = "unjudged"  # no judge decides: it failed itself, or the input has lost its digits
    WRONG = "wrong"
    CRASH = "crash"  # an exception that nobody foresaw: no wrong number, but no reason either


@dataclass(frozen=True)
class Judged:
    """The outcome of one state.

    ``error`` is relative to the scale of what is judged, None where no number was given; ``limit`` is the
    error from which a number counts as wrong; ``oracle`` names the reference.
    """

    verdict: Verdict
    status: str
    error: float | None
    limit: float
    oracle: str
    note: str = ""
    data: Mapping[str, float] = field(default_factory=dict)

    @property
    def digits(self) -> float | None:
        """Decimal digits that agree with the oracle; None where no number was given."""
        return None if self.error is None else digits_kept(self.error)


@dataclass(frozen=True)
class Extreme:
    """One state: its series on the axis, its place there (as text and number), its run, its time limit."""

    series: str
    at: str
    x: float
    run: Callable[[], Judged]
    seconds: float = 4.0  # processor time limit; beyond it the state counts as one that does not end


def digits_kept(error: float) -> float:
    """Return ``-log10`` of a relative error, between 0 and `DIGITS_MOST`.

    >>> digits_kept(1e-12), digits_kept(0.0), digits_kept(3.0)
    (12.0, 17.0, 0.0)
    """
    return DIGITS_MOST if error == 0 else min(DIGITS_MOST, max(0.0, -math.log10(error)))


def number(error: float, limit: float, status: str, oracle: str, note: str = "", **data: float) -> Judged:
    """Judge a number that was given as good: right within the limit, else (NaN too) wrong."""
    verdict = Verdict.RIGHT if error <= limit else Verdict.WRONG
    return Judged(verdict, status, error if math.isfinite(error) else 1e300, limit, oracle, note, data)
