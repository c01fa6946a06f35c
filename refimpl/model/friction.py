"""Local friction, Eqs (1) and (8), and the rule for which elements carry tau.

``r = tau + beta f`` switches tau on where contact begins. Because tau moves the surfaces next to
it, the support of tau can chase the contact set in a cycle. The rule, for every solver: start from
no tau anywhere; solve; give tau to the elements in contact; repeat. When a support returns, the
elements that changed within that cycle are withheld from tau for good, and the iteration goes on.
So are those that leave the support for the third time: where many elements flip by themselves, each at
its own pace, the support as a whole hardly ever returns. Between two such events supports only grow, so
it ends. Where tau would be withheld from most of the contact nothing is left of the law, and the rule is
given up.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from refimpl.grid import Array
from refimpl.scene.scene import Friction

Mask = NDArray[np.bool_]

_MOST = 0.5  # of the contact; tau of two to three times the highest pressure comes there
_OFTEN = 3  # times that an element leaves tau's support; in cycles of two it is mostly noticed before


def local_friction(friction: Friction, pressure: Array, support: Mask) -> Array:
    """Eq. (8): ``tau`` on its support plus ``beta f`` (Pa).

    >>> local_friction(Friction(tau=2.0, beta=0.5), np.array([0.0, 4.0]), np.array([False, True]))
    array([0., 4.])
    """
    return friction.tau * support + friction.beta * pressure


class TauSupport:
    """The sequence of tau's supports, with cycles found and settled by the rule above.

    >>> rule = TauSupport((2,))
    >>> a, b = np.array([True, False]), np.array([True, True])
    >>> for contact in (a, b, a):
    ...     support = rule.next(contact)
    >>> rule.withheld, support
    (array([False,  True]), array([ True, False]))
    """

    def __init__(self, shape: tuple[int, ...]) -> None:
        self.current: Mask = np.zeros(shape, dtype=bool)
        self.withheld: Mask = np.zeros(shape, dtype=bool)
        self.settled = self.given_up = False
        self.cycle: tuple[Mask, ...] = ()
        self._left = np.zeros(shape, dtype=np.uint8)
        self._history: list[Mask] = [self.current]

    def next(self, contact: Mask) -> Mask:
        """The support for the next solve, given the contact set of the last.

        Sets ``settled`` when it is the last one again, and ``cycle`` to the supports, the present one last,
        that elements withheld from now on were part of (to none, if none are): a cycle's that this contact
        set closes, or the one that they leave once too often. Where it is ``given_up`` nothing changes.
        """
        self.cycle = ()
        support = contact & ~self.withheld
        self.settled = bool(np.array_equal(support, self.current))
        if self.settled:
            return support
        leaving = self.current & ~support
        self._left += leaving
        flipping = leaving & (self._left == _OFTEN)
        returned = self._first_seen(support)
        if returned is not None:
            self.cycle = tuple(self._history[returned:])
            flipping = np.any(self.cycle, axis=0) & ~np.all(self.cycle, axis=0)
        elif flipping.any():
            self.cycle = (self.current,)
        if self.cycle:
            withheld = self.withheld | flipping
            if np.count_nonzero(withheld & contact) > _MOST * np.count_nonzero(contact):
                self.given_up, self.cycle = True, ()
                return self.current
            self.withheld, self._history = withheld, []
            support = contact & ~withheld
        self._history.append(support)
        self.current = support
        return support

    def _first_seen(self, support: Mask) -> int | None:
        """When this support was current before, since elements were last withheld."""
        return next((k for k, seen in enumerate(self._history) if np.array_equal(support, seen)), None)
