"""Realisations of a surface: their mean, and the scatter of one pair about it."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import refimpl as rf
from refimpl.identification import Row, identify
from refimpl.identification.ensemble import mean_response, scatter, working_variances
from refimpl.identification.fit import linear_fit, profile_of, shares
from refimpl.identification.forward import Response
from refimpl.identification.varying_profile import VaryingProfile
from refimpl.scene.scene_file import read_scene

SPAN = np.geomspace(1.0, 200.0, 9)  # N


def test_the_scatter_is_the_variance_of_another_draw_about_the_mean() -> None:
    """Three draws 1, 2, 3: variance 1, and 1 + 1/3 with the mean's; four times that at twice tau."""
    found = scatter([[_linear(mu, (mu, 0.0)) for mu in (1.0, 2.0, 3.0)]])
    assert found.degrees == 2
    for tau, factor in ((1.0, 1.0), (2.0, 4.0)):
        assert found.variance(np.eye(1), np.array([tau, 1.0]))[0, 0] == pytest.approx(factor * 4 / 3)


def test_the_relative_scatter_that_weighs_rows_falls_with_the_root_of_the_load() -> None:
    """Relative variances of the area (4/3)/4 at 1 N and none at 3 N: their mean times the load is 1/6 N."""
    drawn = [[_linear(2.0, (area, 0.0)) for area in (1.0, 2.0, 3.0)], [_linear(10.0, (5.0, 0.0))] * 3]
    found = working_variances(drawn, np.array([1.0, 3.0]))
    assert found == pytest.approx([2.0**2 / 6, 10.0**2 / 18])


@pytest.mark.parametrize(
    ("count", "correlation"), [(4, 3.0), pytest.param(8, 1.5, marks=pytest.mark.nightly)]
)
def test_intervals_from_few_draws_cover(count: int, correlation: float) -> None:
    """Areas that scatter as ``P^(-0.6)``, with any correlation in ln P: 95 % cover.

    300 twins: two standard deviations of their share are 2.5 %. Weights by the covariance of four draws
    cover 80 % instead.
    """
    rng, theta, beta = np.random.default_rng(42), np.array([1.0, 1.0]), np.full(len(SPAN), 0.1)
    area = 0.5 * SPAN ** (-1 / 3)
    correlations = np.exp(-np.abs(np.subtract.outer(np.log(SPAN), np.log(SPAN))) / correlation)
    scale = 0.3 * SPAN**-0.6 * area
    root = np.linalg.cholesky(np.outer(scale, scale) * correlations)
    covered = []
    for _ in range(300):
        areas = area + rng.standard_normal((count + 1, len(SPAN))) @ root.T
        noise = 0.005 * (area + beta)
        rows = [
            Row(load, a + b + u * rng.standard_normal(), u)
            for load, a, b, u in zip(SPAN, areas[0], beta, noise, strict=True)
        ]
        drawn = [[_linear(a + b, (a, b)) for a in row] for row, b in zip(areas[1:].T, beta, strict=True)]
        means = [mean_response(row) for row in drawn]
        fitted = linear_fit(rows, means, working_variances(drawn, SPAN), scatter(drawn), 0.0, 1)
        profile = profile_of(fitted, shares(rows, fitted, ()))
        assert isinstance(profile, VaryingProfile)
        excess = [profile.excess(axis, true) for axis, true in zip(np.eye(2), theta, strict=True)]
        covered.append(np.array(excess) <= 0)
    assert np.min(np.mean(covered, axis=0)) > 0.925


def _linear(mu: float, slopes: tuple[float, float]) -> Response:
    """A response at (1, 1) without bars."""
    return Response((1.0, 1.0), mu, slopes, 0.0, 0.0, {}, 1.0, 0.0, 0.0, (), (), 1, ())


def test_an_end_judged_by_its_own_scatter() -> None:
    """Variance ``(s tau)^2`` of tau about 1, many degrees: ends ``1 / (1 +- 1.96 s)``, infinite from 0.51."""
    for s, high in ((0.25, 1 / (1 - 0.489991)), (0.6, math.inf)):

        def estimated(theta: np.ndarray, s: float = s) -> np.ndarray:
            return np.diag([(s * theta[0]) ** 2, 0.0])

        profile = VaryingProfile(np.ones(2), 1e-8 * np.eye(2), estimated, 1e9, np.ones(2))
        low = 1 / (1 + 1.959964 * s)
        assert profile.interval(np.array([1.0, 0.0])) == pytest.approx((low, high), rel=1e-4)


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
