"""Beds of pins: what their numbers rest on, and that no second solution could be a right answer too."""

from __future__ import annotations

from dataclasses import replace
from itertools import product

import numpy as np
import pytest

from refimpl.grid import Array
from verification.contestants import own, referee
from verification.contestants.beds import FAR, Bed, integrals, standing, uneven
from verification.contestants.check import COMPLIANCE, MODULUS, Entrant
from verification.contestants.checks.sliding_pins import FREE, PERIODIC
from verification.contestants.gaps import rough_bump
from verification.contestants.protocol import ContactProblem, Coupling
from verification.contestants.suite import run
from verification.exact.fourier import symbol_at
from verification.properties.textbook import normal_offsets, shear_offsets

BEDS = (*FREE, *PERIODIC)


def problem(bed: Bed, *, by_load: bool = True) -> ContactProblem:
    """The problem that a bed poses."""
    posed: list[ContactProblem] = []

    def watching(asked: ContactProblem) -> Array:
        posed.append(asked)
        return bed.pressure

    watching.abilities = own.solve.abilities  # type: ignore[attr-defined]  # as contestants carry them
    (bed.under_load if by_load else bed.at_approach)(Entrant(watching))
    return posed[0]


@pytest.mark.parametrize("bed", BEDS)
@pytest.mark.parametrize("by_load", [True, False], ids=["load", "approach"])
def test_chosen_pressures_solve_what_is_posed(bed: Bed, by_load: bool) -> None:
    """To the rounding of the mean gap, a thousand times what the pins give way."""
    assert referee.residual(problem(bed, by_load=by_load), bed.pressure).worst < 1e-11


def solutions(bed: Bed, *, by_load: bool) -> int:
    """How many contact sets, with tau on just these, satisfy all conditions: one elimination for each."""
    pins, M, c = np.argwhere(bed.pressure > 0), len(bed.pressure), bed.coupling
    assert c is not None
    flat = ContactProblem(np.zeros((M, M)), 1 / M, MODULUS, load=1.0, periodic=bed.periodic)
    rubbed = replace(flat, coupling=replace(c, tau=0.0, beta=1.0))
    units = [np.zeros((M, M)) for _ in pins]
    for one, pin in zip(units, pins, strict=True):
        one[tuple(pin)] = 1.0
    at = tuple(pins.T)
    normal = np.column_stack([referee.displacement(flat, one)[at] for one in units])
    shear = np.column_stack([referee.displacement(rubbed, one)[at] for one in units]) - normal
    A, level = normal + c.beta * shear, np.array(bed.touch)
    sets = np.array(list(product((0.0, 1.0), repeat=len(pins)))[1:])
    lifted = bed.gap[at] + c.tau * sets @ shear.T
    systems = sets[:, :, None] * A * sets[:, None, :] + np.eye(len(pins)) * (1 - sets[:, :, None])
    one, other = np.moveaxis(np.linalg.solve(systems, np.stack([sets, sets * lifted], axis=-1)), -1, 0)
    if by_load:
        level = ((bed.pressure.sum() + other.sum(axis=1)) / one.sum(axis=1))[:, None]
    f = level * one - other
    closed = ((f > 0) | (sets == 0)).all(axis=1)
    apart = (f @ A.T + lifted >= level - 1e-12 * bed.touch).all(axis=1)
    return int(np.count_nonzero(closed & apart))


@pytest.mark.parametrize("bed", BEDS)
@pytest.mark.parametrize("by_load", [True, False], ids=["load", "approach"])
def test_no_other_contact_with_tau_on_it_is_a_solution(bed: Bed, by_load: bool) -> None:
    assert solutions(bed, by_load=by_load) == 1


def test_with_lighter_pins_and_more_tau_there_is_a_second_solution() -> None:
    """Why the beds are no harsher: found with 0.1 % of the peak and a fifth of it as tau."""
    bed = PERIODIC[1]
    share = bed.pressure[bed.pressure > 0] / bed.pressure.max()
    harsher = np.zeros_like(bed.pressure)
    harsher[bed.pressure > 0] = bed.pressure.max() * share**1.2
    coupling = Coupling(0.2 * float(bed.pressure.max()), 0.4, -COMPLIANCE, 2.2)
    assert solutions(replace(bed, pressure=harsher, coupling=coupling), by_load=True) == 2


def test_periodic_displacement_is_the_sum_of_all_modes() -> None:
    bed, M = PERIODIC[2], 13
    c = bed.coupling
    assert c is not None
    x, q = np.arange(M) / M, 2 * np.pi * np.arange(-6, 7)
    shear = c.tau * (bed.pressure > 0) + c.beta * bed.pressure
    u = 0.0
    for qx, qy in product(q, q):
        wave = np.exp(1j * (qx * x[:, None] + qy * x[None, :]))
        normal = complex(symbol_at(qx, qy, MODULUS))
        along = np.cos(c.sliding_direction) * qx + np.sin(c.sliding_direction) * qy
        slip = -2j * np.pi * c.shear_compliance * along / (qx**2 + qy**2) if qx or qy else 0.0
        amplitude = (normal * bed.pressure + slip * shear) * wave.conj()
        u += (amplitude.sum() * wave[2, 4] / M**2).real
    assert u == pytest.approx(float(bed.moved[2, 4]), rel=1e-12)


def test_the_convolution_for_large_squares_is_the_dense_product(monkeypatch: pytest.MonkeyPatch) -> None:
    gap, f = rough_bump(9, 7), np.random.default_rng(8).random((9, 9))
    f[2:5, 3] = 0.0
    coupling = Coupling(0.3, 0.4, COMPLIANCE, 0.9)
    posed = ContactProblem(gap - gap.min(), 0.1, MODULUS, load=1.0, coupling=coupling)
    dense = referee.by_pressure(posed, f), referee.displacement(posed, f)
    monkeypatch.setattr(referee, "LARGEST", 8)
    np.testing.assert_allclose(referee.by_pressure(posed, f), dense[0], rtol=1e-13)
    np.testing.assert_allclose(referee.displacement(posed, f), dense[1], rtol=1e-13)


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
    bed = Bed(uneven(contact, 1))
    assert 0 <= bed.gap[contact].min() < bed.gap[contact].max() < 1e-2 * FAR


def test_the_note_tells_where_a_wrong_answer_is_off() -> None:
    def doubled(asked: ContactProblem) -> Array:
        found = np.array(own.solve(asked).pressure)
        found[2, 3] *= 2
        return found

    (result,) = run(doubled, ["contestant/pins"])
    assert (result.status, result.unit) == ("fail", "claims")
    assert "farthest off is element [2, 3]" in result.note
    assert "of the right load" in result.note
