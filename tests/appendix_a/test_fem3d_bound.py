"""The stated error of three-dimensional coefficients bounds that of any sum of two powers of the step."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest

from appendix_a.fem3d.coefficients import MESH_ORDER, RADIUS_ORDER, SAFETY, Quality, extrapolated
from refimpl.grid import Array

FAMILIES = [
    *((tuple(1 / level for level in quality.levels), MESH_ORDER, 2.5) for quality in Quality),
    *((tuple(1 / radius for radius in quality.radii), RADIUS_ORDER, 2.0) for quality in Quality),
]
"""Steps, the order that is taken, and the least power: meshes, then outer boundaries."""


def error_and_differences(steps: tuple[float, ...], order: int, power: float) -> Array:
    """Return the limit of step^power, which is its error, and its two changes, of which the bound is made."""
    values = [np.array([step**power]) for step in steps]

    def limit(coarse: int, fine: int) -> float:
        ratio = (steps[coarse] / steps[fine]) ** order
        return float(values[fine][0] + (values[fine][0] - values[coarse][0]) / (ratio - 1))

    last, stated = extrapolated(values, list(steps), order)
    changes = limit(1, 2) - values[2][0], limit(1, 2) - limit(0, 1)
    assert stated[0] == pytest.approx(SAFETY * np.abs(changes).max(), rel=1e-12)
    return np.array([last[0], *changes])


@pytest.mark.parametrize(("steps", "order", "least"), FAMILIES)
def test_any_two_powers_are_covered(steps: tuple[float, ...], order: int, least: float) -> None:
    """Of the worst weights of two powers, error over stated error is below 0.82."""
    powers = [error_and_differences(steps, order, power) for power in np.arange(least, 8.01, 0.25)]
    for pair in combinations(powers, 2):
        error, *changes = np.transpose(pair)
        assert np.abs(np.linalg.solve(np.transpose(changes), error)).sum() / SAFETY < 0.82
