"""Tau's rule (`refimpl.model.friction`) walked on one grid.

A state on the way need only tell its contact, so it is left as soon as that is beyond doubt. Of a cycle's
states mu is told as well: those are settled further if need be. Only the last is settled to the tolerance,
whether the rule settles there or gives up.
Tau that contact leads by itself may end in another lawful state: the rule alone depends on no way.
"""

from __future__ import annotations

from typing import Protocol

from refimpl.model.friction import Mask, TauSupport
from refimpl.model.state import Visited

_SUPPORT_ITERATIONS = 200
_STUCK = 3  # states in a row that cannot be settled: their contacts are no longer the rule's
_TOLD = 1e-6  # residual at which a cycle's state is reported: mu is off by no larger share (see the tests)


class Settling(Protocol):
    """What walks: a state that settles with tau on a support.

    ``residual`` is that of the whole problem, ``stuck`` says that the last settling came to nothing,
    ``cramped`` that its window cuts the contact off, ``ran_off`` that slopes have.
    """

    residual: float
    stuck: bool

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
        """Until it meets the tolerance, if it can; with ``withheld``, or when the next support is known."""

    def visited(self) -> Visited:
        """The present state's numbers."""


def followed(state: Settling, tolerance: float) -> tuple[TauSupport, list[Visited]]:
    """The rule where it ended, and the states of all cycles; ``state`` is left at the last one."""
    rule = TauSupport(state.contact.shape)
    told = max(tolerance, _TOLD)
    way: list[Visited | None] = []
    in_cycles: list[Visited] = []
    stuck = 0
    for _ in range(_SUPPORT_ITERATIONS):
        state.settle(tolerance, rule.current, rule.withheld)
        if state.cramped:
            break
        way.append(state.visited() if state.residual <= told else None)
        rule.next(state.contact)
        for support in reversed(rule.cycle):  # the last is the present one
            in_cycles.append(way.pop() or _again(state, told, support))
        if rule.given_up:
            state.settle(tolerance, rule.current)
            break
        stuck = stuck + 1 if state.stuck else 0
        if rule.settled or state.ran_off or stuck == _STUCK:
            break
    return rule, in_cycles


def _again(state: Settling, tolerance: float, support: Mask) -> Visited:
    """A state that was left before it could be told."""
    state.settle(tolerance, support)
    return state.visited()
