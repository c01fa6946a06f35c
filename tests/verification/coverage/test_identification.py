"""Synthetic tables of an identification: drawn from their seed alone, and counted as they should be."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from refimpl import Scene
from verification.coverage import synthetic_tables
from verification.coverage.identification import BIAS, LEVEL, SETS, TableSet, fitted, study, summary
from verification.coverage.synthetic_tables import (
    ERRORS,
    SyntheticTable,
    drawn_table,
)
from verification.output.result_files import committed

ROW: dict[str, Any] = dict.fromkeys(("tau", "beta", "mu"), True) | {
    "kind": "ball", "grid": 64, "error": "noise", "tau_half_width": 0.1, "tau_error": -0.02,
    "warned": False, "tau_deviation": 0.5, "named": False,
    "named_wrongly": 0, "dropped": None,
}  # fmt: skip


def test_warnings_are_counted_by_the_width_of_the_interval() -> None:
    rows: list[dict[str, Any]] = [
        ROW,
        ROW | {"tau_half_width": 0.3, "warned": True, "tau": False, "tau_error": 2.0},
        ROW | {"tau_half_width": None},
        ROW | {"tau_half_width": 0.04, "warned": True, "tau_error": 0.01},
        ROW | {"tau_half_width": 0.02, "tau_error": 0.03},
        {"failure": "the solve at 1 N ended as stagnated"},
        {"refused": "data: load", "kind": "ball", "grid": 64, "error": "unit slip"},
    ]
    found = summary(rows)
    assert (found["twins"], found["failures"], found["refused"], found["warned"]) == (7, 1, 1, 2)
    assert found["coverage"] == {"tau": 0.8, "beta": 1.0, "mu": 1.0}
    assert (found["wide"], found["wide_without_warning"]) == (2, 1)
    assert (found["narrow"], found["narrow_with_warning"]) == (2, 1)
    assert found["unwarned_tau_error"] == pytest.approx(0.03)


def test_wrong_rows_are_counted_where_they_are_named() -> None:
    wrong = {"error": "outlier", "grid": 128, "tau_deviation": -0.3}
    rows = [
        ROW,
        ROW | wrong | {"named": True, "dropped": True},
        ROW | wrong | {"tau": False, "named_wrongly": 2},
    ]
    found = summary([*rows, ROW | {"dropped": False}])
    assert (found["with_wrong_row"], found["wrong_row_named"]) == (2, 1)
    assert (found["rows_named_wrongly"], found["rows_dropped_wrongly"]) == (2, 1)
    assert [found["by_grid"][grid]["tau"] for grid in ("64", "128")] == [1.0, 0.5]
    assert found["by_error"]["outlier"]["tau"] == 0.5
    assert found["bias"] == pytest.approx(0.1)


def test_a_table_follows_from_its_seed_and_its_error_too(monkeypatch: pytest.MonkeyPatch) -> None:
    """Three seeds share a table, and the fifth group of a dozen has noise alone again."""
    no_solve(monkeypatch)
    synthetic_tables._table_of_grids.cache_clear()
    tables = [drawn_table(seed) for seed in range(60)]
    synthetic_tables._table_of_grids.cache_clear()
    again = drawn_table(0)
    synthetic_tables._table_of_grids.cache_clear()
    assert (again.rows, again.grid) == (tables[0].rows, 64)
    assert tables[1].rows == tables[0].rows != tables[3].rows
    assert [table.grid for table in tables[:4]] == [64, 128, 256, 64]
    assert [table.error for table in tables[::12]] == list(ERRORS)
    for table in tables:
        assert 6 <= len(table.rows) <= 8
        assert (table.wrong is None) == (table.error in ("noise", "drift"))
        if table.wrong is not None:
            row = table.rows[table.wrong]
            assert max(abs(row.mu - 0.1) / row.u_mu, table.rows[-1].load / row.load) > 5


def no_solve(monkeypatch: pytest.MonkeyPatch) -> list[Scene]:
    """Friction of 0.1 in the place of solves; the scenes that would have been solved."""
    asked: list[Scene] = []
    monkeypatch.setattr(synthetic_tables, "true_friction", lambda scene, *_: asked.append(scene) or 0.1)
    return asked


def test_finished_fits_are_read_from_the_log(tmp_path: Path) -> None:
    """Seeds 3 and 4 are made once, whatever the order of the runs; others of the log do not count.

    A table without a converged solve counts as a failure.
    """
    made: list[int] = []

    def impossible(seed: int) -> SyntheticTable:
        made.append(seed)
        raise ArithmeticError(f"the solve of {seed} ended as stagnated")

    log, tables = tmp_path / "log", TableSet(range(3, 6), impossible)
    assert [row["seed"] for row in study(tables, log, [4, 3])] == [3, 4]
    assert [row["seed"] for row in study(tables, log)] == [3, 4, 5]
    assert study(tables, log, [5]) == [{"seed": 5, "failure": "the solve of 5 ended as stagnated"}]
    assert made == [3, 4, 5]


@pytest.mark.parametrize("seed", [7001])
def test_a_hardness_to_fit_is_wrong_in_the_scene_and_right_in_the_rows(
    seed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    solved = no_solve(monkeypatch)
    table = synthetic_tables.yielding_table(seed)
    assert {scene.lower.material.hardness for scene in solved} == {table.further}
    assert table.further is not None
    assert table.scene.lower.material.hardness is not None
    off = table.scene.lower.material.hardness / table.further
    assert 0.7 <= off <= 1.4
    assert abs(off - 1) > 1e-3


@pytest.mark.nightly
def test_a_fit_of_a_table_covers_its_truth() -> None:
    found = fitted(SETS["drawn"], 300)
    assert (found["tau"], found["beta"], found["mu"], found["warned"]) == (True, True, True, True)
    assert 0.9 < float(str(found["tau_over_noise"])) <= 1


def test_committed_intervals_cover_in_92_per_cent_of_all_tables() -> None:
    """The full tier judges some of the tables; what is claimed rests on all of them."""
    row = committed("identification")["drawn"]["summary"]
    assert row["twins"] == len(SETS["drawn"].seeds)
    assert min(row["coverage"][name] for name in ("tau", "beta", "mu")) >= LEVEL
    assert row["wide_without_warning"] == row["narrow_with_warning"] == row["failures"] == 0
    assert abs(row["bias_without_noise"]) <= BIAS
