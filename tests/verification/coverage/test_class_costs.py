"""Costs by class: the cheapest grid known afterwards, a summary by hand, and README's words."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

import refimpl as rf
from reports.result_files import committed
from verification.coverage import class_costs
from verification.coverage.class_costs import SIZES, costs, summary


def row(cost: float | None, forecast: int | None, last: int, *, met: bool = True) -> dict[str, object]:
    return {"cost": cost, "forecast": forecast, "last": last, "met": met}


def test_a_summary_by_hand() -> None:
    """Three costs, of 1, 3 and 2; forecasts over last grids of 0.5, 3 and 1.25, none where not met."""
    rows = [row(1.0, 64, 128), row(3.0, 384, 128), row(2.0, 120, 96), row(None, 256, 512, met=False)]
    assert summary(rows) == {
        "scenes": 4,
        "met": 0.75,
        "compared": 3,
        "median_cost": 2.0,
        "cost_at_most_2": pytest.approx(2 / 3),
        "median_forecast_over_last": 1.25,
        "forecast_within_2": pytest.approx(2 / 3),
    }


def test_a_coarse_grid_that_is_right_by_chance_is_not_the_cheapest(monkeypatch: pytest.MonkeyPatch) -> None:
    """Mu of 1 to 0.02: so are 32 and 96 elements, but 64 between them are not. A to 0.05 by all."""
    mu = {32: 1.01, 64: 1.05, 96: 0.981, 128: 1.0, class_costs.REFERENCE: 1.0}

    def solved(one: rf.Scene, grid: int = 96, **_: object) -> SimpleNamespace:
        return SimpleNamespace(
            friction_coefficient=mu[grid],
            contact_area_corrected=2e-6,
            cost=SimpleNamespace(point_logs=float(grid**2)),
            problem=SimpleNamespace(grid=SimpleNamespace(shape=(48, grid))),
            status=rf.Status.CONVERGED,
            converged=True,
        )

    monkeypatch.setattr(class_costs, "SIZES", [32, 64, 96, 128])
    monkeypatch.setattr(class_costs.rf, "solve", solved)
    monkeypatch.setattr(class_costs, "reference", lambda s, name: (getattr(s, name), 0.0))
    monkeypatch.setattr(class_costs, "Options", lambda **_: SimpleNamespace(plan=lambda _: None))
    refused = SimpleNamespace(refusal="no grid", grid=None)
    monkeypatch.setattr(class_costs, "forecast", lambda *_: refused)
    by_mu, by_area = costs(rf.read_scene("table1-smooth"))
    assert (by_mu["cheapest"], by_mu["cost"], by_mu["last"], by_mu["met"]) == (96, 1.0, 96, True)
    assert (by_area["cheapest"], by_area["cost"]) == (32, 9.0)
    assert by_mu["forecast"] is None


def test_a_smooth_ball_costs_about_the_cheapest_grid() -> None:
    """The smooth ball of Table 1: mu to 0.02 takes few elements, and the forecast names the last grid."""
    by_number = {found["number"]: found for found in costs(rf.read_scene("table1-smooth"))}
    mu = by_number["friction_coefficient"]
    assert mu["met"]
    assert mu["cheapest"] in SIZES
    assert mu["last"] >= mu["cheapest"]
    assert 0.5 <= mu["forecast"] / mu["last"] <= 2
    assert mu["cost"] > 0  # below 1 where the last grid starts from the opening's answer


def test_the_readmes_words_follow_from_the_committed_table() -> None:
    found = [one for one in committed("class_costs")["table"] if one["median_cost"] is not None]
    medians = [one["median_cost"] for one in found]
    assert f"{min(medians):.1f}" == "0.7"
    assert f"{max(medians):.1f}" == "1.6"
    assert min(one["forecast_within_2"] for one in found) >= 0.94
