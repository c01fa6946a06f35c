"""The study of the slope correction: the remedy's terms, and both formulations on one small scene."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import refimpl as rf
from verification.cases.appendix_a.correction import PAIRS, near_field, remedied, scene_of

SIZE = 16


@pytest.fixture(scope="module")
def scene() -> rf.Scene:
    """Rough rigid ball on copper, frictionless, so that Eq. (7) has no other tangential traction."""
    return replace(scene_of(PAIRS[1], 0.5, 0), friction=rf.Friction(), side=0.9e-3)


@pytest.mark.filterwarnings("ignore::refimpl.SurfaceWarning")
def test_all_coefficients_on_the_slope_are_the_correction(scene: rf.Scene) -> None:
    plain, cured = (rf.solve(scene, SIZE, slope_correction=on) for on in (False, True))
    full = remedied(scene, SIZE, reach=SIZE - 1)
    change = np.abs(cured.pressure - plain.pressure).max()
    # second over first order is about the slope, 0.4 degrees in contact; an edge's slope adds as much
    assert np.abs(full.pressure - cured.pressure).max() < 0.03 * change


@pytest.mark.filterwarnings("ignore::refimpl.SurfaceWarning")
def test_bodies_of_one_material_lose_the_first_order(scene: rf.Scene) -> None:
    """The pair's sum keeps the even part alone, which is second order: 0.4 degrees squared."""
    found = rf.solve(scene, SIZE)
    copper = scene.lower.material
    lower, upper = (near_field(found, copper, sign, 2) for sign in (1.0, -1.0))
    assert np.abs(lower + upper).max() < 0.02 * np.abs(lower - upper).max()
