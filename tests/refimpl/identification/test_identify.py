"""Identification against known friction, likelihoods in closed form, realisations, refusals."""

from __future__ import annotations

import math
from dataclasses import asdict, replace
from typing import Any

import numpy as np
import pytest

import refimpl as rf
from refimpl.errors import InputError
from refimpl.identification import Row, identify
from refimpl.identification.design import propose
from refimpl.identification.ensemble import mean_response, scatter, working_variances
from refimpl.identification.fit import linear_fit, profile_of, shares
from refimpl.identification.forward import COVERAGE, Response
from refimpl.identification.laws import _law
from refimpl.identification.profile import Profile, VaryingProfile
from refimpl.scene.scene_file import read_scene

LOADS = 5.0, 10.0, 20.0, 40.0, 80.0
M = 32


def _rows(scene: rf.Scene, relative: float, loads: tuple[float, ...] = LOADS, grid: int = M) -> list[Row]:
    """Friction of the model without noise."""
    found = []
    for load in loads:
        mu = rf.solve(replace(scene, load=load), grid).friction_coefficient_corrected
        found.append(Row(load, mu, relative * mu))
    return found


def _without_friction(scene: rf.Scene) -> rf.Scene:
    return replace(scene, friction=rf.Friction())


@pytest.fixture(scope="module")
def smooth() -> rf.Scene:
    return read_scene("table1-smooth")  # tau = 15 MPa, beta = 0.08


@pytest.fixture(scope="module")
def planes() -> rf.Scene:
    return read_scene("rough-planes")


def test_exact_data_give_the_parameters_back(smooth: rf.Scene) -> None:
    found = identify(_without_friction(smooth), _rows(smooth, 0.001), M)
    assert found.values["tau"].value == pytest.approx(15e6, rel=1e-3)
    assert found.values["beta"].value == pytest.approx(0.08, rel=1e-2)
    assert found.chi_square < 0.01
    assert found.solves <= 7 * len(LOADS)


def test_the_interval_of_an_inner_optimum_is_the_ellipse() -> None:
    profile = Profile(np.array([10.0, 20.0]), np.array([[1.0, -1.0], [-1.0, 4.0]]))
    assert profile.interval(np.array([1.0, 0.0])) == pytest.approx((10 - 1.96, 10 + 1.96), abs=1e-3)
    assert profile.interval(np.array([0.0, 1.0])) == pytest.approx((20 - 3.92, 20 + 3.92), abs=1e-3)
    # variance of the sum: 1 + 4 - 2 = 3
    assert profile.interval(np.array([1.0, 1.0])) == pytest.approx((30 - 3.3948, 30 + 3.3948), abs=1e-3)
    assert not profile.is_bounded


def test_the_interval_at_a_bound_is_the_profile() -> None:
    """Independent parameters, tau's optimum at -1: least misfit 1 at zero, so the end is sqrt(4.84) - 1."""
    profile = Profile(np.array([-1.0, 20.0]), np.eye(2))
    assert profile.optimum == pytest.approx([0.0, 20.0])
    assert profile.interval(np.array([1.0, 0.0])) == pytest.approx((0.0, 4.841459**0.5 - 1), abs=1e-5)
    assert profile.is_bounded


def test_flat_rough_planes_determine_a_combination(planes: rf.Scene) -> None:
    found = identify(planes, _rows(planes, 0.02, (4.0, 16.0), 64), 64)
    assert not found.is_identified
    assert "not determined apart from beta" in found.warnings[0]
    assert "measure at" in found.warnings[0]
    assert found.combination.relative < 0.1 < found.values["tau"].relative
    truth = found.factor * 15e6 + 0.08
    assert found.combination.low < truth < found.combination.high


def test_a_tolerance_adds_to_the_uncertainty(smooth: rf.Scene) -> None:
    """Hertz: A ~ E^(-2/3), so tau found from tau A is off by 2/3 of E's share of the pair's compliance."""
    rows = _rows(smooth, 0.01, (20.0, 40.0, 80.0), 96)  # areas are counted: 48 elements a side err by a tenth
    found = identify(smooth, rows, 96, tolerances={"lower.material.E": 0.1}, design=False)
    alone = 0.1 / 1.96 * 2 / 3 * (1 / 118) / (1 / 118 + 1 / 200)
    assert found.shares["input lower.material.E"][0] / 15e6 == pytest.approx(alone, rel=0.1)


@pytest.mark.parametrize(
    ("friction", "law"), [(rf.Friction(beta=0.2), "Coulomb"), (rf.Friction(tau=15e6), "constant shear")]
)
def test_data_of_a_simpler_law_prefer_it(smooth: rf.Scene, friction: rf.Friction, law: str) -> None:
    rows = _rows(replace(smooth, friction=friction), 0.01, (10.0, 40.0, 80.0))
    found = identify(_without_friction(smooth), rows, M, design=False)
    (name,), (value,) = zip(*found.laws[0].parameters.items(), strict=True)
    assert found.laws[0].name == law
    assert value == pytest.approx(getattr(friction, name), rel=1e-3)
    if law == "Coulomb":
        assert found.values["tau"].low == 0.0
        assert found.method == "profile likelihood"


def _yielding(smooth: rf.Scene, hardness: float) -> rf.Scene:
    return replace(
        smooth, lower=replace(smooth.lower, material=rf.Material(E=118e9, nu=0.3, hardness=hardness))
    )


def test_the_hardness_is_given_back_from_a_wrong_guess(smooth: rf.Scene) -> None:
    """p_max of the elastic contact is 0.17 GPa at 70 N: 0.1 GPa yields at the larger loads alone."""
    loads, grid = (5.0, 20.0, 40.0, 80.0), 16
    rows = _rows(_yielding(smooth, 100e6), 0.002, loads, grid)
    found = identify(_yielding(_without_friction(smooth), 130e6), rows, grid, fit=["hardness"], design=False)
    hardness = found.values["lower.material.hardness"]
    assert hardness.value == pytest.approx(100e6, rel=0.02)
    assert found.values["tau"].value == pytest.approx(15e6, rel=0.02)
    assert hardness.low < 100e6 < hardness.high
    assert found.covariance.shape == (3, 3)
    assert found.degrees == len(loads) - 3
    assert all(len(part) == 3 for part in found.shares.values())


def test_parameters_to_fit_are_checked(smooth: rf.Scene) -> None:
    rows, both = _rows(smooth, 0.01), _yielding(smooth, 1e8)
    both = replace(both, upper=replace(both.upper, material=both.lower.material))
    yields, fitted = _yielding(smooth, 1e8), {"fit": ["hardness"]}
    for scene, given, message in (
        (smooth, fitted, "a scene with a hardness"),
        (smooth, {"fit": ["tau"]}, "one of hardness"),
        (smooth, {"fit": "hardness"}, "a list of names"),
        (smooth, {"fit": ["roughness"]}, r"friction hardly determines; give it in \[tolerances\]"),
        (smooth, {"fit": ["lower.surface[0].rms"]}, r"friction hardly determines; give it in \[tolerances\]"),
        (smooth, {"tolerances": {"friction.tau": 0.1}}, r"friction\.tau"),
        (smooth, {"realisations": 5}, "realisations"),
        (both, fitted, "two hardnesses that differ"),
        (yields, {"fit": ["hardness", "lower.material.hardness"]}, "each parameter once"),
        (yields, fitted | {"tolerances": {"lower.material.hardness": 0.1}}, "parameter that is fitted"),
    ):
        with pytest.raises(InputError, match=message):
            identify(scene, rows, M, **given)  # type: ignore[arg-type]  # wrong on purpose
    with pytest.raises(InputError, match="at least 3 different loads"):
        identify(yields, rows[:2], M, fit=["hardness"])


def test_a_profile_with_a_free_third_parameter() -> None:
    """Independent parameters, the third below zero: its interval ends there as well, tau's at its bound."""
    profile = Profile(np.array([-1.0, 20.0, -3.0]), np.eye(3))
    assert profile.optimum == pytest.approx([0.0, 20.0, -3.0])
    assert profile.interval(np.array([0.0, 0.0, 1.0])) == pytest.approx((-4.959964, -1.040036), abs=1e-5)
    assert profile.interval(np.array([1.0, 0.0, 0.0])) == pytest.approx((0.0, 4.841459**0.5 - 1), abs=1e-5)
    # sum of the second and the third: 17 +- 1.96 sqrt(2)
    assert profile.interval(np.array([0.0, 1.0, 1.0])) == pytest.approx((14.2282, 19.7718), abs=1e-3)


def test_few_draws_widen_the_interval_by_students_t() -> None:
    """Half of the variance has 2 degrees of freedom, so the whole has 8: t is 2.306004."""
    half = np.diag([0.5, 0.5])
    profile = Profile(np.array([10.0, 20.0]), 2 * half, half, 2)
    assert profile.interval(np.array([1.0, 0.0])) == pytest.approx((10 - 2.306004, 10 + 2.306004), abs=1e-5)
    whole = Profile(np.array([10.0, 20.0]), 2 * half, 2 * half, 2)
    assert whole.interval(np.array([1.0, 0.0])) == pytest.approx((10 - 4.302653, 10 + 4.302653), abs=1e-5)


MADE: dict[str, Any] = {
    "at": (2.0, 1.0), "mu": 0.3, "slopes": (1.0, 0.0), "contact_edge": 0.01,
    "numerical": 0.04 * COVERAGE, "shared": 0.02 * COVERAGE,
    "inputs": {}, "contact_fraction": 0.3, "border": 0.0, "plastic": 0.1, "pressures": (1e6, 2e6),
    "weights": (3e-7, 4e-7), "solves": 3, "warnings": ("steep",),
}  # fmt: skip


def response(**changes: Any) -> Response:
    return Response(**{**MADE, **changes})


def test_criteria_of_a_law_count_its_own_and_the_further_parameters() -> None:
    """Six rows, one parameter and one further: 3 + 2 * 2 and 3 + 2 ln 6."""
    law = _law("Coulomb", {"beta": 0.2}, 3.0, 6, further=1)
    assert (law.aic, law.bic) == (pytest.approx(7.0), pytest.approx(3 + 2 * math.log(6)))


def test_a_proposed_load_is_as_uncertain_as_its_measurement_bar_and_surface() -> None:
    """hypot(0.1 * 0.3, 0.04, 0.12) = 0.13, beside a variance of 4 of tau, which is 2."""
    theta, covariance = np.array([2.0, 1.0]), np.diag([4.0, 0.25])
    found = propose(theta, covariance, [(7.0, response(scatter=0.12))], relative=0.1)
    assert found is not None
    tau = COVERAGE / math.sqrt(1 / 4 + 1 / 0.13**2) / 2
    assert (found.loads, found.widths) == ((7.0,), (pytest.approx(tau), pytest.approx(COVERAGE * 0.5)))
    assert propose(theta, covariance, [], relative=0.1) is None


def test_a_mean_over_realisations_has_the_worst_border_and_all_warnings() -> None:
    """Means, but for the largest shares of a contact, the sum of solves, and half of each weight."""
    other = response(
        mu=0.5, slopes=(3.0, 1.0), numerical=0.08 * COVERAGE, shared=0.04 * COVERAGE,
        contact_edge=0.03, contact_fraction=0.5, border=0.2, plastic=0.0,
        pressures=(5e6,), weights=(8e-7,), solves=4, warnings=("steep", "plastic"),
    )  # fmt: skip
    found = asdict(mean_response([response(), other]))
    # one pair about a mean of two: 0.2 / sqrt(2) * sqrt(1 + 1/2)
    assert found.pop("scatter") == pytest.approx(math.sqrt(0.03))
    expected = {
        **MADE, "mu": 0.4, "slopes": (2.0, 0.5), "contact_edge": 0.02,
        "numerical": 0.06 * COVERAGE, "shared": 0.03 * COVERAGE,
        "contact_fraction": 0.4, "border": 0.2, "plastic": 0.1, "pressures": (1e6, 2e6, 5e6),
        "weights": (1.5e-7, 2e-7, 4e-7), "solves": 7, "warnings": ("steep", "plastic"),
    }  # fmt: skip
    for name, value in expected.items():
        numeric = not isinstance(value, dict) and name != "warnings"
        assert found[name] == (pytest.approx(value) if numeric else value), name


def test_all_rows_share_the_error_of_an_input() -> None:
    """Two rows that have one parameter each: their errors of 0.3 and -0.4 go together."""
    rows = [Row(1.0, 0.5, 0.1), Row(2.0, 0.7, 0.2)]
    made = [response(at=(0.0, 0.0), mu=0.0, slopes=slopes) for slopes in ((1.0, 0.0), (0.0, 1.0))]
    alone = scatter([[one] for one in made])  # one draw has no scatter
    fitted = linear_fit(rows, made, np.zeros((2, 2)), alone, away=0.0, passes=1)
    inputs = [{"load": 0.3 * COVERAGE}, {"load": -0.4 * COVERAGE}]
    found = shares(rows, fitted, inputs)
    assert found["input load"] == pytest.approx(np.array([[0.09, -0.12], [-0.12, 0.16]]), rel=1e-8)
    assert found["measurement"] == pytest.approx(np.diag([0.01, 0.04]), rel=1e-8, abs=1e-10)
    # of the bars 0.04 both rows share 0.02
    assert found["numerical"] == pytest.approx(np.array([[16e-4, 4e-4], [4e-4, 16e-4]]), rel=1e-8)
    assert fitted.theta == pytest.approx([0.5, 0.7], rel=1e-8)


def test_a_wrong_row_is_named_and_dropped_and_two_wrong_rows_are_named(smooth: rf.Scene) -> None:
    """Off by 12 standard uncertainties of 1 %, before the uncertainty of the fit to four rows."""
    rows = _rows(smooth, 0.01)
    rows[2] = replace(rows[2], mu=1.12 * rows[2].mu)
    found = identify(_without_friction(smooth), rows, M, design=False)
    assert (found.outliers, found.fitted.dropped, found.degrees) == ((2,), 2, 2)
    assert found.values["tau"].value == pytest.approx(15e6, rel=1e-3)
    assert "row 3 (20 N) is off by +" in found.warnings[0]
    assert found.deleted[2] > 6
    rows[4] = replace(rows[4], mu=0.7 * rows[4].mu)
    both = identify(_without_friction(smooth), rows, M, design=False)
    assert both.fitted.dropped is None
    assert {2, 4} <= set(both.outliers)


def test_a_load_above_what_the_softer_body_bears_is_named_by_its_row(smooth: rf.Scene) -> None:
    rows = [replace(row, load=load) for row in _rows(smooth, 0.01, (20.0, 40.0)) for load in (20.0, 4000.0)]
    soft = replace(smooth, lower=rf.Body(rf.Material(118e9, 0.3, hardness=0.8e9), smooth.lower.surface))
    said = r"load of row 2 = 4000.0: expected N \(mN, kN mixed\?\), at most"
    with pytest.raises(rf.InputError, match=said):
        identify(soft, rows, M, design=False)


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


def _linear(mu: float, slopes: tuple[float, float]) -> Response:
    """A response at (1, 1) without bars."""
    return Response((1.0, 1.0), mu, slopes, 0.0, 0.0, 0.0, {}, 1.0, 0.0, 0.0, (), (), 1, ())


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
    for load in (2.0, 20.0, 60.0):
        mu = rf.solve(replace(pair, load=load), 48).friction_coefficient
        rows.append(Row(load, mu, 0.001 * mu))
    blind = replace(scene, friction=rf.Friction())
    found = identify(blind, rows, 48, loads=(2.0,), realisations=3, design=False)
    assert found.values["tau"].low < scene.friction.tau < found.values["tau"].high
    assert found.values["beta"].low < scene.friction.beta < found.values["beta"].high
    assert found.shares["realisations"][0] > found.shares["measurement"][0]
    assert found.predictions[-1].mu.low < rows[0].mu < found.predictions[-1].mu.high


SPAN = np.geomspace(1.0, 200.0, 9)  # N


def test_intervals_from_few_draws_cover() -> None:
    """Areas that scatter as ``P^(-0.6)``, with a correlation in ln P: 95 % cover.

    300 twins: two standard deviations of their share are 2.5 %. Weights by the covariance of four draws
    cover 80 % instead.
    """
    count, correlation = 4, 3.0
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
