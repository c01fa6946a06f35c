"""Convolution with the influence coefficients of a grid: this module alone chooses free or periodic."""

from __future__ import annotations

from refimpl.grid import Grid, Window
from refimpl.operators.fft import Counter, FFTInfluence, WholeGridInfluence
from refimpl.operators.near_far import NearFarInfluence, is_quicker
from refimpl.operators.periodic import PeriodicInfluence

WindowInfluence = FFTInfluence | PeriodicInfluence


def window_influence(
    grid: Grid,
    direction: float,
    window: Window | None = None,
    counter: Counter | None = None,
    tolerance: float = 0.0,
) -> WindowInfluence:
    """Return a window's operator onto itself, the quickest that the tolerance allows."""
    if grid.periodic:
        return PeriodicInfluence(grid, direction, counter=counter)
    window = window or grid.window
    kind = NearFarInfluence if is_quicker(grid, window, tolerance) else FFTInfluence
    return kind(grid, direction, source=window, counter=counter)


def whole_grid_influence(
    grid: Grid, direction: float, source: Window, counter: Counter | None = None
) -> WindowInfluence:
    """Return the operator of fields that vanish outside ``source`` onto the whole grid."""
    if grid.periodic:
        return PeriodicInfluence(grid, direction, counter=counter)
    return WholeGridInfluence(grid, direction, source=source, target=grid.window, counter=counter)
