"""Twins of an identification: drawn from their seed alone, and counted as they should be."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from refimpl import Scene
from reports.result_files import committed
from verification.coverage import twins
from verification.coverage.identification import LEVEL, SETS, TwinSet, judged, study, summary
from verification.coverage.twins import SHARP_NOISE, Twin, sharp_twin, twin

ROW: dict[str, object] = {
    "kind": "ball",
    "loads": 4,
    "tau": True,
    "beta": True,
    "mu": True,
    "tau_half_width": 0.1,
    "tau_error": -0.02,
    "warned": False,
    "solves": 9,
}


def test_warnings_are_counted_by_the_width_of_the_interval() -> None:
    rows: list[dict[str, object]] = [
        ROW,
        ROW | {"tau_half_width": 0.3, "warned": True, "tau": False, "tau_error": 2.0},
        ROW | {"tau_half_width": None},
        ROW | {"tau_half_width": 0.04, "warned": True, "tau_error": 0.01, "solves": 17},
        ROW | {"tau_half_width": 0.02, "tau_error": 0.03},
        {"failure": "the solve at 1 N ended as stagnated"},
    ]
    found = summary(rows)
    assert (found["twins"], found["failures"], found["warned"]) == (6, 1, 2)
    assert found["coverage"] == {"tau": 0.8, "beta": 1.0, "mu": 1.0}
    assert (found["wide"], found["wide_without_warning"]) == (2, 1)
    assert (found["narrow"], found["narrow_whole"], found["narrow_with_warning"]) == (2, 1, 1)
    assert found["unwarned_tau_error"] == pytest.approx(0.03)
    assert found["most_solves_per_load"] == pytest.approx(4.0)


def test_a_twin_follows_from_its_seed() -> None:
    first, again = twin(5000), twin(5000)
    assert (first.rows, first.new_mu) == (again.rows, again.new_mu)
    assert 3 <= len(first.rows) <= 12
    assert 0.005 <= first.noise <= 0.05


def test_sharp_twins_span_two_to_three_decades() -> None:
    case = sharp_twin(1)
    decades = math.log10(case.rows[-1].load / case.rows[0].load)
    assert 2 <= decades <= 3
    assert case.noise == SHARP_NOISE
    assert case.scene.lower.material.hardness is not None  # odd seeds are capped


def test_sets_share_no_seed() -> None:
    seeds = [seed for one in SETS.values() for seed in one.seeds]
    assert len(seeds) == len(set(seeds))
    assert len(SETS["drawn"].seeds) >= 300


def test_a_twin_without_a_converged_solve_counts_as_a_failure() -> None:
    def impossible(seed: int) -> Twin:
        raise ArithmeticError(f"the solve of {seed} ended as stagnated")

    assert study(TwinSet(range(3, 4), impossible)) == [
        {"seed": 3, "failure": "the solve of 3 ended as stagnated"}
    ]


def test_finished_twins_are_read_from_the_log(tmp_path: Path) -> None:
    """Seeds 3 and 4 are made once, whatever the order of the runs; others of the log do not count."""
    made: list[int] = []

    def impossible(seed: int) -> Twin:
        made.append(seed)
        raise ArithmeticError(str(seed))

    log, twins = tmp_path / "log", TwinSet(range(3, 6), impossible)
    assert [row["seed"] for row in study(twins, log, [4, 3])] == [3, 4]
    assert [row["seed"] for row in study(twins, log)] == [3, 4, 5]
    assert [row["seed"] for row in study(twins, log, [5])] == [5]
    assert made == [3, 4, 5]


@pytest.mark.parametrize("seed", [7000, 7001])
def test_a_hardness_to_fit_is_wrong_in_the_scene_and_right_in_the_rows(
    seed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    solved: list[float | None] = []

    def friction(scene: Scene, load: float, grid: int) -> float:
        solved.append(scene.lower.material.hardness)
        return 0.1

    monkeypatch.setattr(twins, "true_friction", friction)
    case = twins.yielding_twin(seed)
    assert set(solved) == {case.further}
    assert case.further is not None
    assert case.scene.lower.material.hardness is not None
    off = case.scene.lower.material.hardness / case.further
    assert 0.7 <= off <= 1.4
    assert abs(off - 1) > 1e-3


def test_a_fit_of_a_twin_covers_its_truth() -> None:
    found = judged(SETS["drawn"], 5009)
    assert (found["tau"], found["beta"], found["mu"], found["warned"]) == (True, True, True, True)


def test_committed_intervals_cover_in_92_per_cent_of_all_twins() -> None:
    """The full tier judges every third twin; what is claimed rests on all of them."""
    found = committed("identification")
    for name in ("drawn", "sharp", "hardness", "roughness"):
        row = found[name]["summary"]
        assert row["twins"] == len(SETS[name].seeds)
        assert min(row["coverage"].values()) >= LEVEL
        assert row["wide_without_warning"] == row["narrow_with_warning"] == row["failures"] == 0


def test_tau_that_is_too_small_is_an_error_too() -> None:
    assert summary([ROW | {"tau_error": -0.5}, ROW | {"tau_error": 0.2}])["unwarned_tau_error"] == 0.5
