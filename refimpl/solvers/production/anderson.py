"""Anderson mixing of the lagged terms, and the control of when to mix.

While CG works, the lagged terms are a fixed field x; the pressure that CG finds asks for another, g(x).
Slopes ask for the cosines of a surface that the pressure itself has moved: their feedback grows with
displacement over element size, so that on fine grids ``x <- g(x)`` diverges. Close to the solution g is
nearly linear. So the last differences of x tell how the defect ``g(x) - x`` changes; the combination of them
that cancels most of the defect is subtracted, and a share of the rest is added (Anderson 1965, J. ACM 12,
547). For a linear g this is GMRES (Walker and Ni 2011, SIAM J. Numer. Anal. 49, 1715), which converges for a
skew feedback above one as well.
"""

from __future__ import annotations

import numpy as np

from refimpl.grid import Array, inner
from refimpl.solvers.production.constants import (
    DEPTH,
    DISTINCT,
    MIXING_SHARE,
    NEAR_ROUNDING,
    PATIENCE,
    RESTART,
    STALLED,
    STRONG_FEEDBACK,
    STRONG_UPDATES,
)


class AndersonMixing:
    """The iterates of one sequence of updates: dimensionless fields, which may be stacked.

    >>> mixing, x = AndersonMixing(), np.array([[1.0, 0.0]])
    >>> for _ in range(4):
    ...     x = mixing.next(x, np.array([[-3 * x[0, 1], 3 * x[0, 0]]]))    # skew, three times as far
    >>> bool(np.abs(x).max() < 1e-12)
    True
    """

    def __init__(self) -> None:
        self._last: tuple[Array, Array] | None = None
        self._steps: list[Array] = []
        self._changes: list[Array] = []
        self._products = np.empty((0, 0))

    def next(self, used: Array, requested: Array) -> Array:
        """Return the next iterate, given the last one and the field that its state asks for."""
        defect = requested - used
        if self._last is not None:
            self._append(used - self._last[0], defect - self._last[1])
        self._last = used, defect
        found: Array = used + MIXING_SHARE * defect
        for share, step in zip(self._cancelling(defect), self._steps, strict=True):
            found -= share * step
        return found

    def _append(self, moved: Array, change: Array) -> None:
        """Add a difference of iterates and of defects; drop the oldest beyond the depth."""
        self._steps.append(moved + MIXING_SHARE * change)
        self._changes.append(change)
        n = len(self._changes)
        products = np.empty((n, n))
        products[:-1, :-1] = self._products
        products[-1] = products[:, -1] = [inner(other, change) for other in self._changes]
        kept = slice(max(0, n - DEPTH), n)
        self._steps, self._changes = self._steps[kept], self._changes[kept]
        self._products = products[kept, kept]

    def _cancelling(self, defect: Array) -> Array:
        """Return the share of each change to subtract: the least squares of the defect that remains."""
        if not self._changes:
            return np.empty(0)
        sizes = np.sqrt(np.diag(self._products))
        sizes[sizes == 0] = 1.0
        right = np.array([inner(change, defect) for change in self._changes]) / sizes
        normalised = self._products / np.outer(sizes, sizes)
        shares: Array = np.linalg.lstsq(normalised, right, rcond=DISTINCT)[0]
        return shares / sizes


class MixingControl:
    """When one sequence of updates is mixed, when its history is dropped, and when it has stagnated.

    ``mixing`` is None as long as plain updates contract; it is there from the first update if
    ``needs_mixing``. Where nothing lags (``has_lag`` is False) updates change nothing and are never mixed.
    """

    def __init__(self, residual: float, *, has_lag: bool, needs_mixing: bool) -> None:
        self.mixing = AndersonMixing() if has_lag and needs_mixing else None
        self._has_lag, self._best = has_lag, residual
        self._stalled = self._strong = 0

    def record(self, residual: float, feedback: float) -> None:
        """Count an update, by its residual and by its change of the residual over the last residual."""
        self._stalled += 1
        if residual < 0.5 * self._best:
            self._best, self._stalled = residual, 0
        self._strong = self._strong + 1 if feedback > STRONG_FEEDBACK else 0
        stalled = self._stalled == STALLED and self._best > NEAR_ROUNDING
        starts = self._strong == STRONG_UPDATES or stalled
        if self.mixing is None and self._has_lag and starts:
            self.mixing, self._stalled = AndersonMixing(), 0
        elif self.mixing and self._stalled and self._stalled % RESTART == 0:
            self.mixing = AndersonMixing()

    @property
    def stagnated(self) -> bool:
        """True if too many updates in a row have not halved the best residual."""
        patient = self.mixing and self._best > NEAR_ROUNDING
        return self._stalled >= (PATIENCE if patient else STALLED)
