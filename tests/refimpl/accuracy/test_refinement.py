"""Which grids a refinement solves, on results made up to have a known limit, and how it ends."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

import refimpl as rf
from refimpl.accuracy.discretisation_error import estimates
from refimpl.accuracy.grid_features import GridFeatures
from refimpl.accuracy.refinement import (
    FIRST_GRIDS,
    GRID_SIZES,
    DataShares,
    longer_side,
    next_grid,
    refine_until,
    relative_bound,
)
from refimpl.solution.quantities import REPORTED
from tests.refimpl.accuracy.made_up import AREA_LIMIT, PEAK, made_up


def test_the_refinement_goes_straight_to_the_grid_that_suffices() -> None:
    asked: list[int] = []

    def result_at(M: int) -> GridFeatures:
        asked.append(M)
        return made_up(M)

    found = refine_until(result_at, 0.01, "contact_area")
    assert found.refusal == ""
    assert tuple(asked[:2]) == FIRST_GRIDS
    assert len(asked) == 3
    assert relative_bound(found.results, "contact_area") <= 0.01
    true_error = found.results[-1].numbers["contact_area"] / AREA_LIMIT - 1
    assert true_error <= 0.01
    coarser = made_up(asked[-1] * 2 // 3).numbers["contact_area"] / AREA_LIMIT - 1
    assert coarser > 0.0095  # so little was wasted
    assert next_grid(found.results[:2], 0.01, "contact_area", [96, 128]) == 128


@pytest.mark.parametrize("accuracy", [1e-3, 1e-4])
def test_a_peaks_bar_is_predicted_to_fall_as_the_square(accuracy: float) -> None:
    opened = [made_up(M) for M in FIRST_GRIDS]
    M = next_grid(opened, accuracy, "max_pressure", GRID_SIZES)
    bar, coarser = (relative_bound([*opened, made_up(grid)], "max_pressure") for grid in (M, M * 3 // 4))
    assert bar <= accuracy < coarser
    assert estimates(opened)["max_pressure"].orders == (2.0, 2.0)


def test_a_part_that_does_not_fall_is_predicted_to_the_largest_refinement() -> None:
    """Active set of tau: 3 % of the peak on both last grids."""
    shares = {32: 0.0, 64: 0.0, 128: 0.03, 256: 0.03}
    parts = {M: {"max_pressure": {"active set": share * PEAK}} for M, share in shares.items()}
    opened = [replace(made_up(M), parts=own) for M, own in parts.items()]
    assert next_grid(opened, 0.0172, "max_pressure", [32 * k for k in range(9, 80)]) == 8 * 256


def test_a_zero_that_is_exact_has_no_bar() -> None:
    opened = [made_up(M) for M in FIRST_GRIDS]
    assert relative_bound(opened, "binormal_force") == 0.0
    slanted = replace(opened[-1], parts={"binormal_force": {"iteration": 1e-9}})
    assert relative_bound([opened[0], slanted], "binormal_force") == math.inf


def test_a_refused_grid_is_replaced_by_a_coarser_one_and_the_end_has_a_reason() -> None:
    def result_at(M: int) -> GridFeatures:
        if M > 100:
            raise rf.InputError("grid", M, "one that fits")
        return made_up(M)

    found = refine_until(result_at, 0.001, "contact_area")
    assert found.results[-1].grid.shape[0] == 96
    assert "one that fits" in found.refusal
    ended = refine_until(made_up, 0.001, "contact_area", grid_sizes=(80, 96))
    assert ended.results[-1].grid.shape[0] == 96
    assert "96" in ended.refusal


@pytest.mark.parametrize(("power", "grids"), [(0.0, 3), (0.1, 3), (-1.0, 4), (-0.5, 5)])
def test_what_the_active_set_of_tau_leaves_open_ends_the_refinement_unless_finer_grids_leave_less(
    power: float, grids: int
) -> None:
    """A tenth of the peak on 64 elements a side, against the hundredth asked for."""
    asked: list[int] = []

    def result_at(M: int) -> GridFeatures:
        asked.append(M)
        own = {"max_pressure": {"active set": 0.1 * PEAK * (M / 64) ** power}}
        return replace(made_up(M), parts=own)

    found = refine_until(result_at, 0.01, "max_pressure", grid_sizes=range(64, 2**16, 64))
    assert len(asked) == grids
    assert ("tau's active set" in found.refusal) is (power >= 0)
    assert (relative_bound(found.results, "max_pressure") <= 0.01) is (power < 0)


def test_neglected_terms_come_back_once_they_are_in_the_way() -> None:
    """0.8 % on all grids by neglected terms where 1 % is asked for, nothing without them."""
    asked: list[int] = []

    def result_at(M: int, neglected: float = 0.008) -> GridFeatures:
        asked.append(M)
        return replace(made_up(M), parts={"contact_area": {"neglected": neglected * AREA_LIMIT}})

    found = refine_until(result_at, 0.01, "contact_area", restored=lambda: result_at(asked[-1], 0.0))
    assert found.refusal == ""
    assert asked[:3] == [*FIRST_GRIDS, FIRST_GRIDS[-1]]


def test_what_no_grid_reduces_is_summed_and_ends_the_refinement_with_names_and_sizes() -> None:
    """0.7 % by data and by the border each, 1 % asked for: neither alone exceeds it, both do."""

    def result_at(M: int) -> GridFeatures:
        own = {"data": 0.007 * AREA_LIMIT, "border": 0.007 * AREA_LIMIT}
        return replace(made_up(M), parts={"contact_area": own})

    found = refine_until(result_at, 0.01, "contact_area", data=DataShares(lambda M: 1.0, finest=4.0 * 96))
    assert "points of the data" in found.refusal
    assert "beyond the border" in found.refusal
    assert longer_side(found.results[-1]) <= 4 * 96


def test_a_part_that_no_grid_reduces_leaves_little_to_the_others() -> None:
    """0.995 % by data where 1 % is asked for: 1.4 % on 512 elements seems near, but takes 4,900.

    Refined until the others are a quarter of it, as where the part alone exceeds the accuracy.
    """

    def result_at(M: int) -> GridFeatures:
        found = made_up(M)
        return replace(found, parts={"contact_area": {"data": 0.00995 * found.numbers["contact_area"]}})

    found = refine_until(result_at, 0.01, "contact_area")
    beyond = refine_until(result_at, 0.0099, "contact_area")
    sizes = [longer_side(result) for result in found.results]
    assert sizes == [longer_side(result) for result in beyond.results] == [32, 64, 512, 1280]
    assert "by the bars so far it takes at least" in found.refusal
    assert "no grid reduces" in beyond.refusal


def test_nothing_in_contact_ends_the_refinement() -> None:
    apart = replace(made_up(64), numbers=dict.fromkeys(REPORTED, 0.0), edge=0.0)
    assert len(refine_until(lambda M: apart, 0.01, "contact_area").results) == len(FIRST_GRIDS)


def test_a_stricter_demand_ends_on_no_coarser_grid_within_limits() -> None:
    """Bars that fall by h, half of the number at 64 elements: 0.07 takes 512, 0.02 more than are allowed."""

    def result_at(M: int) -> GridFeatures:
        if M > 512:
            raise rf.InputError("grid", M, "at most 512 elements a side")
        return replace(made_up(M), parts={"contact_area": {"neglected": 32 / M * AREA_LIMIT}})

    ends = [refine_until(result_at, accuracy, "contact_area") for accuracy in (0.07, 0.02)]
    assert [end.results[-1].grid.shape[0] for end in ends] == [512, 512]
    assert [bool(end.refusal) for end in ends] == [False, True]


def test_an_active_set_that_leaves_less_open_than_the_grid_does_not_end_the_refinement() -> None:
    """0.6 % on all grids where 0.5 % is asked for: grids are refined until the rest of the bar is less."""

    def result_at(M: int) -> GridFeatures:
        return replace(made_up(M), parts={"contact_area": {"active set": 0.006 * AREA_LIMIT}})

    found = refine_until(result_at, 0.005, "contact_area", grid_sizes=(80, 640))
    assert "tau's active set" in found.refusal
    assert [result.grid.shape[0] for result in found.results] == [32, 64, 80, 640]
