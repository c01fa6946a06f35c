"""Realisations of a surface: their mean, and the scatter of one pair about it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import refimpl as rf
from refimpl.identification import Row, identify
from refimpl.identification.ensemble import deviations, draws, mean_response, redrawn, working_variances
from refimpl.identification.fit import linear_fit, profile_of, shares
from refimpl.identification.forward import Forward, Response
from refimpl.scene.scene_file import read_scene


SPAN = np.geomspace(1.0, 200.0, 9)  # N


def test_one_realisation_has_no_scatter() -> None:
    one = np.array([[0.1, 0.2, 0.3]])
    assert len(deviations(one)) == 0
    assert not working_variances(one, np.array([1.0, 2.0, 4.0])).any()


def test_deviations_hold_the_variance_of_another_draw_about_the_mean() -> None:
    """Three draws 1, 2, 3: variance 1, and 1 + 1/3 with the mean's."""
    found = deviations(np.array([[1.0, 10.0], [2.0, 10.0], [3.0, 10.0]]))
    assert np.sum(found**2, axis=0) == pytest.approx([4 / 3, 0.0])


def test_the_relative_scatter_that_weighs_rows_falls_with_the_root_of_the_load() -> None:
    """Relative variances (4/3)/4 at 1 N and none at 3 N: their mean times the load is 1/6 N."""
    found = working_variances(np.array([[1.0, 10.0], [2.0, 10.0], [3.0, 10.0]]), np.array([1.0, 3.0]))
    assert found == pytest.approx([2.0**2 / 6, 10.0**2 / 18])


@pytest.mark.parametrize(("count", "correlation"), [(4, 0.5), (4, 3.0), (8, 1.5)])
def test_intervals_from_few_draws_cover(count: int, correlation: float) -> None:
    """A linear model, deviations that scatter as ``P^(-0.6)`` with any correlation in ln P: 95 % cover.

    400 twins: two standard deviations of their share are 2.2 %. Weights by the covariance of four draws
    cover 80 % instead.
    """
    rng, theta = np.random.default_rng(42), np.array([1.0, 1.0])
    slopes = np.stack([0.5 * SPAN ** (-1 / 3), np.full(len(SPAN), 0.1)], axis=1)
    middle = slopes @ theta
    correlations = np.exp(-np.abs(np.subtract.outer(np.log(SPAN), np.log(SPAN))) / correlation)
    scale = 0.2 * SPAN**-0.6 * middle
    root = np.linalg.cholesky(np.outer(scale, scale) * correlations)
    covered = []
    for _ in range(400):
        pair, mu = (middle + rng.standard_normal((n, len(SPAN))) @ root.T for n in (1, count))
        rows = [
            Row(load, m + u * rng.standard_normal(), u)
            for load, m, u in zip(SPAN, pair[0], 0.005 * middle, strict=True)
        ]
        responses = [_linear(m, row) for m, row in zip(mu.mean(axis=0), slopes, strict=True)]
        fitted = linear_fit(rows, responses, working_variances(mu, SPAN), deviations(mu), 0.0, 1)
        profile = profile_of(fitted, shares(rows, fitted, ()))
        half = np.sqrt(np.diag(profile.covariance)) * [profile.quantile(axis) for axis in np.eye(2)]
        covered.append(np.abs(fitted.free - theta) < half)
    assert np.min(np.mean(covered, axis=0)) > 0.925


def _linear(mu: float, slopes: np.ndarray) -> Response:
    """A response at (1, 1) without bars."""
    return Response((1.0, 1.0), mu, tuple(slopes), 0.0, 0.0, {}, 1.0, 0.0, 0.0, (), (), 1, ())


def test_tolerances_of_an_ensemble_are_means_over_its_draws() -> None:
    scene = read_scene("table1-rough")
    forward, theta, name = Forward(32), np.array([15e6, 0.08]), "lower.surface[0].rms"
    drawn = draws(forward, scene, theta, 3, {name: 0.3})
    assert len({one.inputs[name] for one in drawn}) == 3
    assert mean_response(drawn).inputs[name] == pytest.approx(np.mean([one.inputs[name] for one in drawn]))


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
