"""Local friction, Eqs (1) and (8), and the rule for which elements carry tau.

``r = tau + beta f`` switches tau on where contact begins. Because tau moves the surfaces next to
it, the support of tau can chase the contact set in a cycle. The rule, for every solver: start from
no tau anywhere; solve; give tau to the elements in contact; repeat. When a support returns, the
elements that changed within that cycle are withheld from tau for good, and the iteration goes on.
The withheld set only grows, so it ends.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from refimpl.grid import Array
from refimpl.scene import Friction

Mask = NDArray[np.bool_]


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
        self.settled = False
        self.cycle: tuple[Mask, ...] = ()
        self._history: list[Mask] = [self.current]

    def next(self, contact: Mask) -> Mask:
        """The support for the next solve, given the contact set of the last.

        Sets ``settled`` when it is the last one again, and ``cycle`` to the supports of a cycle that
        this contact set closes (else to none).
        """
        self.cycle = ()
        support = contact & ~self.withheld
        self.settled = bool(np.array_equal(support, self.current))
        if self.settled:
            return support
        for k in range(len(self._history) - 1):
            if np.array_equal(support, self._history[k]):
                self.cycle = tuple(self._history[k:])
                self.withheld = self.withheld | (np.any(self.cycle, axis=0) & ~np.all(self.cycle, axis=0))
                self._history = []
                support = contact & ~self.withheld
                break
        self._history.append(support)
        self.current = support
        return support
