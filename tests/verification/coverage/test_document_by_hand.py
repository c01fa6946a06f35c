"""The document of a coverage study from a store made up by hand, its lines in no order."""

from __future__ import annotations

import json
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.verification.coverage.rungs import GRIDS, rung
from verification.coverage import document
from verification.coverage.judge import Held, Verdict, reference_of, summary, verdicts
from verification.coverage.scenes import random_scene
from verification.coverage.store import NUMBERS, climb, ladders

SEEDS = [75, 76]  # no scenes that are solved at an approach as well, or on one more grid


def stored(path: Path, *, wrong: float = 0.0) -> None:
    """Two ladders, their grids shuffled; the second's solves with odd ends."""
    several = [rung(M, seed=seed, wrong=wrong) for seed in SEEDS for M in GRIDS]
    odd = {32: "cycled", 64: "stagnated", 96: "iteration limit"}
    several = [
        replace(one, status=odd.get(one.M, "converged"), worst=one.M * 1e-9, seconds=0.5, apart=one.M * 1e-12)
        if one.seed == 76
        else one
        for one in several
    ]
    order = np.random.default_rng(3).permutation(len(several))
    path.write_text("".join(json.dumps(asdict(several[k])) + "\n" for k in order))


def test_ladders_are_sorted_whatever_the_order_of_their_lines(tmp_path: Path) -> None:
    stored(tmp_path / "s.jsonl")
    found = ladders(tmp_path / "s.jsonl")
    assert list(found) == SEEDS
    assert [[one.M for one in rungs] for rungs in found.values()] == [list(GRIDS)] * 2


def test_every_column_of_the_document(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    stored(tmp_path / "s.jsonl")
    monkeypatch.setattr(document, "grids_of", lambda _: GRIDS)
    found: dict[str, Any] = document.document([0.03, 0.005], SEEDS, tmp_path / "s.jsonl")
    assert found["solves"] == {
        "count": 14,
        "seconds": pytest.approx(7 * 0.1 + 7 * 0.5),
        "worst_residual": pytest.approx(512e-9),
        "worst_apart": pytest.approx(512e-12),
        "not_converged": 2,  # a cycled solve is a solution
    }
    assert (found["seeds"], found["reference_check"]["seeds"]) == ([75, 76], [])
    assert [one["accuracy"] for one in found["accuracies"]] == [0.03, 0.005]
    for judged, accuracy in zip(found["accuracies"], (0.03, 0.005), strict=True):
        expected = verdicts(ladders(tmp_path / "s.jsonl"), accuracy)
        for number in NUMBERS:
            own = [v for v in expected if v.number == number]
            columns = judged["verdicts"][number]
            assert columns["seed"] == [v.seed for v in own]
            assert columns["class"] == [random_scene(v.seed).kind for v in own]
            assert columns["grids"] == [list(v.grids) for v in own]
            assert columns["grid"] == [max(v.grids) for v in own]
            for name in ("met", "bar", "error", "reference_bound", "cheapest", "cost"):
                exact = [getattr(v, name) for v in own]
                assert columns[name] == [v if v is None else pytest.approx(v, rel=5e-4) for v in exact], name
            assert judged["numbers"][number] == summary(own)
            for kind in {random_scene(seed).kind for seed in SEEDS}:
                part = [v for v in own if v.kind == kind]
                assert judged["classes"][kind][number] == summary(part)
    assert any(max(grids) > 64 for grids in found["accuracies"][1]["verdicts"]["contact_area"]["grids"])


@pytest.mark.parametrize(
    ("error", "bound", "covered", "at_worst"),
    [(1.0, 1.0, True, True), (1.0, 1.5, True, False), (2.0, 0.0, True, True), (2.5, 1.0, False, False)],
)
def test_a_doubtful_reference_counts_against_the_bar(
    error: float, bound: float, covered: bool, at_worst: bool
) -> None:
    held = Held(bar=2.0, error=error, reference_bound=bound)
    assert (held.covered, held.covered_at_worst) == (covered, at_worst)


def verdict(bar: float, error: float, cost: float | None, *, met: bool, bound: float = 0.25) -> Verdict:
    return Verdict(
        bar=bar, error=error, reference_bound=bound, seed=1, kind="x", number="contact_area", accuracy=0.1,
        grids=(32, 64), met=met, cheapest=None, cost=cost,
    )  # fmt: skip


def test_shares_and_medians_of_four_verdicts() -> None:
    """Covered: 1, 1, 0, 1; at worst 1, 0, 0, 1; met the first three; bars over errors 2, 1, 1/2, 4."""
    several = [
        verdict(2.0, 1.0, 1.5, met=True), verdict(1.0, 1.0, 2.0, met=True, bound=0.5),
        verdict(0.5, 1.0, 2.5, met=True), verdict(4.0, 1.0, None, met=False),
    ]  # fmt: skip
    assert summary(several) == {
        "scenes": 4,
        "met": 0.75,
        "covered": 0.75,
        "covered_at_worst": 0.5,
        "covered_where_met": pytest.approx(2 / 3),
        "median_bar_over_error": 1.5,
        "median_cost": 2.0,
        "cost_at_most_2": pytest.approx(2 / 3),
        "median_bar": 1.5,
        # 0.125, 0.5, 0.5, 0.0625
        "median_reference_bound_over_bar": pytest.approx(0.3125),
    }


def test_the_reference_of_friction_has_less_than_the_finest_grids_edge() -> None:
    """Whole elements add 0.79 of the edge to the area, and tau on it to mu."""
    rungs = [rung(M) for M in (256, 512)]
    finest = rungs[-1].result
    value, bound = reference_of(rungs, "friction_coefficient")
    assert value == pytest.approx(finest.numbers["friction_coefficient"] - 0.79 * 1e5 * finest.edge)
    assert bound == pytest.approx(0.12 * 1e5 * finest.edge)
    area, bound = reference_of(rungs, "contact_area")
    assert area == pytest.approx(finest.numbers["contact_area"] - 0.79 * finest.edge)
    assert bound == pytest.approx(0.12 * finest.edge)


def test_after_a_kill_in_the_middle_of_a_line_the_next_line_is_one_of_its_own(tmp_path: Path) -> None:
    path = tmp_path / "s.jsonl"
    solved = {M: rung(M) for M in (32, 64, 96)}
    climb(path, [3], [32, 64], lambda seed, M: solved[M])
    path.write_bytes(path.read_bytes()[:-40])
    climb(path, [3], [32, 64, 96], lambda seed, M: solved[M])
    assert [one.M for one in ladders(path)[3]] == [32, 64, 96]
