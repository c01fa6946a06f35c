"""Tau's rule (`refimpl.friction`) walked on one grid.

A state on the way need only tell its contact, so it is left as soon as that is beyond doubt. Settled to
the tolerance are the last one, and those of cycles, of which numbers are reported. Where contact leads tau by
itself it may end in another lawful state: only the rule does not depend on the way.
"""

from __future__ import annotations

from typing import Protocol

from refimpl.friction import Mask, TauSupport
from refimpl.outcome import Visited

_SUPPORT_ITERATIONS = 200


class Settling(Protocol):
    """What walks: a state that settles with tau on a support.

    ``cramped`` says that its window cuts the contact off, ``ran_off`` that slopes have.
    """

    @property
    def contact(self) -> Mask:
        """Where the present pressure is positive."""

    @property
    def cramped(self) -> bool:
        """See above."""

    @property
    def ran_off(self) -> bool:
        """See above."""

    def settle(self, tolerance: float, support: Mask, withheld: Mask | None = None) -> bool:
        """Whether it met the tolerance; with ``withheld``, it may end when the next support is known."""

    def visited(self) -> Visited:
        """The present state's numbers."""


def followed(state: Settling, tolerance: float) -> tuple[TauSupport, list[Visited]]:
    """The rule where it ended, and the states of all cycles; ``state`` is left at the last one."""
    rule = TauSupport(state.contact.shape)
    way: list[Visited | None] = []
    in_cycles: list[Visited] = []
    for _ in range(_SUPPORT_ITERATIONS):
        settled = state.settle(tolerance, rule.current, rule.withheld)
        if state.cramped:
            break
        way.append(state.visited() if settled else None)
        rule.next(state.contact)
        for support in reversed(rule.cycle):  # the last is the present one
            in_cycles.append(way.pop() or _again(state, tolerance, support))
        if rule.settled or state.ran_off:
            break
    return rule, in_cycles


def _again(state: Settling, tolerance: float, support: Mask) -> Visited:
    """A state that was left before it was settled."""
    state.settle(tolerance, support)
    return state.visited()
