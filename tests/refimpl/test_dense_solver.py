"""The plain reference: its outer loops run to rounding, whatever starts them."""

from __future__ import annotations

import numpy as np
import pytest

import refimpl as rf

M, SIDE = 3, 1e-3


def spike(friction: rf.Friction) -> rf.Scene:
    """One element in contact, beside two steps: tau tilts the surface there without changing its pressure."""
    lower = np.array([[0.0, 2.0, 0.0], [3.0, 8.0, 0.0], [0.0, 0.0, 1.0]]) * 1e-6
    return rf.Scene(
        upper=rf.Body(rf.Material(30e9, 0.3), rf.Flat()),
        lower=rf.Body(rf.Material(1e9, 0.2), lower),
        friction=friction,
        load=0.1,
        side=SIDE,
    )


@pytest.mark.parametrize("approach", [None, 1e-7])
def test_slopes_settle_even_where_pressure_does_not_follow_them_at_once(approach: float | None) -> None:
    """The step that switches tau on leaves the lone element's pressure, but not the slopes, as it was."""
    solution = rf.solve(
        spike(rf.Friction(tau=1e6, beta=0.1)), M, method="dense", approach=approach, tolerance=1e-13
    )
    assert solution.contact.sum() == 1
    assert solution.status is rf.Status.CONVERGED
