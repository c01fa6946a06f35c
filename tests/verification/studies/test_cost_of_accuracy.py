"""Cost of an accuracy: the table by class of scene, and `rough-friction tradeoff` for one scene."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import refimpl as rf
from reports.studies.accuracy_costs import build
from tests.changed import changed
from verification.benchmarks import cost_of_accuracy
from verification.benchmarks.cost_of_accuracy import LOWER, class_scene, costs, solve_grids
from verification.cli import main
from verification.output.result_files import committed, read_result

MU = "friction_coefficient_corrected"
QUANTITIES = {MU, "contact_area_corrected", "max_pressure"}


@pytest.mark.parametrize("scene", ["hertz", "rough-planes"])
def test_a_scene_has_a_table(scene: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Without friction mu is zero and has no relative error."""
    out = tmp_path / "t.json"
    assert main(["tradeoff", scene, "--grids", "12,8", "--reference", "32", "--json", str(out)]) == 0
    found, printed = json.loads(out.read_text()), capsys.readouterr().out
    quantities = QUANTITIES - ({MU} if scene == "hertz" else set())
    assert [row["M"] for row in found["grids"]] == [8, 12, 16]  # half the reference's too
    assert all(set(row[key]) == quantities for row in found["grids"] for key in ("errors", "bars"))
    assert all({row["quantity"] for row in found[key]} == quantities for key in ("prices", "shown"))
    assert all(name in printed for name in (*quantities, "error met (known", "error bar shows it"))


def test_the_errors_contain_the_references_own_bar_and_the_bars_are_the_grids() -> None:
    scene = rf.read_scene("table1-smooth")
    (row,), coarse, fine = solve_grids(scene, [16], 32), rf.solve(scene, grid=16), rf.solve(scene, grid=32)
    exact, bar = fine.friction_coefficient_corrected, fine.error(MU)
    assert bar
    off = abs(coarse.friction_coefficient_corrected - exact)
    assert row["errors"][MU] == pytest.approx((off + bar) / exact, rel=1e-12)
    assert row["bars"][MU] == pytest.approx(coarse.error(MU) / exact, rel=1e-12)


def test_a_demand_is_met_by_the_error_before_the_bar_shows_it() -> None:
    rows = [
        {"M": M, "transforms of 256": M, "seconds": 1.0, "errors": {MU: error}, "bars": {MU: bar}}
        for M, error, bar in ((32, 0.02, 0.2), (64, 0.009, 0.05), (128, 0.004, 0.009))
    ]
    met, shown = ([row["M"] for row in costs([rows], key)] for key in ("errors", "bars"))
    assert (met, shown) == ([32, 32, 64, None], [64, 128, 128, None])  # of 10, 3, 1 and 0.3 %


def test_an_unsettled_grid_meets_no_demand_and_an_unsettled_reference_judges_nothing(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    solve = rf.solve

    def stagnates(at: int) -> None:
        def solved(scene: rf.Scene, grid: int) -> rf.Solution:
            status = {at: rf.Status.STAGNATED}.get(grid, rf.Status.CONVERGED)
            return changed(solve(scene, grid), status=status)

        monkeypatch.setattr(cost_of_accuracy.rf, "solve", solved)

    stagnates(16)
    coarse, fine = solve_grids(rf.read_scene("hertz"), [8, 16], 32)
    name = "contact_area_corrected"
    assert coarse["errors"][name] < float("inf") == fine["errors"][name]
    assert costs([[coarse, fine]])[0]["M"] is None
    stagnates(32)
    out = tmp_path / "t.json"
    assert main(["tradeoff", "hertz", "--grids", "8", "--reference", "32", "--json", str(out)]) == 1
    assert "the reference on 32 elements a side ends in 'stagnated'" in capsys.readouterr().err
    assert not out.exists()


@pytest.mark.parametrize(("reference", "status"), [("30", 2), ("33", 2)])
def test_a_reference_is_even_and_twice_as_fine(reference: str, status: int) -> None:
    assert main(["tradeoff", "hertz", "--grids", "16,8", "--reference", reference]) == status


def test_the_command_makes_the_committed_document(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cost_of_accuracy, "solve_grids", lambda scene: solve_grids(scene, (16, 24), 32))
    monkeypatch.setattr(cost_of_accuracy, "SEEDS", (1,))
    cost_of_accuracy.main(["--json", str(tmp_path / "costs.json")])
    made = read_result(tmp_path / "costs.json")
    stored = committed("accuracy_costs")
    assert [one["class"] for one in made["classes"]] == [one["class"] for one in stored["classes"]]
    assert made["classes"][0]["prices"][0].keys() == stored["classes"][0]["prices"][0].keys()
    (table,) = build(made).tables
    assert len(table.rows) == 3 * len(LOWER)


def test_seeds_of_the_smooth_ball_shift_the_grid() -> None:
    first, second = (class_scene("smooth ball", seed) for seed in (1, 2))
    assert second.lengths[0] - first.lengths[0] == pytest.approx(first.lengths[0] / 32 / 3)
