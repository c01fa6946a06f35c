"""Single steps of projected CG on elements that do not feel each other: cuts, exchanges, trusted lengths."""

from __future__ import annotations

import numpy as np
import pytest

from refimpl.solvers.production.projected_cg import ProjectedCG


def springs(
    stiffness: float, pressure: list[float], b: list[float], target: float | None = None
) -> ProjectedCG:
    """A row of elements that do not feel each other, ``a f = f / stiffness``, at the approach 0 or loaded."""
    cg = ProjectedCG(lambda f: f / stiffness, lambda r: r.copy(), np.array([pressure]))
    cg.set_problem(
        b=np.array([b]), K=np.ones((1, len(b))), target=target, approach=0.0 if target is None else None
    )
    return cg


@pytest.mark.parametrize("unit", [1.0, 1e-6])
def test_a_step_beyond_the_trial_ends_where_the_first_pressure_vanishes(unit: float) -> None:
    """That element leaves the contact, and the rest keeps what the shorter step gave it."""
    cg = springs(4.0, [unit, unit, unit], [0.25 * unit, -1.25 * unit, -0.25 * unit])  # residuals -1/2, 1, 0
    cg.iterate()
    np.testing.assert_allclose(cg.pressure / unit, [[0.0, 3.0, 1.0]], rtol=1e-15)
    np.testing.assert_allclose(cg.normal_displacement / unit, [[0.0, 0.75, 0.25]], rtol=1e-15)
    assert cg.contact.tolist() == [[False, True, True]]
    cg.iterate()
    np.testing.assert_allclose(cg.pressure / unit, [[0.0, 5.0, 1.0]], rtol=1e-14)


def test_an_exact_step_is_cut_at_zero_pressure_and_what_is_cut_leaves() -> None:
    cg = springs(1.0, [1.0, 1.0], [1.0, -3.0])
    cg._trusted = False
    cg.iterate()
    np.testing.assert_array_equal(cg.pressure, [[0.0, 3.0]])
    assert cg.contact.tolist() == [[False, True]]
    assert max(cg.residuals()) == 0


def test_a_trial_that_leaves_nothing_is_given_up_for_the_exact_step() -> None:
    cg = springs(0.1, [1.0, 2.0], [-5.0, -5.0])  # residuals -5 and -15, of which a tenth would do
    cg.iterate()
    np.testing.assert_allclose(cg.pressure, [[0.5, 0.5]], rtol=1e-14)


def test_contact_is_pressure_or_penetration() -> None:
    assert springs(1.0, [1.0, 0.0, -1.0], [0.0, 0.0, 0.0]).contact.tolist() == [[True, False, False]]
    cg = springs(1.0, [1.0, 0.0, 0.0], [-1.0, 0.0, -1e-9])  # the second just touches
    cg.iterate()
    assert cg.contact.tolist() == [[True, False, True]]


@pytest.mark.parametrize("last", [1.5, 2.0])
def test_a_direction_forgets_the_past_where_the_quotient_is_negative(last: float) -> None:
    """Polak and Ribiere's is then restarted."""
    cg = springs(1.0, [1.0, 1.0], [0.0, 0.0])
    cg._direction, cg._residual, cg._product = np.array([[3.0, 7.0]]), np.array([[last, 0.0]]), 1.0
    step = np.array([[1.0, 0.0]])
    assert cg._conjugate(step, step).tolist() == step.tolist()


def test_a_contact_that_is_not_at_its_approach_is_off_by_that() -> None:
    """By the work of its pressure on what misses it, over the energy, on either side of the approach."""
    for pressure in (0.25, 1e6):
        for b in (-1.25, 1.25):
            off, _ = springs(2.0, [pressure, pressure], [b - pressure / 2, b - pressure / 2]).residuals()
            energy = 2 * 0.5 * pressure**2 / 2
            assert off == pytest.approx(2 * pressure * 1.25 / energy, rel=1e-9)


def test_a_trial_that_leads_uphill_is_not_taken() -> None:
    """Nothing moves, and only what the trial would have lowered to nothing leaves the contact."""
    cg = springs(1.0, [1.0, 0.0, 0.0], [0.0, 0.0, 0.0])
    cg.contact[:] = True
    cg._exchange()
    uphill = np.array([[1.0, 0.5, -0.5]])
    assert cg._step_to_trial(-uphill, uphill)
    np.testing.assert_array_equal(cg.pressure, [[1.0, 0.0, 0.0]])
    np.testing.assert_array_equal(cg.normal_displacement, [[1.0, 0.0, 0.0]])
    assert cg.contact.tolist() == [[True, True, False]]
    assert not cg._trusted


@pytest.mark.parametrize(("ratio", "trusted"), [(0.3, False), (0.42, True), (2.4, True), (3.5, False)])
def test_lengths_are_trusted_as_far_as_the_spectrum_goes(ratio: float, trusted: bool) -> None:
    """Preconditioned, it lies between 0.9 and 2.2 (above): lengths up to 2.44 times the last are its own."""
    stiffness = 0.8 * 0.7 * ratio  # which is the exact length, and the trial's is 0.8 * 0.7
    cg = springs(stiffness, [1e3, 1e3, 0.0], [*2 * [-1e3 / stiffness - 1.0], 1.0])
    cg.iterate()
    np.testing.assert_allclose(cg.pressure, [[1e3 + stiffness, 1e3 + stiffness, 0.0]], rtol=1e-12)
    assert cg._length == pytest.approx(stiffness, rel=1e-9)
    assert cg._trusted is trusted


def test_a_step_that_overshoots_every_element_leaves_no_tension() -> None:
    """At an approach nothing keeps the sum: elements that do not reach the other body all leave."""
    cg = springs(1.0, [1.0, 2.0], [5.0, 4.0])
    assert max(cg.residuals()) > 0.1
    cg._trusted = False
    cg.iterate()
    assert not cg.pressure.any()
    assert not cg.contact.any()
    assert cg.residuals() == (0.0, 0.0)


@pytest.mark.parametrize("approach", [2.0, -0.5])
def test_penetration_is_relative_to_the_approach(approach: float) -> None:
    cg = ProjectedCG(np.copy, np.copy, np.array([[1.0, 0.0]]))
    cg.set_problem(
        np.array([[approach - 1.0, approach - 0.25]]), np.ones((1, 2)), target=None, approach=approach
    )
    assert cg.residuals()[1] == pytest.approx(0.25 / abs(approach), rel=1e-15)
