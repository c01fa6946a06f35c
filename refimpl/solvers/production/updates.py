"""How updates of what is held get on: when they are mixed, when that begins anew, when they are given up."""

from __future__ import annotations

from refimpl.solvers.production.anderson import Mixing

_STRONG = 0.3  # an update that brings back more than this share of the last residual counts as strong
_TWICE = 2  # such updates in a row start the mixing; one may be a contact that opens
_STALLED = 5  # updates in a row that do not halve the best residual: they do not contract
_STALE = 10  # the same of mixed ones, before they begin anew: what they remember may be another regime's
_PATIENCE = 30  # and before they are given up


class Updates:
    """One sequence of updates from a residual on.

    ``mixing`` is None as long as plain ones do; from the first it is there if ``strong`` says so. Where
    nothing ``lags`` updates change nothing, and there is nothing to be mixed.
    """

    def __init__(self, residual: float, *, lags: bool, strong: bool) -> None:
        self.mixing = Mixing() if lags and strong else None
        self._lags, self._best = lags, residual
        self._stalled = self._strongly = 0

    def led_to(self, residual: float, brought_back: float) -> None:
        """Count an update, by its residual and by what it brought back, relative to the last one's."""
        self._stalled += 1
        if residual < 0.5 * self._best:
            self._best, self._stalled = residual, 0
        self._strongly = self._strongly + 1 if brought_back > _STRONG else 0
        if self.mixing is None and self._lags and (self._strongly == _TWICE or self._stalled == _STALLED):
            self.mixing, self._stalled = Mixing(), 0
        elif self.mixing and self._stalled and self._stalled % _STALE == 0:
            self.mixing = Mixing()

    @property
    def given_up(self) -> bool:
        """Whether too many in a row have led nowhere."""
        return self._stalled >= (_PATIENCE if self.mixing else _STALLED)
