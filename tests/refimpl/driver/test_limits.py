"""Limits of a refinement: what they refuse, on both sides of each, and the seconds to expect."""

from __future__ import annotations

import time

import pytest

import refimpl as rf
from refimpl.driver.limits import Allowance, Limits

GRID = rf.Grid((10, 20), (1e-3, 2e-3))


@pytest.mark.parametrize(
    ("limits", "refusal"),
    [
        (Limits(max_grid=20, max_memory=2.5e9, max_seconds=1e-9), None),
        (Limits(max_grid=19), "grid = 20: .*max_grid = 19"),
        (Limits(max_memory=2.49e9), r"estimated 2.5 GB are at most 2.49 GB"),
    ],
)
def test_the_longer_side_and_the_memory_count_and_no_seconds_before_any_grid(
    limits: Limits, refusal: str | None
) -> None:
    if refusal is None:
        Allowance(limits).check(GRID, memory=2.5e9)
        return
    with pytest.raises(rf.InputError, match=refusal):
        Allowance(limits).check(GRID, memory=2.5e9)


def test_seconds_grow_as_a_transform_does_and_by_a_third_more() -> None:
    """From 200 elements to 800: 4 times as many, ln 800 / ln 200 = 1.26165, 1.3 for iterations: 6.56057."""
    allowance = Allowance(Limits())
    fine = rf.Grid((20, 40), (1e-3, 2e-3))
    assert allowance.expected_seconds(fine) == 0
    allowance.record(fine, 5.0)
    allowance.record(GRID, 3.0)  # the last one counts
    assert allowance.expected_seconds(fine) == pytest.approx(3 * 6.56057, rel=1e-6)


def test_one_element_says_something_too() -> None:
    """A grid of one element counts as two: ln 1 is zero. 100 elements of 1.3 * 50 * ln 100 / ln 2."""
    allowance = Allowance(Limits())
    allowance.record(rf.Grid((1, 1), (1e-3, 1e-3)), 2.0)
    expected = 2 * 50 * 6.643856 * 1.3
    assert allowance.expected_seconds(rf.Grid((10, 10), (1e-3, 1e-3))) == pytest.approx(expected)


def test_seconds_spent_and_to_expect_are_within_the_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    """19.68 s to be expected: after 10 s they fit into 29.7 s, and not into 29.6 s."""
    monkeypatch.setattr(time, "perf_counter", lambda: 100.0)
    fine = rf.Grid((20, 40), (1e-3, 2e-3))
    enough, short = (Allowance(Limits(max_seconds=most)) for most in (29.7, 29.6))
    for allowance in (enough, short):
        allowance.record(GRID, 3.0)
    monkeypatch.setattr(time, "perf_counter", lambda: 110.0)
    enough.check(fine, memory=1.0)
    with pytest.raises(rf.InputError, match=r"19.7 s to be expected, after 10 s"):
        short.check(fine, memory=1.0)
