"""The study of error bars: scenes that know no grid, a store that survives kills, made-up ladders judged."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import refimpl as rf
from refimpl.discretisation import EDGE_SHARE
from refimpl.grid_result import GridResult
from refimpl.refine import OPENING
from refimpl.solution import REPORTED
from refimpl.summit import LEVEL, Summit
from reports.drawing import svg
from reports.studies import exhibit
from verification.coverage import beside, document
from verification.coverage.document import grids_of, reference_check, solves
from verification.coverage.judge import (
    EDGE_SIZE,
    EDGE_SIZE_BOUND,
    Held,
    moved,
    reference_of,
    summary,
    verdicts,
)
from verification.coverage.scenes import CLASSES, SIDE, random_scene
from verification.coverage.shapes import measured_like
from verification.coverage.store import NUMBERS, Rung, climb, ladders, rungs

GRIDS = (32, 64, 96, 128, 192, 256, 512)


def rung(M: int, *, size: float = 0.85, wrong: float = 0.0, seed: int = 3) -> Rung:
    """A disc on a grid, with an area wrong by a share; the finest grid of `GRIDS` is never wrong."""
    h, radius = SIDE / M, 0.2 * SIDE
    edge, limit = EDGE_SHARE * 8 * radius * h, np.pi * radius**2
    numbers = dict.fromkeys(REPORTED, 1.0)
    area = (limit + size * edge) * (1 + (wrong if M in GRIDS[:-1] else 0.0))
    numbers |= {"contact_area": area, "contact_area_corrected": area - edge, "max_pressure": 1 - 1e-3 / M}
    numbers["friction_coefficient"] = 0.1 + 1e5 * area
    result = GridResult(
        M=M,
        spacing=h,
        numbers=numbers,
        edge=edge,
        alike=1.0,
        peak=Summit(1.0, 1e-3, 0.0),
        touch=LEVEL,
        unevenness=0.0,
        slip=1e5,
        parts={name: {"iteration": 0.0} for name in REPORTED},
    )
    carried = 0.75 * M**2 if GRIDS[0] < M else None
    return Rung(seed, result, "converged", 1e-8, float(M**2), 0.1, carried)


def test_a_lawful_ladder_is_covered_at_little_cost() -> None:
    found = verdicts({3: [rung(M) for M in GRIDS]}, 0.02)
    assert [verdict.number for verdict in found] == list(NUMBERS)
    for verdict in found:
        assert verdict.met
        assert verdict.covered
        assert verdict.grids[:2] == (32, 64)
    area = found[1]
    assert area.cheapest is not None
    assert area.cheapest <= area.grids[-1]
    first, *later = area.grids
    assert area.cost == (first**2 + sum(0.75 * M**2 for M in later)) / area.cheapest**2
    assert summary(found)["covered"] == 1.0


def test_a_bar_that_misses_the_error_is_seen() -> None:
    found = verdicts({3: [rung(M, wrong=0.3) for M in GRIDS]}, 0.05)
    by_number = {verdict.number: verdict for verdict in found}
    assert not by_number["contact_area"].covered
    assert by_number["max_pressure"].covered
    assert summary(found)["covered"] == 0.25


def test_the_cheapest_grid_is_one_that_no_finer_one_belies() -> None:
    lawful = verdicts({3: [rung(M) for M in GRIDS]}, 0.05)[1]
    lucky = verdicts({3: [rung(M, wrong=0.3 if M == 128 else 0.0) for M in GRIDS]}, 0.05)[1]
    assert lawful.cheapest == 64  # off by 0.02
    assert lucky.cheapest == 192
    spoilt = verdicts({3: [rung(M, wrong=0.3 if M == 256 else 0.0) for M in GRIDS]}, 0.05)[1]
    assert spoilt.cheapest is None
    assert spoilt.cost is None


def test_what_the_grids_cannot_give_is_not_met() -> None:
    area = verdicts({3: [rung(M) for M in GRIDS]}, 1e-4)[1]
    assert not area.met
    assert area.cost is None
    assert area.grids[-1] == 256  # the reference itself is never asked for


def test_a_reference_that_moves_is_seen() -> None:
    assert moved([rung(M) for M in GRIDS]) < 1
    assert moved([rung(M, wrong=0.1) for M in GRIDS]) > 1


def test_references_by_hand() -> None:
    before, finest = rung(256), rung(512)
    area, edge = finest.result.numbers["contact_area"], finest.result.edge
    both = [rung(128), before, finest]
    assert reference_of(both, "contact_area") == (area - EDGE_SIZE * edge, EDGE_SIZE_BOUND * edge)
    assert reference_of(both, "contact_area_corrected") == reference_of(both, "contact_area")
    mu, bound = reference_of(both, "friction_coefficient")
    assert mu == pytest.approx(0.1 + 1e5 * (area - EDGE_SIZE * edge), rel=1e-14)
    assert bound == pytest.approx(1e5 * EDGE_SIZE_BOUND * edge, rel=1e-9)  # without tau's share mu is 0.1
    higher = replace(finest, result=replace(finest.result, peak=Summit(1.25, 1e-3, 0.0)))
    assert reference_of([before, higher], "max_pressure") == (1.25, 0.25)
    rubbing = {**finest.result.numbers, "friction_coefficient": 0.3 + 1e5 * area}
    moved_on = [before, replace(finest, result=replace(finest.result, numbers=rubbing))]
    assert reference_of(moved_on, "friction_coefficient")[1] == pytest.approx(bound + 0.2, rel=1e-12)


@pytest.mark.parametrize(
    ("error", "bound", "bar", "covered", "at_worst"),
    [
        (0.25, 0.25, 0.5, True, True),
        (0.25, 0.26, 0.5, True, False),
        (0.5, 0.0, 0.5, True, True),
        (0.51, 0.0, 0.5, False, False),
        (1e-9, 1e-9, 0.0, False, False),
        (0.25, 0.25, np.inf, True, True),
    ],
)
def test_a_bar_holds_up_to_its_end(
    error: float, bound: float, bar: float, covered: bool, at_worst: bool
) -> None:
    found = Held(bar=bar, error=error, reference_bound=bound)
    assert (found.covered, found.covered_at_worst) == (covered, at_worst)


def test_a_summary_by_hand() -> None:
    one = verdicts({3: [rung(M) for M in GRIDS]}, 0.02)[0]
    made = [
        replace(one, met=met, cost=cost, bar=bar, error=error, reference_bound=0.5)
        for met, cost, bar, error in (
            (True, 1.5, 1.0, 0.25),
            (True, 2.0, 1.0, 0.5),
            (True, 3.0, 1.0, 2.0),
            (False, None, np.inf, 1.0),
            (False, None, 8.0, 1.0),
        )
    ]
    assert summary(made) == {
        "scenes": 5,
        "met": 0.6,
        "covered": 0.8,
        "covered_at_worst": 0.8,
        "covered_where_met": 2 / 3,
        "median_bar_over_error": 4.0,
        "median_cost": 2.0,
        "cost_at_most_2": 2 / 3,
        "median_bar": 1.0,
        "median_reference_bound_over_bar": 0.5,
    }
    never = summary(made[3:4])
    assert [never[name] for name in ("covered_where_met", "median_cost", "cost_at_most_2")] == [None] * 3
    assert never["median_bar"] is None
    assert never["median_bar_over_error"] is None


def test_frictionless_scenes_have_no_friction_to_judge() -> None:
    seed = next(seed for seed in range(99) if random_scene(seed).scene.friction.is_zero)
    found = verdicts({seed: [rung(M, seed=seed) for M in GRIDS]}, 0.02)
    assert [verdict.number for verdict in found] == list(NUMBERS[1:])


@pytest.mark.filterwarnings("ignore::refimpl.SurfaceWarning")
def test_scenes_repeat_and_know_no_grid() -> None:
    for seed, kind in enumerate(CLASSES):
        drawn, again = random_scene(seed), random_scene(seed)
        assert drawn.kind == kind
        coarse, fine = (np.array(d.scene.heights(rf.Grid(SIDE, M))) for d, M in ((drawn, 32), (again, 96)))
        # every third centre of the fine grid is one of the coarse; mid-heights differ by what is not sampled
        shift = fine[:, 1::3, 1::3] - coarse
        assert np.ptp(shift, axis=(1, 2)).max() <= 1e-12 * SIDE, kind


def test_measured_like_heights_have_the_rms_asked_for() -> None:
    heights = measured_like(np.random.default_rng(1), 64, 2e-6, 0.8, roll_off=4)
    assert heights.std() == pytest.approx(2e-6)
    assert abs(heights.mean()) < 1e-20


def test_the_store_resumes_after_a_kill(tmp_path: Path) -> None:
    store = tmp_path / "store.jsonl"
    climb(store, [0], [32, 48])
    whole = store.read_text()
    store.write_text(whole[:-100])  # killed while the last line was written
    assert [found.result.M for found in rungs(store)] == [32]
    climb(store, [0], [32, 48])
    assert [found.result.M for found in ladders(store)[0]] == [32, 48]
    found = solves(ladders(store).values())
    assert found["not_converged"] == 0
    assert found["worst_apart"] <= 1e-6
    first, second = ladders(store)[0]
    assert first.carried is None
    assert second.carried is not None
    assert second.carried < second.point_logs


def test_the_reference_is_checked_on_one_more_grid(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    module = "verification.coverage.document"
    monkeypatch.setattr(f"{module}.CHECK", 128)
    monkeypatch.setattr(f"{module}.grids_of", lambda seed: (32, 64))
    store = tmp_path / "store.jsonl"
    climb(store, [8], [32, 64])
    found = reference_check([6, 8], store)
    assert found["seeds"] == [8]
    assert found["worst_over_bound"] is not None
    assert reference_check([6], store)["worst_over_bound"] is None


def test_periodic_scenes_end_at_a_coarser_reference() -> None:
    ends = {kind: grids_of(seed)[-1] for seed, kind in enumerate(CLASSES)}
    assert {kind for kind, end in ends.items() if end == 512} == {"periodic waves", "periodic rough"}
    to_256 = (32, 64, 80, 96, 112, 128, 160, 192, 224, 256)
    assert grids_of(0) == (*to_256, 320, 384, 448, 512, 1024)
    assert grids_of(list(CLASSES).index("periodic waves")) == (*to_256, 512)


def test_numbers_beside_are_judged_where_the_climb_for_mu_ends() -> None:
    ladder = {3: [rung(M) for M in GRIDS]}
    found = verdicts(ladder, 0.02)
    approach, binormal = beside.where_climbs_end(ladder, found)
    assert (approach.number, binormal.number) == beside.BESIDE
    assert approach.grid == binormal.grid == found[0].grids[-1]
    assert beside.summary([approach])["covered"] == 1.0
    made = [replace(approach, bar=bar, error=0.5, reference_bound=0.5) for bar in (0.25, 0.5, 1.0, 2.0)]
    assert beside.summary(made) == {
        "scenes": 4,
        "covered": 0.75,
        "covered_at_worst": 0.5,
        "median_bar_over_error": 1.5,
        "median_bar": 0.75,
    }
    fine = ladder[3][-1]
    for number in beside.BESIDE:
        off = replace(fine.result, numbers={**fine.result.numbers, number: 1.5})
        wrong = beside.where_climbs_end({3: [*ladder[3][:-1], replace(fine, result=off)]}, found)
        bar = wrong[beside.BESIDE.index(number)]
        assert bar.error == pytest.approx(0.5)
        assert bar.reference_bound == pytest.approx(0.5)
        assert beside.summary([bar])["covered"] == 0.0


def test_numbers_beside_go_by_the_area_where_nothing_rubs() -> None:
    seed = next(seed for seed in range(99) if random_scene(seed).scene.friction.is_zero)
    ladders_of = {s: [rung(M, seed=s) for M in GRIDS] for s in (3, seed)}
    # beside tau's share mu has 0.1, so that it is known better than the area
    found = verdicts(ladders_of, 0.005)
    ends = {(v.seed, v.number): v.grids[-1] for v in found}
    assert ends[3, "friction_coefficient"] != ends[3, "contact_area"]
    bars = beside.where_climbs_end(ladders_of, found)
    expected = {3: ends[3, "friction_coefficient"], seed: ends[seed, "contact_area"]}
    assert {bar.seed: bar.grid for bar in bars} == expected
    assert {bar.kind for bar in bars} == {random_scene(s).kind for s in expected}


def test_approaches_are_judged_from_where_surfaces_touch() -> None:
    ladder = [rung(M) for M in GRIDS]
    summit = replace(LEVEL, height=0.25)
    ladder[-1] = replace(ladder[-1], result=replace(ladder[-1].result, touch=summit))
    approach, binormal = beside.where_climbs_end({3: ladder}, verdicts({3: ladder}, 0.02))
    assert approach.error == pytest.approx(0.25)
    assert binormal.error == 0.0


def test_scenes_are_judged_at_an_approach_too(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """On grids small enough for a test; the store beside the study's lets it go on where it was."""
    monkeypatch.setattr(document, "BARS", (64, 96))
    monkeypatch.setattr(beside, "GRIDS", (64, 96))
    monkeypatch.setattr(document, "grids_of", lambda _: (*OPENING, 96, 192))
    store = tmp_path / "study.jsonl"
    climb(store, [0, 80], [*OPENING, 96])
    found = document.approaches(ladders(store), store)
    assert set(found) == set(beside.AT_APPROACH)
    sticky = [not random_scene(seed).scene.friction.is_zero for seed in (0, 80)]
    assert found["friction_coefficient"]["96"]["scenes"] == sum(sticky[:1])
    force = found["normal_force"]
    assert [force[M]["scenes"] for M in ("64", "96")] == [1, 1]
    assert force["96"]["covered"] == 1.0
    before = tmp_path.joinpath("study-approach.jsonl").read_bytes()
    assert document.approaches(ladders(store), store) == found
    assert tmp_path.joinpath("study-approach.jsonl").read_bytes() == before
    assert len(before.splitlines()) == 4


def test_the_document_solves_what_is_wanting_and_judges_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(document, "BARS", (64,))
    monkeypatch.setattr(beside, "GRIDS", (64,))
    monkeypatch.setattr(document, "grids_of", lambda _: (*OPENING, 128, 256))
    frictionless = next(seed for seed in range(99) if random_scene(seed).scene.friction.is_zero)
    store, seeds = tmp_path / "study.jsonl", [0, frictionless]
    climb(store, [5], [*OPENING])  # of another study
    found: dict[str, Any] = document.document([0.05], seeds, store)
    assert found["solves"]["count"] == 8
    (judged,) = found["accuracies"]
    scenes = {number: judged["numbers"][number]["scenes"] for number in NUMBERS}
    assert scenes == {name: 1 if name == "friction_coefficient" else 2 for name in NUMBERS}
    assert {number: verdicts["seed"] for number, verdicts in judged["verdicts"].items()} == {
        name: [0] if name == "friction_coefficient" else seeds for name in NUMBERS
    }
    for number in beside.BESIDE:
        assert judged["beside"][number]["scenes"] == 2
        assert judged["beside"][number]["bars"]["seed"] == seeds
    kept = {
        seed: [r for r in rungs if r.result.M in (*OPENING, 128, 256)]
        for seed, rungs in ladders(store).items()
    }
    bars = beside.where_climbs_end(kept, verdicts({seed: kept[seed] for seed in seeds}, 0.05))
    for number in beside.BESIDE:
        expected = [bar.bar for bar in bars if bar.number == number]
        assert judged["beside"][number]["bars"]["bar"] == expected
    by_class = [judged["classes"][kind]["contact_area"]["scenes"] for kind in CLASSES]
    assert sum(by_class) == 2
    at_approach = found["at_approach"]
    assert {n: grids["64"]["scenes"] for n, grids in at_approach.items()} == {
        name: 1 if name == "friction_coefficient" else 2 for name in beside.AT_APPROACH
    }


def test_the_report_shows_the_study() -> None:
    ladder = {3: [rung(M) for M in GRIDS]}
    found = verdicts(ladder, 0.02)
    bars = beside.where_climbs_end(ladder, found)
    columns = ("seed", "class", "grid", "met", "bar", "error", "cost")
    judged = {
        "accuracy": 0.02,
        "numbers": {number: summary(v for v in found if v.number == number) for number in NUMBERS},
        "classes": {"rough ball": {number: summary(found) for number in NUMBERS}},
        "verdicts": {
            v.number: dict(
                zip(columns, ([3], [v.kind], [256], [v.met], [v.bar], [v.error], [v.cost]), strict=True)
            )
            for v in found
        },
        "beside": {number: beside.summary(bars[k::2]) for k, number in enumerate(beside.BESIDE)},
    }
    study = {
        "seeds": [3, 3],
        "solves": {"count": 7, "seconds": 1.0, "worst_residual": 1e-8, "worst_apart": 1e-9},
        "reference_check": {"grid": 1024, "seeds": [3], "worst_over_bound": 0.5},
        "accuracies": [judged],
        "at_approach": {"normal_force": {"128": beside.summary(bars[:1]), "256": beside.summary([])}},
    }
    shown = exhibit("coverage", study)
    assert shown.tables[0].rows[0][:5] == ("mu", 0.02, 1, 100.0, 100.0)
    assert [row[:4] for row in shown.tables[-1].rows] == [
        ("approach, mu to 0.02", None, 1, 100.0),
        ("Q, mu to 0.02", None, 1, 100.0),
        ("normal force, at an approach", 128, 1, 100.0),
        ("normal force, at an approach", 256, 0, None),
    ]
    ((figure, data),) = shown.figures
    drawn = svg(figure, data)
    assert drawn is not None
