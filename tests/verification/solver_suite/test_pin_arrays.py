"""Beds of pins: chosen pressures solve what is posed, and stand where grids have their corners."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest

from tests.verification.solver_suite.asked import problem_of
from verification.exact.fourier import symbol_at
from verification.solver_suite import reference_solution
from verification.solver_suite.check import MODULUS
from verification.solver_suite.checks.sliding import FREE, PERIODIC
from verification.solver_suite.pin_arrays import FAR, PinArray, standing, uneven

ARRAYS = (*FREE, *PERIODIC)


@pytest.mark.parametrize("array", ARRAYS)
@pytest.mark.parametrize("by_load", [True, False], ids=["load", "approach"])
def test_chosen_pressures_solve_what_is_posed(array: PinArray, by_load: bool) -> None:
    """To the rounding of the mean gap, a thousand times what the pins give way."""
    assert reference_solution.residual(problem_of(array, by_load=by_load), array.pressure).worst < 1e-11


def test_periodic_displacement_is_the_sum_of_all_modes() -> None:
    array, M = PERIODIC[2], 13
    c = array.coupling
    assert c is not None
    x, q = np.arange(M) / M, 2 * np.pi * np.arange(-6, 7)
    shear = c.tau * (array.pressure > 0) + c.beta * array.pressure
    u = 0.0
    for qx, qy in product(q, q):
        wave = np.exp(1j * (qx * x[:, None] + qy * x[None, :]))
        normal = complex(symbol_at(qx, qy, MODULUS))
        along = np.cos(c.sliding_direction) * qx + np.sin(c.sliding_direction) * qy
        slip = -2j * np.pi * c.shear_compliance * along / (qx**2 + qy**2) if qx or qy else 0.0
        amplitude = (normal * array.pressure + slip * shear) * wave.conj()
        u += (amplitude.sum() * wave[2, 4] / M**2).real
    assert u == pytest.approx(float(array.moved[2, 4]), rel=1e-12)


def test_a_bed_stands_in_all_corners_and_on_all_edges() -> None:
    contact = standing(12)
    assert np.count_nonzero(contact) == 12
    assert all(contact[i, j] for i in (0, -1) for j in (0, -1))
    assert all(edge[1:-1].any() for edge in (contact[0], contact[-1], contact[:, 0], contact[:, -1]))
    array = PinArray(uneven(contact, 1))
    assert 0 <= array.gap[contact].min() < array.gap[contact].max() < 1e-2 * FAR
