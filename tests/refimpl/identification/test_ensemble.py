"""Realisations of a surface: their mean, and the scatter of one pair about it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import refimpl as rf
from refimpl.identification import Row, identify
from refimpl.identification.ensemble import redrawn, scatter
from refimpl.scene.scene_file import read_scene


def test_one_realisation_has_no_scatter() -> None:
    assert not scatter(np.array([[0.1, 0.2, 0.3]])).any()


def test_the_scatter_covers_another_draw_by_students_t() -> None:
    """Three draws 1, 2, 3: variance 1, and 1 + 1/3 with the mean's; t of two degrees of freedom is 4.3027."""
    found = scatter(np.array([[1.0], [2.0], [3.0]]))
    assert 1.959964 * found[0, 0] ** 0.5 == pytest.approx(4.302653 * (4 / 3) ** 0.5, rel=1e-5)


def test_loads_that_scatter_together_stay_correlated() -> None:
    """Relative variances 1/4 and 1/4 of both loads: the second is ten times the first, correlation 0.7."""
    found = scatter(np.array([[1.0, 10.0], [2.0, 20.0], [3.0, 30.0]]))
    assert found[1, 1] == pytest.approx(100 * found[0, 0])
    assert found[0, 1] == pytest.approx(0.7 * 10 * found[0, 0])


def test_realisations_differ_and_maps_stay() -> None:
    scene = read_scene("table1-rough")
    first, again, other = redrawn(scene, 0), redrawn(scene, 1), redrawn(scene, 2)
    assert first is scene
    heights = [one.lower.surface for one in (first, again, other)]
    assert isinstance(heights[1], rf.GaussianRoughness)
    assert len({one.seed for one in heights if isinstance(one, rf.GaussianRoughness)}) == 3


def test_statistics_of_a_surface_cover_a_realisation_that_no_fit_draws() -> None:
    """Noise of 0.1 % would miss by tens of standard uncertainties: the scatter of realisations covers it."""
    scene = read_scene("table1-rough")
    rough = scene.lower.surface
    assert isinstance(rough, rf.GaussianRoughness)
    pair = replace(scene, lower=replace(scene.lower, surface=replace(rough, seed=77)))
    rows = []
    for load in (2.0, 6.0, 20.0, 60.0):
        mu = rf.solve(replace(pair, load=load), 64).friction_coefficient
        rows.append(Row(load, mu, 0.001 * mu))
    blind = replace(scene, friction=rf.Friction())
    found = identify(blind, rows, 64, loads=(2.0,), realisations=4, design=False)
    assert found.values["tau"].low < scene.friction.tau < found.values["tau"].high
    assert found.values["beta"].low < scene.friction.beta < found.values["beta"].high
    assert found.shares["realisations"][0] > found.shares["measurement"][0]
    assert found.predictions[-1].mu.low < rows[0].mu < found.predictions[-1].mu.high
