"""Trial points that are cut at zero: the change they leave at the load, and the longest step."""

from __future__ import annotations

import numpy as np
import pytest

from refimpl.solvers.production.step_length import cut_at_zero, longest_step


def cut(pressure: list[float], step: list[float], target: float | None) -> tuple[bool, np.ndarray]:
    """Whether the cut trial has any pressure, and the change that leads to it, with weights of one."""
    before, change = np.array([pressure]), np.array([step])
    return cut_at_zero(before + change, before, change, np.ones_like(before), target), change


def test_little_load_that_a_cut_adds_is_taken_from_what_rises() -> None:
    """Here 1 of 11,000: the third rises by 3, the fourth falls as it did, the second ends at zero."""
    kept, change = cut([5000.0, 1.0, 4999.0, 1000.0], [0.0, -2.0, 4.0, -2.0], target=11000.0)
    assert kept
    np.testing.assert_allclose(change, [[0.0, -1.0, 3.0, -2.0]], rtol=1e-12)


def test_much_load_that_a_cut_adds_is_taken_from_all() -> None:
    kept, change = cut([50.0, 1.0, 49.0], [0.0, -21.0, 21.0], target=100.0)
    assert kept
    np.testing.assert_allclose(change, [[50 / 1.2 - 50, -1.0, 70 / 1.2 - 49]], rtol=1e-12)


def test_weights_count() -> None:
    """An element of twice the weight bears twice the load."""
    before, change = np.array([[300.0, 1.0, 199.5]]), np.array([[1.0, -3.0, 0.5]])
    weights = np.array([[2.0, 1.0, 2.0]])
    assert cut_at_zero(before + change, before, change, weights, target=1001.0)
    assert float((weights * (before + change)).sum()) == pytest.approx(1001.0, rel=1e-15)


def test_the_longest_step_ends_where_the_first_pressure_does() -> None:
    assert longest_step(np.array([[4.0, 1.0, 6.0]]), np.array([[-2.0, 3.0, -4.0]])) == 1.5
