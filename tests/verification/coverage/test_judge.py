"""Error bars judged on made-up ladders: what holds, what it cost, what the reference is, all by hand."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from refimpl.accuracy.peak import Peak
from refimpl.model.friction import is_frictionless
from tests.verification.coverage.rungs import GRIDS, rung
from verification.coverage.judge import (
    EDGE_SIZE,
    EDGE_SIZE_BOUND,
    Held,
    moved,
    reference_of,
    summary,
    verdicts,
)
from verification.coverage.scenes import random_scene
from verification.coverage.store import NUMBERS


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
    higher = replace(finest, result=replace(finest.result, peak=Peak(1.25, 1e-3, 0.0)))
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
    seed = next(seed for seed in range(99) if is_frictionless(random_scene(seed).scene.friction))
    found = verdicts({seed: [rung(M, seed=seed) for M in GRIDS]}, 0.02)
    assert [verdict.number for verdict in found] == list(NUMBERS[1:])
