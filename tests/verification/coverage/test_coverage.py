"""The study of error bars: a store that survives kills, and coverage by hand."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from refimpl.accuracy.peak import Peak
from refimpl.model.friction import is_frictionless
from tests.verification.coverage.made_up import GRIDS, grid_solve, refinement
from verification.coverage.judge import Coverage, coverages, reference_of
from verification.coverage.scenes import random_scene
from verification.coverage.store import NUMBERS, grid_solves, refine, refinements

FRICTIONLESS = next(seed for seed in range(99) if is_frictionless(random_scene(seed).scene.friction))


def area_of(accuracy: float, wrong: dict[int, float] | None = None) -> Coverage:
    """The contact area's coverage, with an area wrong by a share on some grids."""
    made = [grid_solve(M, wrong=(wrong or {}).get(M, 0.0)) for M in GRIDS]
    return coverages({3: made}, accuracy)[1]


def test_a_lawful_refinement_is_covered_at_little_cost() -> None:
    found = coverages({3: refinement()}, 0.02)
    assert [one.number for one in found] == list(NUMBERS)
    for one in found:
        assert one.met
        assert one.covered
        assert one.grids[:2] == (32, 64)
    area = found[1]
    assert area.cheapest is not None
    assert area.cheapest <= area.grids[-1]
    first, *later = area.grids
    assert area.cost == (first**2 + sum(0.75 * M**2 for M in later)) / area.cheapest**2
    without = coverages({FRICTIONLESS: refinement(seed=FRICTIONLESS)}, 0.02)
    assert [one.number for one in without] == list(NUMBERS[1:])


def test_a_bar_that_misses_the_error_is_seen() -> None:
    found = coverages({3: refinement(wrong=0.3)}, 0.05)
    assert [one.number for one in found if one.covered] == ["max_pressure"]


def test_the_cheapest_grid_is_one_that_no_finer_one_belies() -> None:
    assert area_of(0.05).cheapest == 64  # off by 0.02
    assert area_of(0.05, {128: 0.3}).cheapest == 192
    spoilt = area_of(0.05, {256: 0.3})
    assert (spoilt.cheapest, spoilt.cost) == (None, None)


def test_references_known_values() -> None:
    """Whole elements add the mean excess to the area, give or take 0.12 of the edge, and tau on it to mu."""
    before, finest = grid_solve(256), grid_solve(512)
    area, edge, excess = finest.result.numbers["contact_area"], finest.result.edge, finest.result.excess
    both = [grid_solve(128), before, finest]
    assert reference_of(both, "contact_area") == (area - excess, 0.12 * edge)
    assert reference_of(both, "contact_area_corrected") == reference_of(both, "contact_area")
    mu, bound = reference_of(both, "friction_coefficient")
    assert mu == pytest.approx(0.1 + 1e5 * (area - excess), rel=1e-14)
    assert bound == pytest.approx(1e5 * 0.12 * edge, rel=1e-9)  # without tau's share mu is 0.1
    higher = replace(finest, result=replace(finest.result, peak=Peak(1.25, 1e-3, 0.0)))
    assert reference_of([before, higher], "max_pressure") == (1.25, 0.25)
    more = {**finest.result.numbers, "friction_coefficient": 0.3 + 1e5 * area}
    with_more = [before, replace(finest, result=replace(finest.result, numbers=more))]
    assert reference_of(with_more, "friction_coefficient")[1] == pytest.approx(bound + 0.2, rel=1e-12)


@pytest.mark.parametrize(
    ("error", "bound", "bar", "covered", "at_worst"),
    [
        (0.25, 0.26, 0.5, True, False),
        (0.5, 0.0, 0.5, True, True),
        (0.51, 0.0, 0.5, False, False),
        (1e-9, 1e-9, 0.0, False, False),
    ],
)
def test_a_bar_holds_up_to_its_end(
    error: float, bound: float, bar: float, covered: bool, at_worst: bool
) -> None:
    found = replace(area_of(0.02), bar=bar, error=error, reference_bound=bound)
    assert (found.covered, found.covered_at_worst) == (covered, at_worst)


def test_the_store_resumes_after_a_kill(tmp_path: Path) -> None:
    store = tmp_path / "store.jsonl"
    refine(store, [0], [32, 48])
    store.write_text(store.read_text()[:-100])  # killed while the last line was written
    assert [found.M for found in grid_solves(store)] == [32]
    refine(store, [0], [32, 48])
    first, second = refinements(store)[0]
    assert (first.M, second.M) == (32, 48)
    assert second.apart is not None
    assert second.apart <= 1e-6
    assert first.carried is None
    assert second.carried is not None
    assert second.carried < second.point_logs
