"""Convolution with the influence coefficients of a grid: this module alone chooses free or periodic."""

from __future__ import annotations

from refimpl.grid import Grid, Window
from refimpl.operators.fft import Counter, FFTInfluence, WholeGridInfluence
from refimpl.operators.periodic import PeriodicInfluence

WindowInfluence = FFTInfluence | PeriodicInfluence


def window_influence(
    grid: Grid, direction: float, window: Window | None = None, counter: Counter | None = None
) -> WindowInfluence:
    """Return the operator of a window of the grid onto itself; a periodic grid is its own window."""
    if grid.periodic:
        return PeriodicInfluence(grid, direction, counter=counter)
    return FFTInfluence(grid, direction, source=window, counter=counter)


def whole_grid_influence(
    grid: Grid, direction: float, source: Window, counter: Counter | None = None
) -> WindowInfluence:
    """Return the operator of fields that vanish outside ``source`` onto the whole grid."""
    if grid.periodic:
        return PeriodicInfluence(grid, direction, counter=counter)
    return WholeGridInfluence(grid, direction, source=source, target=grid.window, counter=counter)
