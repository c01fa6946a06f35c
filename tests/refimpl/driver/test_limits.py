"""Limits of a refinement: what they refuse, on both sides of each, and the seconds to expect."""

from __future__ import annotations

import math
import time

import pytest

import refimpl as rf
from refimpl.driver.limits import Allowance, Limits

GRID = rf.Grid((10, 20), (1e-3, 2e-3))


@pytest.mark.parametrize("name", ["max_grid", "max_seconds", "max_memory"])
@pytest.mark.parametrize("value", [0, -3, math.nan])
def test_a_limit_is_positive(name: str, value: float) -> None:
    with pytest.raises(rf.InputError, match=name):
        Limits(**{name: value})  # type: ignore[arg-type]


def test_what_is_given() -> None:
    assert Limits().given == {}
    assert Limits(max_grid=7, max_memory=3e9).given == {"max_grid": 7, "max_memory": 3e9}


def test_the_longer_side_counts() -> None:
    Allowance(Limits(max_grid=20)).check(GRID, memory=1.0)
    with pytest.raises(rf.InputError, match=r"grid = 20: .*max_grid = 19"):
        Allowance(Limits(max_grid=19)).check(GRID, memory=1.0)


def test_memory_of_a_grid() -> None:
    Allowance(Limits(max_memory=2.5e9)).check(GRID, memory=2.5e9)
    with pytest.raises(rf.InputError, match=r"estimated 2.51 GB are at most 2.5 GB"):
        Allowance(Limits(max_memory=2.5e9)).check(GRID, memory=2.51e9)


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


def test_before_any_grid_no_seconds_are_expected() -> None:
    Allowance(Limits(max_seconds=1e-9)).check(GRID, memory=1.0)
