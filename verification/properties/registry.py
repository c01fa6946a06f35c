"""Definition of an invariant, and the list of all invariants."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from hypothesis.strategies import SearchStrategy

import refimpl as rf
from verification.properties.samples import Sample


class Solver(Protocol):
    """Anything that solves a scene like `refimpl.solve`: by its load, or at a prescribed approach (m)."""

    def __call__(
        self,
        scene: rf.Scene,
        grid: tuple[int, int],
        *,
        approach: float | None = None,
        oblique: bool | None = None,
    ) -> rf.Solution:
        """Return the solution on a grid of ``(Mx, My)`` elements."""
        ...


Check = Callable[[Solver, Sample], None]


def require(holds: object, claim: str = "the invariant does not hold") -> None:
    """Raise AssertionError unless the claim holds, also under ``python -O``, which drops ``assert``."""
    if not holds:
        raise AssertionError(claim)


@dataclass(frozen=True)
class Invariant:
    """``check`` raises AssertionError where ``claim`` fails on ``samples``, or on ``found``, met before."""

    name: str
    claim: str
    samples: SearchStrategy[Sample]
    check: Check
    found: tuple[Sample, ...] = ()


INVARIANTS: dict[str, Invariant] = {}


def invariant(
    claim: str, over: SearchStrategy[Sample], *, found: tuple[Sample, ...] = ()
) -> Callable[[Check], Check]:
    """Declare the decorated check as an invariant, by its function's name."""

    def declare(check: Check) -> Check:
        name = check.__name__
        if name in INVARIANTS:
            raise ValueError(f"invariant {name!r} is declared twice")
        INVARIANTS[name] = Invariant(name, claim, over, check, found)
        return check

    return declare
