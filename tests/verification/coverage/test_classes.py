"""Bars and costs by class of scene: references and summaries, known values; the words of the pages."""

from __future__ import annotations

from itertools import product
from types import SimpleNamespace as Made

import numpy as np
import pytest

import refimpl as rf
from tests.documents import ROOT
from tests.refimpl.accuracy.made_up import AREA_LIMIT, BETA, DMU_DA, made_up
from verification.coverage import class_costs, classes
from verification.coverage.building import Solved, as_corrected
from verification.coverage.class_costs import SIZES, costs
from verification.coverage.class_scenes import CLASSES, scene
from verification.output.result_files import committed

MU = BETA + DMU_DA * AREA_LIMIT


def test_references_known_values() -> None:
    """A disc's limits, and their bounds: 0.12 of the edge."""
    fine = as_corrected(made_up(512))
    for name, limit, unit in (("contact_area", AREA_LIMIT, 1.0), ("friction_coefficient", MU, DMU_DA)):
        for number in (name, f"{name}_corrected"):
            value, bound = classes.reference(fine, number)
            assert (value, bound) == pytest.approx((limit, 0.12 * unit * fine.edge), rel=1e-9)
    assert classes.reference(fine, "max_pressure")[0] == fine.peak.height
    assert classes.reference(fine, "approach")[0] == fine.numbers["approach"]


def test_one_grid_of_a_scene_is_judged_and_an_exact_number_counts_first() -> None:
    """Seed 5 of three grids takes the third; the known area is a tenth larger than any grid's."""
    grids = tuple(as_corrected(made_up(M)) for M in (48, 64, 96, 512))
    exact = {"contact_area": 1.1 * AREA_LIMIT}
    found = {row["number"]: row for row in classes.rows([Solved("few elements", 5, grids, exact)])}
    assert {row["M"] for row in found.values()} == {96}
    assert found["contact_area_corrected"]["error"] == pytest.approx(0.1, rel=1e-6)
    assert found["friction_coefficient_corrected"]["error"] < 1e-6
    assert not found["contact_area"]["too_large"]


def test_a_summary_counts_bars_known_values() -> None:
    """Four scenes; all bars but the third hold."""
    ends = (0.4, 0.1, 0.1), (0.2, 0.2, 0.1), (0.1, 0.3, 0.0), (9.126, 1.0, 1.0)
    keys = "bar", "error", "reference_bound"
    every = classes.summary(dict(zip(keys, row, strict=True)) | {"too_large": True} for row in ends)
    assert [every[key] for key in ("scenes", "held", "held_at_worst", "usable")] == [4, 0.75, 0.5, 0.75]
    assert (every["held_of_usable"], every["median_bar_over_error"]) == pytest.approx((2 / 3, 2.5), rel=1e-5)
    assert every["bias_over_bar"] == pytest.approx(1.6 / 9.826, rel=1e-5)
    assert every["p"] == pytest.approx(1 - 0.92**4, rel=1e-5)  # probability of three of four, or fewer
    assert (every["longest_miss"], every["unbounded"]) == (pytest.approx(3.0), 0.0)


def test_bars_that_hold_more_often_than_they_need_are_no_failure() -> None:
    """All of 100: p is 1, for only too few count. 90 of 100: P(at most 90, each at 92 %) is 0.2780."""
    row = {"error": 0.1, "bar": 0.2, "reference_bound": 0.0, "too_large": True}
    missed = row | {"error": 0.3}
    assert classes.summary(100 * [row])["p"] == pytest.approx(1.0)
    assert classes.summary(90 * [row] + 10 * [missed])["p"] == pytest.approx(0.2780, abs=5e-5)


def test_a_summary_of_costs_known_values() -> None:
    """Three costs, of 1, 3 and 2; forecasts over last grids of 0.5, 3 and 1.25, none where not met."""
    columns = ("cost", "forecast", "last", "met", "work")
    made = (
        (1.0, 64, 128, True, 8.0), (3.0, 384, 128, True, 6.0), (2.0, 120, 96, True, 4.0),
        (None, 256, 512, False, None),
    )  # fmt: skip
    assert class_costs.summary([dict(zip(columns, row, strict=True)) for row in made]) == {
        "scenes": 4,
        "met": 0.75,
        "compared": 3,
        "median_cost": 2.0,
        "cost_at_most_2": pytest.approx(2 / 3),
        "median_work": 7.0,  # between 6 and 8: what is not met takes more
        "median_forecast_over_last": 1.25,
        "forecast_within_2": pytest.approx(2 / 3),
    }


def test_a_coarse_grid_that_is_right_by_chance_is_not_the_cheapest(monkeypatch: pytest.MonkeyPatch) -> None:
    """Mu of 1 to 0.01: so are 32 and 96 elements, but 64 between them are not. A to 0.05 by all."""
    mu = {32: 1.005, 64: 1.05, 96: 0.991, 128: 1.0, class_costs.REFERENCE: 1.0}

    def solved(one: rf.Scene, grid: int = 96, **_: object) -> Made:
        found = Made(
            friction_coefficient_corrected=mu[grid],
            friction_coefficient=1.0,
            contact_area_corrected=2e-6,
            cost=Made(point_logs=float(grid**2)),
            status=rf.Status.CONVERGED,
            converged=True,
        )
        found.details = Made(features=found, problem=Made(grid=Made(shape=(48, grid))))
        return found

    monkeypatch.setattr(class_costs, "SIZES", [32, 64, 96, 128])
    monkeypatch.setattr(class_costs.rf, "solve", solved)
    monkeypatch.setattr(class_costs, "reference", lambda s, name: (getattr(s, name), 0.0))
    monkeypatch.setattr(class_costs, "Options", lambda **_: Made(plan=lambda _: None))
    monkeypatch.setattr(class_costs, "forecast", lambda *_: Made(refusal="no grid", grid=None))
    by_mu, _, by_area = costs(rf.read_scene("table1-smooth"))
    assert (by_mu["cheapest"], by_mu["cost"], by_mu["last"], by_mu["met"]) == (96, 1.0, 96, True)
    assert by_mu["work"] == 96**2
    assert (by_area["cheapest"], by_area["cost"]) == (32, 9.0)
    assert by_mu["forecast"] is None


def test_a_smooth_ball_costs_about_the_cheapest_grid() -> None:
    """The smooth ball of Table 1: mu to 0.01 takes few elements, and the forecast names the last grid."""
    mu = next(row for row in costs(rf.read_scene("table1-smooth")) if row["number"].startswith("friction"))
    assert mu["met"]
    assert mu["last"] <= mu["cheapest"] == SIZES[0]  # the grids that open the refinement suffice
    assert 0.5 <= mu["forecast"] / mu["last"] <= 2
    assert mu["cost"] > 0  # below 1 where the last grid starts from the opening's answer


def test_the_words_of_the_page_follow_from_the_committed_costs() -> None:
    study = committed("class_costs")
    rows, ratios = study["rows"], list(class_costs.work_ratios(study["table"]).values())
    costs = [row["cost"] for row in rows if row["number"] == "friction_coefficient_corrected" and row["cost"]]
    median, tail, most = np.median(costs), np.percentile(costs, 90), max(costs)
    words = f"is {median:.1f} in the median", f"{tail:.1f} at the 90th percentile", f"{most:.0f} at most"
    words += (f"takes {np.median(ratios):.2f} of the work of that of the summed mu",)
    words += (f"in the median of {len(ratios)} classes",)
    page = " ".join((ROOT / "docs/error-bars.md").read_text(encoding="utf-8").split())
    assert [each for each in words if each not in page] == []


@pytest.mark.nightly
def test_the_reference_is_where_the_summed_mu_goes() -> None:
    """Richardson's extrapolation from 512 and 1024 has an error of order h as its only premise.

    Its own scatter is in the differences, in bars on 96 elements: their mean would show the rule's bias.
    """
    off = []
    for kind, seed in product(CLASSES, range(960000, 960003)):
        coarse, fine, finest = (rf.solve(scene(kind, seed), M) for M in (96, 512, 1024))
        found, _ = classes.reference(fine.details.features, "friction_coefficient")
        limit = 2 * finest.friction_coefficient - fine.friction_coefficient
        off.append((found - limit) / coarse.error("friction_coefficient_corrected"))
    assert abs(np.mean(off)) < 0.05
    assert np.median(np.abs(off)) < 0.1
    assert np.quantile(np.abs(off), 0.95) < 0.35
