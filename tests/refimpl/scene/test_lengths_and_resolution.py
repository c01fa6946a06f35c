"""The domain of several measured surfaces, offsets along the sliding direction, the roughness that counts."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import refimpl as rf
from refimpl.grid import Grid
from refimpl.scene.parameters import moving, parameters
from refimpl.scene.resolution import resolution

STEEL = rf.Material(200e9, 0.3)


def measured(path: Path, shape: tuple[int, int]) -> rf.Body:
    np.save(path, np.random.default_rng(1).normal(size=shape))
    return rf.Body(STEEL, rf.MeasuredSurface(path, unit="um", pixel_size=1e-5))


def test_the_roughness_that_is_resolved_worst_counts() -> None:
    """Elements per length over those required: not the fewest elements."""
    gaussian = rf.GaussianRoughness(1e-6, 6e-5, seed=1)
    waves = rf.SelfAffineRoughness(
        hurst=0.8, rms=1e-7, roll_off=2e-4, long_cut=4e-4, short_cut=5.4e-5, seed=2
    )
    grid = Grid((100, 50), (1e-3, 1e-3))  # elements of 10 x 20 um: the longer edge counts

    def of(*parts: rf.Surface) -> tuple[float, float]:
        lower = rf.Body(STEEL, sum(parts[1:], start=parts[0]))
        scene = rf.Scene(rf.Body(STEEL, rf.Flat()), lower, rf.Friction(), 1.0, 1e-3)
        found = resolution(scene, grid, 1e-3)
        assert found is not None
        assert found == resolution(replace(scene, lower=scene.upper, upper=lower), grid, 1e-3)
        return found.elements, found.required

    alone = [of(gaussian), of(waves)]
    assert [elements for elements, _ in alone] == pytest.approx([3.0, 2.7])
    assert alone[0][1] == pytest.approx(math.sqrt(math.log(10) / 1e-3), rel=1e-2)
    worst = min(alone, key=lambda pair: pair[0] / pair[1])
    assert worst == alone[0] != min(alone)
    assert of(gaussian, waves) == of(waves, gaussian) == worst


def test_parameters_that_are_zero_do_not_move() -> None:
    lower = rf.Body(STEEL, rf.GaussianRoughness(1e-6, (1e-4, 2e-4), seed=3))
    scene = rf.Scene(rf.Body(STEEL, rf.Sphere(0.1)), lower, rf.Friction(tau=0.0, beta=0.2), 7.0, 1e-3)
    still = {"friction.tau", "lower.surface[0].lay", "lower.surface[0].seed"}
    assert set(parameters(scene)) - set(moving(scene)) == still
    rigid = replace(scene, upper=rf.Body(rf.Material(math.inf, 0.3), rf.Sphere(0.1)))
    assert set(parameters(rigid)) - set(moving(rigid)) == {*still, "upper.material.E", "upper.material.nu"}


@pytest.mark.parametrize("given", [{}, {"side": 1e-4}, {"size": (1.5e-4, 1e-4)}], ids=str)
def test_a_size_that_nobody_gave_is_noted(given: dict[str, Any], tmp_path: Path) -> None:
    body = measured(tmp_path / "a.npy", (30, 20))
    scene = rf.Scene(rf.Body(STEEL, rf.Flat()), body, rf.Friction(), 1.0, **given)
    assert any("no size given" in line for line in scene.cautions(scene.grid(8))) == (not given)


def test_balls_go_on_beyond_a_free_domain_alone() -> None:
    ball, bowl = rf.Body(STEEL, rf.Sphere(0.1)), rf.Body(STEEL, rf.Sphere(0.1))
    flat = rf.Body(STEEL, rf.Flat())
    free, periodic = (rf.Scene(ball, flat, rf.Friction(), 1.0, 1e-3, periodic=p) for p in (False, True))
    assert (free.continues, periodic.continues) == (True, False)
    assert not rf.Scene(ball, bowl, rf.Friction(), 1.0, 1e-3).continues  # one fills the other
