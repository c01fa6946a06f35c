"""The scene: frame, datum, sliding offset, and what a body takes for a surface."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import refimpl as rf

STEEL = rf.Material(200e9, 0.3)
ROUGH = rf.GaussianRoughness(rms=1e-6, correlation_length=400e-6, seed=7)
SCENE = rf.Scene(
    upper=rf.Body(STEEL, rf.Sphere(0.14)),
    lower=rf.Body(STEEL, ROUGH),
    friction=rf.Friction(15e6, 0.08),
    load=70.0,
    side=1e-3,
)
GRID = rf.Grid.square(SCENE.side, 16)


def test_heights_are_about_their_mid_height() -> None:
    for z in SCENE.heights(GRID):
        assert z.shape == (16, 16)
        assert abs(z.min() + z.max()) <= 1e-15 * np.ptp(z)


def test_x_is_the_first_axis() -> None:
    z = np.arange(16.0)[:, None] * np.ones(16) * 1e-8
    lower, _ = replace(SCENE, lower=rf.Body(STEEL, z)).heights(GRID)
    np.testing.assert_allclose(np.diff(lower, axis=0), 1e-8, rtol=1e-9)
    assert np.all(np.diff(lower, axis=1) == 0)


@pytest.mark.parametrize("angle", [0.0, math.pi / 2, 0.7])
def test_sliding_samples_the_lower_surface_ahead_and_leaves_the_upper(angle: float) -> None:
    """The frame rides with the upper body; after one element along x the old row 1 is row 0."""
    h = GRID.spacings[0]
    slid = replace(SCENE, sliding_direction=angle, sliding_offset=h)
    lower, upper = slid.heights(GRID)
    np.testing.assert_array_equal(upper, SCENE.heights(GRID)[1])
    offset = (h * math.cos(angle), h * math.sin(angle))
    expected = ROUGH.heights(GRID, offset)
    np.testing.assert_allclose(np.diff(lower, axis=0), np.diff(expected, axis=0), atol=1e-20)
    if angle == 0:
        still = ROUGH.heights(GRID)
        # the field is sampled at positions that differ by rounding, times its slope of 0.005
        np.testing.assert_allclose(expected[:-1], still[1:], atol=1e-17)


def test_bodies_take_arrays_and_sums() -> None:
    z = np.ones((16, 16)) * 1e-6
    together = rf.Body(STEEL, rf.Sphere(0.14) + ROUGH + z)
    apart = rf.Sphere(0.14).heights(GRID) + ROUGH.heights(GRID) + z
    np.testing.assert_allclose(together.surface.heights(GRID), apart, rtol=1e-15)


def test_a_scenes_grid_has_its_side_and_its_kind() -> None:
    for periodic in (False, True):
        scene = replace(SCENE, periodic=periodic)
        assert scene.lengths == (1e-3, 1e-3)
        assert scene.grid(16) == rf.Grid.square(1e-3, 16, periodic=periodic)
    for count in (0, -1, 8.0, "8", True):
        with pytest.raises(rf.InputError, match="grid"):
            SCENE.grid(count)  # type: ignore[arg-type]  # the point of the test
