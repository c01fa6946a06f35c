"""The active set of tau: which elements carry adhesive shear, one rule and one loop for all solvers.

``r = tau + beta f`` switches tau on where contact begins. As tau moves the surfaces beside it, the active set
can follow the contact set in a cycle. The rule: start from no tau anywhere; solve; give tau to the elements
in contact; repeat. When an active set returns, the elements that changed within that cycle are excluded for
good. So are elements that leave the active set for the third time: where many elements alternate, each at its
own pace, a whole set hardly ever returns. Between two exclusions active sets only grow, so the rule ends.
Where it would exclude most of the contact, hardly anything is left of the law, and the rule gives up.
"""

from __future__ import annotations

from typing import NamedTuple, Protocol

import numpy as np

from refimpl.grid import Mask
from refimpl.model.friction import FrictionLaw
from refimpl.model.state import CycleState, Status

_MOST_EXCLUDED = 0.5  # share of the contact; reached where tau is two to three times the highest pressure
_MOST_EXITS = 3  # times that an element leaves the active set; cycles of two are mostly found before
_ACTIVE_SETS = 200  # limit of the loop
_MOST_STAGNATED = 3  # solves in a row that do not converge: their contact sets are not the rule's
_REPORT_TOLERANCE = 1e-6  # residual at which a cycle's state is reported: mu errs by no larger share (tests)


class TauActiveSet:
    """The sequence of tau's active sets, with cycles found and ended by the rule above.

    >>> rule = TauActiveSet((2,))
    >>> a, b = np.array([True, False]), np.array([True, True])
    >>> for contact in (a, b, a):
    ...     active = rule.next(contact)
    >>> rule.excluded, active
    (array([False,  True]), array([ True, False]))
    """

    def __init__(self, shape: tuple[int, ...]) -> None:
        self.current: Mask = np.zeros(shape, dtype=bool)
        self.excluded: Mask = np.zeros(shape, dtype=bool)
        self.settled = self.given_up = False
        self.cycle: tuple[Mask, ...] = ()
        self._exits = np.zeros(shape, dtype=np.uint8)
        self._history: list[Mask] = [self.current]

    def next(self, contact: Mask) -> Mask:
        """Return the active set for the next solve, given the contact set of the last one.

        Sets ``settled`` when it equals the present one. Sets ``cycle`` to the active sets, the present one
        last, that contained elements excluded from now on: those of a cycle that this contact set closes, or
        the one that elements leave once too often. Where the rule is ``given_up`` nothing changes.
        """
        self.cycle = ()
        active = contact & ~self.excluded
        self.settled = bool(np.array_equal(active, self.current))
        if self.settled:
            return active
        leaving = self.current & ~active
        self._exits += leaving
        alternating = leaving & (self._exits == _MOST_EXITS)
        returned = self._first_seen(active)
        if returned is not None:
            self.cycle = tuple(self._history[returned:])
            alternating = np.any(self.cycle, axis=0) & ~np.all(self.cycle, axis=0)
        elif alternating.any():
            self.cycle = (self.current,)
        if self.cycle:
            excluded = self.excluded | alternating
            if np.count_nonzero(excluded & contact) > _MOST_EXCLUDED * np.count_nonzero(contact):
                self.given_up, self.cycle = True, ()
                return self.current
            self.excluded, self._history = excluded, []
            active = contact & ~excluded
        self._history.append(active)
        self.current = active
        return active

    def _first_seen(self, active: Mask) -> int | None:
        """Index of this active set since elements were last excluded."""
        return next((k for k, seen in enumerate(self._history) if np.array_equal(active, seen)), None)


class TauSolver(Protocol):
    """What the loop needs of a solver: states with tau on a given active set.

    residual : of the whole problem
    stagnated : the last solve did not converge
    exhausted : no further solve is worthwhile: slopes diverged, or the solver's budget is spent
    window_too_small : the contact meets the edge of the solver's window
    """

    residual: float

    @property
    def stagnated(self) -> bool:
        """See above."""

    @property
    def exhausted(self) -> bool:
        """See above."""

    @property
    def window_too_small(self) -> bool:
        """See above."""

    @property
    def contact(self) -> Mask:
        """Where the present pressure is positive."""

    def solve(self, tolerance: float, active: Mask, excluded: Mask | None = None) -> bool:
        """Solve with tau on ``active``; return whether the residual meets the tolerance.

        Given ``excluded``, the solver may stop as soon as the next active set is certain to differ.
        """

    def cycle_state(self) -> CycleState:
        """Return the numbers of the present state."""


class TauResult(NamedTuple):
    """How the rule ended.

    settled : the active set reproduces itself
    excluded : elements that the rule leaves without adhesive shear
    cycle_states : summaries of the states of all cycles
    solves : how many states were solved
    """

    settled: bool
    excluded: Mask
    cycle_states: tuple[CycleState, ...]
    solves: int

    def status(self, contact: Mask, ended: Status = Status.CONVERGED) -> Status:
        """Return the status of a solver whose own loops ended with ``ended`` on this contact set."""
        if ended is Status.CONVERGED and not self.settled:
            return Status.ITERATION_LIMIT
        if ended is Status.CONVERGED and np.any(self.excluded & contact):
            return Status.CYCLED
        return ended


def iterate(solver: TauSolver, law: FrictionLaw, tolerance: float) -> TauResult:
    """Solve on one active set after the other by the rule; the solver is left at the last state.

    A state before the last needs only its contact set, so its solve may end early. Of a cycle's states mu is
    reported as well: those whose solve had ended early are solved again. A law without a jump holds on every
    element, as its shear vanishes with the pressure: one solve is enough.
    """
    rule = TauActiveSet(solver.contact.shape)
    if law.jump == 0:
        solver.solve(tolerance, ~rule.current)
        return TauResult(True, rule.excluded, (), 1)
    history: list[CycleState | None] = []
    cycle_states: list[CycleState] = []
    solves = stagnated = 0
    reported = max(tolerance, _REPORT_TOLERANCE)
    for _ in range(_ACTIVE_SETS):
        solver.solve(tolerance, rule.current, rule.excluded)
        solves += 1
        if solver.window_too_small:
            break
        history.append(solver.cycle_state() if solver.residual <= reported else None)
        rule.next(solver.contact)
        for active in reversed(rule.cycle):  # the last is the present one
            state = history.pop()
            if state is None:
                solver.solve(reported, active)
                solves, state = solves + 1, solver.cycle_state()
            cycle_states.append(state)
        if rule.given_up:
            solver.solve(tolerance, rule.current)
            solves += 1
            break
        stagnated = stagnated + 1 if solver.stagnated else 0
        if rule.settled or solver.exhausted or stagnated == _MOST_STAGNATED:
            break
    return TauResult(rule.settled, rule.excluded, tuple(cycle_states), solves)
