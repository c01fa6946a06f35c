"""How fine a grid still learns from measured heights."""

from __future__ import annotations

import numpy as np

import refimpl as rf
from refimpl.solution.data_error import finest_by_data

SOFT = rf.Material(2e9, 0.4)


def scene(lower: rf.Body, upper: rf.Body, size: tuple[float, float]) -> rf.Scene:
    return rf.Scene(lower=lower, upper=upper, friction=rf.Friction(), load=1.0, size=size)


def test_the_closest_points_of_both_bodies_count_along_the_longer_side() -> None:
    """Points 10 um apart below, 25 um above, on 300 x 100 um: four elements in 10 um are 120 in 300."""
    coarse = rf.Body(SOFT, np.zeros((12, 4)))
    fine = rf.Body(SOFT, np.zeros((30, 10)))
    assert finest_by_data(scene(fine, coarse, (300e-6, 100e-6))) == 120.0
    assert finest_by_data(scene(coarse, rf.Body(SOFT, rf.Sphere(0.1)), (300e-6, 100e-6))) == 48.0


def test_formulas_have_no_points() -> None:
    rough = rf.Body(SOFT, rf.GaussianRoughness(1e-7, 1e-4, seed=2))
    assert finest_by_data(scene(rough, rf.Body(SOFT, rf.Flat()), (1e-3, 1e-3))) == np.inf
