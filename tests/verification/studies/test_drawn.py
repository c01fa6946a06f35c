"""Random extremes in small: states repeat, ranges are kept, wrong numbers are seen."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

import refimpl as rf
from reports.result_files import read_result
from reports.studies import exhibit
from verification.extremes import drawn

SEED = 5


def test_a_state_is_the_same_however_many_are_drawn() -> None:
    assert drawn.drawn(7, SEED) == drawn.drawn(7, SEED)
    assert drawn.drawn(7, SEED) != drawn.drawn(8, SEED)
    assert drawn.drawn(7, SEED) != drawn.drawn(7, SEED + 1)


def test_every_choice_is_drawn() -> None:
    parameters = [drawn.drawn(k, SEED).parameters for k in range(200)]
    for name in ("periodic", "oblique", "slope_correction", "method"):
        assert len({p[name] for p in parameters}) == 2
    assert any(p["approach"] is not None for p in parameters)
    assert {p["tau"] == 0 for p in parameters} == {p["beta"] == 0 for p in parameters} == {True, False}
    assert any("rigid" in p["moduli"] for p in parameters)
    low, high = drawn.RANGES["side (m), log10"]
    assert all(10.0**low <= p["side"] <= 10.0**high for p in parameters)


def test_twenty_states_and_none_wrong(tmp_path: Path) -> None:
    path = tmp_path / "e.json"
    assert drawn.main(["--states", "20", "--seed", str(SEED), "--json", str(path)]) == 0
    found = read_result(path)
    assert found["states"] == 20
    assert found["counts"]["wrong"] == found["counts"]["crash"] == 0
    assert found["counts"]["right"] > 10
    assert "20 states" in exhibit("extremes_drawn", found).paragraphs[0]


def test_a_wrong_number_is_seen_and_its_state_is_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    solve = rf.solve
    monkeypatch.setattr(
        rf, "solve", lambda *a, **k: replace(s := solve(*a, **k), pressure=1.001 * s.pressure)
    )
    assert drawn.main(["--states", "5", "--seed", str(SEED), "--json", str(tmp_path / "e.json")]) == 1
    wrong = [row for row in read_result(tmp_path / "e.json")["rows"] if row["verdict"] == "wrong"]
    assert wrong
    assert all("moduli" in row["parameters"] for row in wrong)
