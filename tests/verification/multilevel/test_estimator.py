"""The multilevel estimator on made-up samples, and the allocation of samples to grids."""

from __future__ import annotations

import numpy as np
import pytest

from verification.multilevel.ensemble import (
    Ensemble,
    _scatter,
    _sizes,
    _Term,
)
from verification.multilevel.estimator import Estimate, allocation, costs_by_start, estimate, variances


def test_the_terms_add_up() -> None:
    found = estimate([np.array([1.0, 3.0]), np.array([0.5, 0.5, 0.5])], 0.0)
    assert found.mean == pytest.approx(2.5)
    assert found.standard_error == pytest.approx(1.0)
    assert found.freedom == pytest.approx(1.0)
    assert found.half_width == pytest.approx(12.7062, rel=1e-5)  # Student's t at one degree of freedom
    assert estimate([np.ones(3), np.ones(2)], 0.0).half_width == 0


def test_samples_that_agree_may_have_missed_three_of_them() -> None:
    """Each worth the root of 0.5; of few samples no more than all may have."""
    few, many = np.ones(2), np.ones(300)
    assert variances([few, many], 0.5).tolist() == [0.5, 0.5 * 0.01]
    found = estimate([many, few], 0.5)
    assert found.standard_error**2 == pytest.approx(0.5 * 0.01 / 300 + 0.5 / 2)


def test_corrections_fall_no_faster_than_a_count_does() -> None:
    first, large, small = np.array([-9.0, 9.0]), np.array([-2.0, 2.0]), np.array([-0.1, 0.1])
    assert variances([first, large, small, small], 0.0).tolist() == [162.0, 8.0, 1.0, 0.125]
    assert variances([first, small], 0.0)[1] == pytest.approx(0.02)  # of a realisation's it may be any share
    assert variances([first, large, np.ones(300)], 1e-6)[2] == 1.0


def test_intervals_cover_as_often_as_they_say() -> None:
    """4000 ensembles of three terms, 5 samples in the last: 95 % within four standard deviations, 1.4 %."""
    random = np.random.default_rng(5)
    covered = 0
    for _ in range(4000):
        found = estimate([random.normal(1.0, s, n) for s, n in ((1.0, 40), (0.3, 12), (0.2, 5))], 1.0)
        covered += abs(found.mean - 3.0) <= found.half_width
    assert covered / 4000 == pytest.approx(0.95, abs=0.014)


def test_the_allocation_is_the_cheapest_that_meets_the_target() -> None:
    variances, costs = np.array([[1.0], [0.04]]), np.array([1.0, 16.0])
    numbers = allocation(variances, costs, np.array([0.1]))
    assert numbers.tolist() == [180, 9]
    assert (variances[:, 0] / numbers).sum() <= 0.01 + 1e-12

    def price(first: int) -> float:
        return first + 16 * 0.04 / (0.01 - 1.0 / first)

    assert price(180) <= min(price(n) for n in range(101, 400)) * 1.001


def test_several_quantities_all_meet_theirs() -> None:
    variances = np.array([[1.0, 0.1], [0.01, 0.1]])
    target = np.array([0.1, 0.05])
    numbers = allocation(variances, np.array([1.0, 4.0]), target)
    assert np.all((variances / numbers[:, None]).sum(axis=0) <= target**2 + 1e-12)


def test_what_does_not_scatter_asks_for_no_samples() -> None:
    """The friction of a frictionless scene: its mean is 0, and so is the target."""
    variances, costs = np.array([[0.0, 1.0], [0.0, 0.04]]), np.array([1.0, 16.0])
    assert allocation(variances, costs, np.array([0.0, 0.1])).tolist() == [180, 9]
    assert allocation(variances[:, :1], costs, np.array([0.0])).tolist() == [0, 0]


def test_costs_by_start_are_those_of_giles() -> None:
    """Three terms: (sum of sqrt(V C))^2 / target^2, the first V and C those of plain solves on its grid."""
    corrections = np.array([[np.nan], [0.04], [0.01]])  # the first term has no coarser grid
    alone, pairs, target = np.array([1.0, 4.0, 16.0]), np.array([1.0, 5.0, 20.0]), np.array([0.001])
    found = costs_by_start(np.array([1.0]), corrections, alone, pairs, target)
    root = np.sqrt
    expected = [(1.0 + root(0.04 * 5) + root(0.01 * 20)) ** 2, (2.0 + root(0.01 * 20)) ** 2, 16.0]
    np.testing.assert_allclose(found, np.array(expected) / 1e-6, rtol=1e-5)  # whole numbers of samples


def test_equal_numbers_do_not_scatter_by_rounding() -> None:
    """Three times 0.1 have a mean that is none of them."""
    same = np.full((3, 1), 0.1)
    assert same.var() > 0
    assert _scatter([_Term(same, same, np.zeros(1), 1.0, 1.0, {})]).tolist() == [0.0]


def test_targets_are_no_shares_of_a_mean_that_may_be_zero() -> None:
    """A sum of few samples' terms can vanish by chance; what it took would be beyond all bounds."""
    finer = np.array([[2.0], [4.0]])
    term = _Term(finer, finer, np.zeros(1), 1.0, 1.0, {})
    for mean, size in ((1e-9, 3.0), (-0.5, 3.0), (10.0, 10.0)):
        means = {"contact_area": Estimate(mean, 0.2, 0.4, 9.0)}
        found = Ensemble((1, 2), means, (2, 2), (1.0, 1.0), {}, {}, False, {})
        assert _sizes(found, [term, term]) == pytest.approx([0.97 * size])
