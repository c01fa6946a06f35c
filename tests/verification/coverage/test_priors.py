"""Priors fitted to numbers drawn from the model itself, and to a small store."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy import stats

from refimpl.accuracy import discretisation_error
from refimpl.accuracy.bayesian_line import Bias, Estimate, Prior, fit_line
from refimpl.accuracy.discretisation_error import (
    AREA,
    BINORMAL,
    BULK,
    EDGE_SIZE,
    EDGE_SIZE_SPREAD,
    OTHER,
    PEAK,
    PEAK_BIAS,
    PEAK_BIAS_SPREAD,
    SINGLE_EXCESS,
)
from refimpl.accuracy.first_contact import PEAK_ERROR
from refimpl.accuracy.refinement import FIRST_GRIDS
from reports.result_files import read_result
from tests.documents import ROOT
from verification.coverage import priors
from verification.coverage.priors import Numbers, fitted, log_likelihood
from verification.coverage.store import climb, ladders

DRAWN = {"size": 0.7, "spread": 0.1, "scatter": 0.2, "weight": 6.0}


def drawn(count: int, grids: int = 8) -> list[Numbers]:
    """Scenes of the model, each with a number, an edge and a scatter of its own."""
    rng = np.random.default_rng(11)
    weights, edge = 2.0 ** (1.5 * np.arange(grids)[::-1]), 5 * 2.0 ** np.arange(grids)[::-1]
    scenes = []
    for _ in range(count):
        sigma = DRAWN["scatter"] * np.sqrt(DRAWN["weight"] / rng.chisquare(DRAWN["weight"]))
        noise = sigma * weights * rng.standard_normal(grids)
        size = rng.normal(DRAWN["size"], DRAWN["spread"])
        scenes.append(Numbers(rng.normal(scale=1e3) + size * edge + noise, weights, edge))
    return scenes


def test_the_likeliest_parameters_are_those_drawn_from() -> None:
    scenes = drawn(300)
    found = fitted(lambda p: log_likelihood(scenes, *p), {**DRAWN, "scatter": 0.3})
    best = found["likeliest"]
    assert isinstance(best, dict)
    assert best["size"] == pytest.approx(0.7, abs=0.03)
    assert best["spread"] == pytest.approx(0.1, abs=0.03)
    assert best["scatter"] == pytest.approx(0.2, rel=0.1)
    assert found["given_away"] == pytest.approx(
        log_likelihood(scenes, *best.values()) - log_likelihood(scenes, 0.7, 0.1, 0.3, 6.0)
    )
    assert isinstance(found["given_away"], float)
    assert found["given_away"] > 20


def test_nine_nodes_leave_bars_that_many_more_hardly_move(monkeypatch: pytest.MonkeyPatch) -> None:
    prior, mean, spread = Prior(DRAWN["scatter"], DRAWN["weight"]), DRAWN["size"], DRAWN["spread"]

    def bars() -> np.ndarray:
        scenes = drawn(300, grids=3)
        found = [fit_line(s.values, s.weights, prior, Bias(s.edge, mean, spread)) for s in scenes]
        ends = [s.values[-1] for s in scenes]
        return np.array([estimate.error_bound(end) for estimate, end in zip(found, ends, strict=True)])

    nine, (nodes, weights) = bars(), np.polynomial.hermite_e.hermegauss(41)
    many = mean + spread * nodes, weights / weights.sum()
    monkeypatch.setattr("refimpl.accuracy.bayesian_line._factors", lambda *_: many)
    np.testing.assert_allclose(nine, bars(), rtol=0.015)


def test_the_likelihood_is_that_of_differences_by_hand() -> None:
    """Two grids, no edge: the difference is Student's, with the prior's weight for its freedom."""
    weights, scatter, weight = np.array([3.0, 1.0]), 0.2, 6.0
    far, near = (
        log_likelihood([Numbers(np.array([y, 5.0]), weights, np.zeros(2))], 0.0, 0.0, scatter, weight)
        for y in (7.0, 5.5)
    )
    scale = scatter * np.sqrt(10.0)
    ratio = ((1 + (2.0 / scale) ** 2 / weight) / (1 + (0.5 / scale) ** 2 / weight)) ** (-(weight + 1) / 2)
    assert far - near == pytest.approx(np.log(ratio))
    # and of whatever weights and scatter, up to one constant
    constants = [
        log_likelihood([Numbers(np.array([7.0, 5.0]), np.array(w), np.zeros(2))], 0.0, 0.0, s, n)
        - stats.t.logpdf(2.0, n, scale=s * np.hypot(*w))
        for w, s, n in (
            ([3.0, 1.0], 0.2, 6.0),
            ([2.0, 0.5], 0.2, 6.0),
            ([3.0, 1.0], 0.5, 6.0),
            ([1.5, 1.0], 0.3, 2.0),
        )
    ]
    np.testing.assert_allclose(constants, constants[0], atol=1e-12)


@pytest.mark.parametrize("seed", [3, 4, 5])
def test_the_model_fitted_is_the_one_that_bars_are_made_of(
    seed: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What the error bars hand to their lines, values, sizes and edges, is what priors are fitted to."""
    lines: list[tuple[np.ndarray, np.ndarray, np.ndarray]] = []

    def spied(values: np.ndarray, weights: np.ndarray, prior: Prior, bias: Bias | None = None) -> Estimate:
        edge = np.zeros_like(values) if bias is None else bias.sizes
        lines.append((values, weights * prior.scatter, edge))
        return fit_line(values, weights, prior, bias)

    store = tmp_path / "store.jsonl"
    climb(store, [seed], [*FIRST_GRIDS, 96])
    results = [rung.result for rung in ladders(store)[seed]]
    monkeypatch.setattr(discretisation_error, "fit_line", spied)
    discretisation_error.estimates(results)
    area, mu, force, peak, across, approach = lines
    load = results[-1].numbers["normal_force"]
    np.testing.assert_allclose(force[0], load * mu[0], rtol=1e-9)  # both of friction, of which one is fitted
    area_unit, peak_unit = (
        size[-1] / scatter for (_, size, _), scatter in ((area, AREA.scatter), (peak, PEAK.scatter))
    )
    for (values, size, edge), fitted_to, unit, scatter in (
        (area, priors.areas(results, SINGLE_EXCESS), area_unit, AREA.scatter),
        (mu, priors.rests(results, BULK.scatter, 1.0), 1.0, 1.0),
        (across, priors.binormals(results, BINORMAL.scatter, 1.0), load, 1.0),
        (peak, priors.peaks(results), peak_unit, PEAK.scatter),
        (approach, priors.approaches(results, OTHER.scatter, PEAK_ERROR), 1.0, 1.0),
    ):
        np.testing.assert_allclose(unit * fitted_to.values, values, rtol=1e-9)
        np.testing.assert_allclose(unit * fitted_to.edge, edge, rtol=1e-9)
        # to what solves leave beside them, which only the fit counts
        np.testing.assert_allclose(unit * scatter * fitted_to.weights, size, rtol=1e-3)


def test_a_store_is_fitted_and_written(tmp_path: Path) -> None:
    store, written = tmp_path / "store.jsonl", tmp_path / "priors.json"
    climb(store, range(4), [*FIRST_GRIDS, 96])
    priors.main(["--store", str(store), "--json", str(written)])
    found = read_result(written)
    assert found["scenes"] == len(ladders(store)) == 4
    assert found["area"]["adopted"]["edge_size"] == EDGE_SIZE
    assert found["area"]["adopted"]["edge_size_spread"] == EDGE_SIZE_SPREAD
    assert found["area"]["adopted"]["scatter"] == AREA.scatter
    for part in ("area", "friction_without_tau", "binormal", "peak", "approach"):
        assert found[part]["given_away"] >= 0
        assert all(value >= 0 for value in found[part]["likeliest"].values())
    assert found["provenance"]


def test_the_priors_in_use_are_those_of_the_committed_study() -> None:
    """Close to the likeliest of areas; peaks are held to vary up to twice as much, which self-affine ones do,
    and what is left more than that.
    """
    found = read_result(ROOT / "reports" / "results" / "priors.json")
    area, rest = found["area"], found["friction_without_tau"]
    adopted = [EDGE_SIZE, EDGE_SIZE_SPREAD, AREA.scatter, AREA.weight, SINGLE_EXCESS]
    assert list(area["adopted"].values()) == adopted
    assert list(rest["adopted"].values()) == [BULK.scatter, 1.0, BULK.weight]
    assert area["likeliest"]["edge_size"] == pytest.approx(EDGE_SIZE, abs=0.01)
    assert area["likeliest"]["edge_size_spread"] == pytest.approx(EDGE_SIZE_SPREAD, abs=0.01)
    assert area["likeliest"]["scatter"] == pytest.approx(AREA.scatter, rel=0.1)
    assert all(rest["likeliest"][name] < rest["adopted"][name] for name in ("bulk", "unevenness"))
    peak, approach = found["peak"], found["approach"]
    assert list(peak["adopted"].values()) == [PEAK_BIAS, PEAK_BIAS_SPREAD, *PEAK]
    assert peak["likeliest"]["summit"] == pytest.approx(PEAK_BIAS, abs=0.003)
    assert 0.5 * PEAK_BIAS_SPREAD < peak["likeliest"]["summit_spread"] < PEAK_BIAS_SPREAD
    assert 0.5 * PEAK.scatter < peak["likeliest"]["scatter"] < PEAK.scatter
    assert list(approach["adopted"].values()) == [OTHER.scatter, PEAK_ERROR, OTHER.weight]
    assert all(approach["likeliest"][name] < approach["adopted"][name] for name in ("other", "touch"))
    binormal = found["binormal"]
    assert list(binormal["adopted"].values()) == [BINORMAL.scatter, 1.0, BINORMAL.weight]
    assert all(binormal["likeliest"][name] < binormal["adopted"][name] for name in ("binormal", "unevenness"))
    assert binormal["likeliest"]["weight"] == pytest.approx(BINORMAL.weight, rel=0.2)
    assert found["scenes"] == 200


def test_a_store_without_scenes_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    written = tmp_path / "priors.json"
    with pytest.raises(SystemExit, match="2"):
        priors.main(["--store", str(tmp_path / "none.jsonl"), "--json", str(written)])
    assert "holds no scenes" in capsys.readouterr().err
    assert not written.exists()
