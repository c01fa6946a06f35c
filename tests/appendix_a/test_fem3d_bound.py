"""The stated error of the three-dimensional coefficients is a bound for every expansion in two powers.

Value, limit and both differences are linear in the powers' weights a and b. So the error is a combination of
the two differences, and the largest quotient of error and stated error is the sum of its two weights' sizes.
"""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest

from appendix_a.fem3d.coefficients import MESH_ORDER, RADIUS_ORDER, SAFETY, Quality, extrapolated

FAMILIES = [
    *((tuple(1 / level for level in quality.levels), MESH_ORDER, 2.5) for quality in Quality),
    *((tuple(1 / radius for radius in quality.radii), RADIUS_ORDER, 2.0) for quality in Quality),
]


def error_and_differences(steps: tuple[float, ...], order: int, power: float) -> np.ndarray:
    """Error of the limit of step^power; its change from the finest value, from the coarse pair's limit."""
    values = [np.array([step**power]) for step in steps]

    def limit(coarse: int, fine: int) -> float:
        ratio = (steps[coarse] / steps[fine]) ** order
        return float(values[fine][0] + (values[fine][0] - values[coarse][0]) / (ratio - 1))

    last, stated = extrapolated(values, list(steps), order)
    changes = limit(1, 2) - values[2][0], limit(1, 2) - limit(0, 1)
    assert stated[0] == pytest.approx(SAFETY * np.abs(changes).max(), rel=1e-12)
    return np.array([last[0], *changes])


def largest_quotient(steps: tuple[float, ...], order: int, powers: tuple[float, float]) -> float:
    """Error over stated error for the worst weights of two powers."""
    error, *changes = np.array([error_and_differences(steps, order, power) for power in powers]).T
    return float(np.abs(np.linalg.solve(np.transpose(changes), error)).sum() / SAFETY)


@pytest.mark.parametrize(("steps", "order", "least"), FAMILIES)
def test_any_two_powers_are_covered(steps: tuple[float, ...], order: int, least: float) -> None:
    powers = np.arange(least, 8.01, 0.25)
    quotients = [largest_quotient(steps, order, pair) for pair in combinations(powers.tolist(), 2)]
    assert max(quotients) < 0.82


@pytest.mark.parametrize(("steps", "order", "least"), FAMILIES)
def test_one_power_from_second_order_on_is_covered(
    steps: tuple[float, ...], order: int, least: float
) -> None:
    for power in np.arange(2.0, 12.01, 0.25):
        if power != order:
            error, *changes = error_and_differences(steps, order, float(power))
            assert abs(error) < 0.9 * SAFETY * np.abs(changes).max()


def test_a_first_order_part_is_not_covered() -> None:
    """The bound's condition is needed: weights that cancel both differences hide a first-order part."""
    assert largest_quotient((1.0, 1 / 2, 1 / 3), MESH_ORDER, (1.0, 2.0)) > 1.0
