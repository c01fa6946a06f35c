"""Proven bounds of few elements: numbers by hand, rounding, and rows of the shear."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from refimpl.model.slopes import Slopes
from refimpl.solution.bounds import UNPROVEN, _Frozen, _shear_row, proven_bounds
from refimpl.solution.energy_norm import EnergyNorm
from tests.refimpl.solution.frozen import posed, widened
from verification.exact.dense_influence import DenseInfluence


def test_surfaces_apart_leave_the_rounding_of_their_distance() -> None:
    """Half a metre on each of nine elements."""
    nothing = np.zeros((3, 3))
    problem = posed(nothing, approach=-0.5)
    bounds = proven_bounds(problem, nothing, nothing, Slopes.flat((3, 3)))
    noise, floor = 4 * np.finfo(float).eps * 0.5 * 3, EnergyNorm(problem, np.ones((3, 3))).floor
    expected = noise**2 / floor * problem.grid.element_area
    assert bounds.energy == pytest.approx(expected, rel=1e-12, abs=0)
    assert bounds.out_of_contact.all()


@pytest.mark.parametrize(("apart", "sure"), [(10, False), (45, False), (100, True)])
def test_surfaces_closer_than_rounding_are_not_surely_apart(apart: int, sure: bool) -> None:
    """A metre of gap against an approach of a metre, but for so many last digits."""
    nothing = np.zeros((3, 3))
    problem = posed(nothing + 1.0, approach=1 - apart * float(np.finfo(float).eps))
    bounds = proven_bounds(problem, nothing, nothing, Slopes.flat((3, 3)))
    assert bounds.out_of_contact.all() == sure
    assert bounds.out_of_contact.any() == sure


def test_one_loaded_element_of_four_by_hand() -> None:
    """Its diagonal neighbour is at w = 0 exactly and carries nothing: no contact, so it is not solved for."""
    nothing = np.zeros((2, 2))
    pressure = np.array([[1.0, 0.0], [0.0, 0.0]])
    (a, b), (_, d) = EnergyNorm(posed(nothing, load=1.0), np.ones((2, 2))).apply(pressure)
    problem = posed(nothing, approach=float(d))
    norm, flat = EnergyNorm(problem, np.ones((2, 2))), Slopes.flat((2, 2))
    u = np.add(*problem.displacements(norm.operator, pressure, nothing, flat))
    problem = replace(problem, approach=float(u[1, 1]))
    # w - a z off the element, with z = (a - d) / a on it
    left = [d * (1 - b / a), d * (1 - b / a), d * (1 - d / a)]
    residual = (a - d) / math.sqrt(a) + float(np.linalg.norm(left)) / math.sqrt(norm.floor)
    bounds = proven_bounds(problem, pressure, nothing, flat)
    assert bounds.energy == pytest.approx(residual**2 * problem.grid.element_area, rel=1e-9)


def test_a_load_that_shear_carries_alone_fixes_no_contact() -> None:
    """Eq. (2): shear that pulls up a slope takes more than the load off the pressures."""
    problem = posed(np.zeros((3, 3)), load=0.1)
    uphill = Slopes(np.full((3, 3), 0.5), np.zeros((3, 3)))
    bounds = proven_bounds(problem, np.ones((3, 3)), np.full((3, 3), -1.0), uphill)
    assert math.isinf(bounds.energy)
    assert bounds.unproven == "the load does not fix the contact: " + UNPROVEN


@pytest.mark.parametrize("shape", [(1, 1), (2, 2), (5, 5), (4, 6), (5, 2)])
def test_no_row_of_the_shear_is_longer_than_its_corners(shape: tuple[int, int]) -> None:
    """Four corners meet every offset once, those along an axis twice: seen from a wide rectangle's centre."""
    (n, m), zero = shape, np.zeros(shape)
    problem, flat = posed(zero, load=1.0, beta=0.1), Slopes.flat(shape)
    found = _shear_row(_Frozen(problem, EnergyNorm(problem, np.ones(shape)), zero, zero, flat))
    wide = widened(problem.grid)
    row = DenseInfluence(wide, problem.direction).shear_matrix[wide.elements // 2]
    offsets = row.reshape(wide.shape) ** 2
    met = offsets.sum() + offsets[n - 1].sum() + offsets[:, m - 1].sum()
    strength = 0.1 * problem.pair.shear_compliance
    assert found == pytest.approx(abs(strength) * math.sqrt(met), rel=1e-10)
    rows = strength * DenseInfluence(problem.grid, problem.direction).shear_matrix
    assert np.linalg.norm(rows, axis=1).max() <= found
