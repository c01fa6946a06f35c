"""Beds of pins: what their numbers rest on, and that no second solution could be a right answer too."""

from __future__ import annotations

from dataclasses import replace
from itertools import product

import numpy as np
import pytest

from tests.verification.solver_suite.asked import problem_of
from verification.exact.fourier import symbol_at
from verification.solver_suite import reference_solution
from verification.solver_suite.check import COMPLIANCE, MODULUS
from verification.solver_suite.checks.sliding import FREE, PERIODIC
from verification.solver_suite.pin_arrays import FAR, PinArray, standing, uneven
from verification.solver_suite.protocol import ContactProblem, Coupling

ARRAYS = (*FREE, *PERIODIC)


@pytest.mark.parametrize("array", ARRAYS)
@pytest.mark.parametrize("by_load", [True, False], ids=["load", "approach"])
def test_chosen_pressures_solve_what_is_posed(array: PinArray, by_load: bool) -> None:
    """To the rounding of the mean gap, a thousand times what the pins give way."""
    assert reference_solution.residual(problem_of(array, by_load=by_load), array.pressure).worst < 1e-11


def solutions(array: PinArray, *, by_load: bool) -> int:
    """How many contact sets, with tau on just these, satisfy all conditions: one elimination for each."""
    pins, M, c = np.argwhere(array.pressure > 0), len(array.pressure), array.coupling
    assert c is not None
    flat = ContactProblem(np.zeros((M, M)), 1 / M, MODULUS, load=1.0, periodic=array.periodic)
    rubbed = replace(flat, coupling=replace(c, tau=0.0, beta=1.0))
    units = [np.zeros((M, M)) for _ in pins]
    for one, pin in zip(units, pins, strict=True):
        one[tuple(pin)] = 1.0
    at = tuple(pins.T)
    normal = np.column_stack([reference_solution.displacement(flat, one)[at] for one in units])
    shear = np.column_stack([reference_solution.displacement(rubbed, one)[at] for one in units]) - normal
    A, level = normal + c.beta * shear, np.array(array.touch)
    sets = np.array(list(product((0.0, 1.0), repeat=len(pins)))[1:])
    lifted = array.gap[at] + c.tau * sets @ shear.T
    systems = sets[:, :, None] * A * sets[:, None, :] + np.eye(len(pins)) * (1 - sets[:, :, None])
    one, other = np.moveaxis(np.linalg.solve(systems, np.stack([sets, sets * lifted], axis=-1)), -1, 0)
    if by_load:
        level = ((array.pressure.sum() + other.sum(axis=1)) / one.sum(axis=1))[:, None]
    f = level * one - other
    closed = ((f > 0) | (sets == 0)).all(axis=1)
    apart = (f @ A.T + lifted >= level - 1e-12 * array.touch).all(axis=1)
    return int(np.count_nonzero(closed & apart))


@pytest.mark.parametrize("array", ARRAYS)
@pytest.mark.parametrize("by_load", [True, False], ids=["load", "approach"])
def test_no_other_contact_with_tau_on_it_is_a_solution(array: PinArray, by_load: bool) -> None:
    assert solutions(array, by_load=by_load) == 1


def test_with_lighter_pins_and_more_tau_there_is_a_second_solution() -> None:
    """Why the pin arrays are no harsher: found with 0.1 % of the peak and a fifth of it as tau."""
    array = PERIODIC[1]
    share = array.pressure[array.pressure > 0] / array.pressure.max()
    harsher = np.zeros_like(array.pressure)
    harsher[array.pressure > 0] = array.pressure.max() * share**1.2
    coupling = Coupling(0.2 * float(array.pressure.max()), 0.4, -COMPLIANCE, 2.2)
    assert solutions(replace(array, pressure=harsher, coupling=coupling), by_load=True) == 2


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
