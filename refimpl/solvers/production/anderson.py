"""Anderson's mixing: successive approximations that would not contract by themselves.

What is held while CG works (`refimpl.solvers.production.level`) is a field x, and the pressure that CG finds
asks for another, g(x). Slopes ask for the cosines of a surface that the pressure itself has moved: their
feedback grows with displacement over spacing, so that on fine grids x <- g(x) leads away from the solution,
and relaxed as far as it must be leads nowhere in sensible time. Close to the solution g is all but linear. So
the last differences of x say how what x lacks, g(x) - x, changes; the combination of them that cancels most
of it is taken back, and a share of the rest is added (Anderson 1965, J. ACM 12, 547). On a linear g this is
GMRES (Walker and Ni 2011, SIAM J. Numer. Anal. 49, 1715), which a skew feedback above one does not stop.
"""

from __future__ import annotations

import numpy as np

from refimpl.grid import Array, inner

_DEPTH = 20  # differences remembered: steep slopes on 1024 elements take 522 steps of CG, 606 with 10
_SHARE = 0.5  # of what is lacking after the cancelling; 0.3 takes more steps, and 1 stalled on 512 elements
_DISTINCT = 1e-10  # least eigenvalue of normalised differences' products that counts as more than rounding


class Mixing:
    """The fields of one sequence of updates: `mixed` for each in turn.

    Fields are without units, rows by columns, and may be stacked.

    >>> mixing, x = Mixing(), np.array([[1.0, 0.0]])
    >>> for _ in range(4):
    ...     x = mixing.mixed(x, np.array([[-3 * x[0, 1], 3 * x[0, 0]]]))    # skew, three times as far
    >>> bool(np.abs(x).max() < 1e-12)
    True
    """

    def __init__(self) -> None:
        self._last: tuple[Array, Array] | None = None
        self._steps: list[Array] = []
        self._changes: list[Array] = []
        self._products = np.empty((0, 0))

    def mixed(self, held: Array, asked: Array) -> Array:
        """What to hold next, after ``held`` has led to a state that asks for ``asked``."""
        lack = asked - held
        if self._last is not None:
            self._remember(held - self._last[0], lack - self._last[1])
        self._last = held, lack
        found: Array = held + _SHARE * lack
        for share, step in zip(self._cancelling(lack), self._steps, strict=True):
            found -= share * step
        return found

    def _remember(self, moved: Array, change: Array) -> None:
        self._steps.append(moved + _SHARE * change)
        self._changes.append(change)
        n = len(self._changes)
        products = np.empty((n, n))
        products[:-1, :-1] = self._products
        products[-1] = products[:, -1] = [inner(other, change) for other in self._changes]
        kept = slice(max(0, n - _DEPTH), n)
        self._steps, self._changes = self._steps[kept], self._changes[kept]
        self._products = products[kept, kept]

    def _cancelling(self, lack: Array) -> Array:
        """How much of each change remembered to take back: least squares of what is left lacking."""
        if not self._changes:
            return np.empty(0)
        sizes = np.sqrt(np.diag(self._products))
        sizes[sizes == 0] = 1.0
        shared = np.array([inner(change, lack) for change in self._changes]) / sizes
        alike = self._products / np.outer(sizes, sizes)
        shares: Array = np.linalg.lstsq(alike, shared, rcond=_DISTINCT)[0]
        return shares / sizes
