"""Beds of pins: what their numbers rest on, and that no second solution could be a right answer too."""

from __future__ import annotations

from dataclasses import replace
from itertools import product

import numpy as np
import pytest

from refimpl.grid import Array
from verification.exact.fourier import symbol_at
from verification.exact.textbook import normal_offsets, shear_offsets
from verification.solver_suite import own, reference_solution
from verification.solver_suite.check import COMPLIANCE, MODULUS, Entrant
from verification.solver_suite.checks.sliding_pins import FREE, PERIODIC
from verification.solver_suite.gaps import rough_bump
from verification.solver_suite.pin_arrays import FAR, PinArray, integrals, standing, uneven
from verification.solver_suite.protocol import ContactProblem, Coupling
from verification.solver_suite.suite import run

ARRAYS = (*FREE, *PERIODIC)


def problem(array: PinArray, *, by_load: bool = True) -> ContactProblem:
    """The problem that an array poses."""
    posed: list[ContactProblem] = []

    def watching(asked: ContactProblem) -> Array:
        posed.append(asked)
        return array.pressure

    watching.abilities = own.solve.abilities  # type: ignore[attr-defined]  # as solvers carry them
    (array.under_load if by_load else array.at_approach)(Entrant(watching))
    return posed[0]


@pytest.mark.parametrize("array", ARRAYS)
@pytest.mark.parametrize("by_load", [True, False], ids=["load", "approach"])
def test_chosen_pressures_solve_what_is_posed(array: PinArray, by_load: bool) -> None:
    """To the rounding of the mean gap, a thousand times what the pins give way."""
    assert reference_solution.residual(problem(array, by_load=by_load), array.pressure).worst < 1e-11


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


def test_the_convolution_for_large_squares_is_the_dense_product(monkeypatch: pytest.MonkeyPatch) -> None:
    gap, f = rough_bump(9, 7), np.random.default_rng(8).random((9, 9))
    f[2:5, 3] = 0.0
    coupling = Coupling(0.3, 0.4, COMPLIANCE, 0.9)
    posed = ContactProblem(gap - gap.min(), 0.1, MODULUS, load=1.0, coupling=coupling)
    dense = reference_solution.by_pressure(posed, f), reference_solution.displacement(posed, f)
    monkeypatch.setattr(reference_solution, "LARGEST", 8)
    np.testing.assert_allclose(reference_solution.by_pressure(posed, f), dense[0], rtol=1e-13)
    np.testing.assert_allclose(reference_solution.displacement(posed, f), dense[1], rtol=1e-13)


def test_tables_of_offsets_are_the_50_digit_integrals() -> None:
    normal, shear = normal_offsets((160, 160)), shear_offsets((160, 160), 0.0)
    for i, j in ((159, 159), (-159, 100), (3, -158), (-1, 1), (0, 0)):
        exact = integrals(i, j)
        assert normal[i + 159, j + 159] == pytest.approx(exact[0], rel=2e-11)
        assert shear[i + 159, j + 159] == pytest.approx(exact[1], rel=3e-9, abs=1e-15)


def test_a_bed_stands_in_all_corners_and_on_all_edges() -> None:
    contact = standing(12)
    assert np.count_nonzero(contact) == 12
    assert all(contact[i, j] for i in (0, -1) for j in (0, -1))
    assert all(edge[1:-1].any() for edge in (contact[0], contact[-1], contact[:, 0], contact[:, -1]))
    array = PinArray(uneven(contact, 1))
    assert 0 <= array.gap[contact].min() < array.gap[contact].max() < 1e-2 * FAR


def test_the_note_tells_where_a_wrong_answer_is_off() -> None:
    def doubled(asked: ContactProblem) -> Array:
        found = np.array(own.solve(asked).pressure)
        found[2, 3] *= 2
        return found

    (result,) = run(doubled, ["contestant/pins"])
    assert (result.status, result.unit) == ("fail", "claims")
    assert "farthest off is element [2, 3]" in result.note
    assert "of the right load" in result.note
