"""Wedge tip on a half-space: the load at its base, the limit without a tip, the first-order change."""

from __future__ import annotations

import numpy as np
import pytest

from appendix_a.strip.field import flat_displacement
from appendix_a.wedge_tip import relative_difference, tip_displacement

X = np.array([0.0, 0.5, 0.9, 1.2, 3.0, 9.99, 10.01, 40.0])


def test_no_slope_no_difference() -> None:
    # graded panels leave 2e-8 at half the depth of grading; 1e-10 here
    np.testing.assert_allclose(relative_difference(X, 0.0, 0.3), 0, atol=1e-9)


@pytest.mark.parametrize("nu", [0.0, 0.3])
def test_first_order_in_the_slope(nu: float) -> None:
    """Relative to the apex the change is -(1+nu)(1-2nu) gamma min(x, 1), as strip theory has it."""
    gamma, x = 1e-4, np.array([0.5, 0.9, 1.2, 3.0])
    tip = tip_displacement(x, gamma, nu, half_base=10.0, datum=0.0)
    change = (tip - flat_displacement(x, nu)) / gamma
    # second order: gamma over the distance to the strip's end
    np.testing.assert_allclose(change, -(1 + nu) * (1 - 2 * nu) * np.minimum(x, 1), rtol=0, atol=5e-3)


def test_far_away_only_the_resultant_counts() -> None:
    """The tip carries 2 a cos(gamma), the flat strip 2 a: far from both, that is the whole difference."""
    gamma = np.radians(20.0)
    far = relative_difference(2000.0, gamma, 0.3, datum=4000.0)
    assert far == pytest.approx(np.cos(gamma) - 1, abs=1e-4)
