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


def test_what_is_cut_without_a_pressure_stops_nobody_else() -> None:
    """The second element has none to lose and leaves; the first goes on to the best point of the line."""
    cg = springs(4.0, [1.0, 0.0], [-1.25, 0.5])
    cg.contact[:] = True
    cg.iterate()
    np.testing.assert_allclose(cg.pressure, [[5.0, 0.0]], rtol=1e-15)
    assert cg.contact.tolist() == [[True, False]]


def test_a_cut_goes_no_further_than_to_zero() -> None:
    cg = springs(4.0, [1.0, 1.0], [3.25, -3.25])  # residuals -3.5, 3: best is 9 times the cut trial
    cg.iterate()
    np.testing.assert_allclose(cg.pressure, [[0.0, 1 + 3 * 0.8 * 0.7]], rtol=1e-15)
    assert cg.contact.tolist() == [[False, True]]


def test_of_a_pressure_that_vanishes_nothing_is_left() -> None:
    """However the length at which it does so rounds."""
    for first, second in np.random.default_rng(4).uniform(1, 2, (50, 2)):
        cg = springs(4.0, [first, second], [0.25 * first, -9.0])  # as above, the first residual is negative
        cg.iterate()
        assert cg.pressure[0, 0] == 0
        assert cg.pressure[0, 1] > second


def test_an_exact_step_is_cut_at_zero_pressure_and_what_is_cut_leaves() -> None:
    cg = springs(1.0, [1.0, 1.0], [1.0, -3.0])
    cg._trusted = False
    cg.iterate()
    np.testing.assert_array_equal(cg.pressure, [[0.0, 3.0]])
    assert cg.contact.tolist() == [[False, True]]
    assert max(cg.residuals()) == 0


def test_a_trial_is_cut_at_zero_pressure_and_what_is_cut_leaves() -> None:
    cg = springs(1.0, [1.0, 1.0], [3.0, -3.0])  # residuals -4 and 2
    cg.iterate()
    np.testing.assert_allclose(cg.pressure, [[0.0, 1.0 + 2 * 0.8 * 0.7]], rtol=1e-15)
    assert cg.contact.tolist() == [[False, True]]


def test_a_trial_that_leaves_nothing_is_given_up_for_the_exact_step() -> None:
    cg = springs(0.1, [1.0, 2.0], [-5.0, -5.0])  # residuals -5 and -15, of which a tenth would do
    cg.iterate()
    np.testing.assert_allclose(cg.pressure, [[0.5, 0.5]], rtol=1e-14)


def test_contact_is_pressure_or_penetration() -> None:
    assert springs(1.0, [1.0, 0.0, -1.0], [0.0, 0.0, 0.0]).contact.tolist() == [[True, False, False]]
    cg = springs(1.0, [1.0, 0.0, 0.0], [-1.0, 0.0, -1e-9])  # the second just touches
    cg.iterate()
    assert cg.contact.tolist() == [[True, False, True]]


def test_a_step_that_changes_nothing_tells_no_length() -> None:
    cg = springs(1.0, [1.0], [-1.0])
    cg.iterate()
    assert cg.pressure.tolist() == [[1.0]]
    assert not cg._trusted


def test_surfaces_apart_leave_no_residual() -> None:
    assert springs(1.0, [0.0, 0.0], [1.0, 2.0]).residuals() == (0.0, 0.0)


@pytest.mark.parametrize("last", [1.5, 2.0])
def test_a_direction_forgets_the_past_where_the_quotient_is_negative(last: float) -> None:
    """Polak and Ribiere's is then restarted."""
    cg = springs(1.0, [1.0, 1.0], [0.0, 0.0])
    cg._direction, cg._residual, cg._product = np.array([[3.0, 7.0]]), np.array([[last, 0.0]]), 1.0
    step = np.array([[1.0, 0.0]])
    assert cg._conjugate(step, step).tolist() == step.tolist()


def test_an_exact_step_that_cuts_nothing_applies_once_and_restores_the_trust() -> None:
    applied: list[np.ndarray] = []

    def recording(f: np.ndarray) -> np.ndarray:
        applied.append(f)
        return f.copy()

    cg = ProjectedCG(recording, np.copy, np.array([[1.0, 0.0]]))
    cg.set_problem(np.array([[-3.0, 5.0]]), np.ones((1, 2)), target=None, approach=0.0)
    applied.clear()
    assert cg._trusted
    cg._trusted = False
    cg.iterate()
    assert len(applied) == 1
    assert cg.pressure.tolist() == [[3.0, 0.0]]
    assert cg._trusted


def test_a_contact_that_is_not_at_its_approach_is_off_by_that() -> None:
    """By the work of its pressure on what misses it, over the energy, on either side of the approach."""
    for pressure in (0.25, 1e6):
        for b in (-1.25, 1.25):
            off, _ = springs(2.0, [pressure, pressure], [b - pressure / 2, b - pressure / 2]).residuals()
            energy = 2 * 0.5 * pressure**2 / 2
            assert off == pytest.approx(2 * pressure * 1.25 / energy, rel=1e-9)


def test_what_misses_the_approach_on_both_sides_counts_by_its_mean_and_by_penetration() -> None:
    """A gap above the lowest separation is complementarity's, as under a load."""
    cg = springs(2.0, [1.0, 1.0], [-0.25 - 0.5, 0.25 - 0.5])
    energy = 2 * 0.5 * 1.0 / 2
    assert cg.residuals() == pytest.approx((0.5 / energy, 0.25), rel=1e-12)


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


def test_residuals_are_never_negative() -> None:
    """A mean over one element may round to less than that element's own separation."""
    for pressure in np.random.default_rng(2).uniform(1, 2, 50):
        cg = springs(3.0, [pressure], [0.1], target=pressure)
        assert min(cg.residuals()) >= 0


def test_without_contact_what_penetrates_comes_in() -> None:
    """An empty set takes no step; the next one is on what came in."""
    cg = springs(4.0, [0.0, 0.0], [1.0, 2.0])
    for _ in range(2):
        cg.iterate()
        assert not cg.contact.any()
    cg.set_problem(np.array([[-1.0, 2.0]]), np.ones((1, 2)), target=None, approach=0.0)
    cg.iterate()
    assert cg.contact.tolist() == [[True, False]]
    assert cg.pressure.tolist() == [[0.0, 0.0]]
    cg.iterate()
    np.testing.assert_allclose(cg.pressure, [[4.0, 0.0]], rtol=1e-15)


def test_a_direction_forgets_a_past_of_next_to_no_product() -> None:
    """Lengths of 1e-160 have products that doubles hardly hold, and quotients beyond them."""
    cg = springs(4.0, [1.0, 1.0], [0.0, 0.0])
    cg._exchange()
    cg._direction, cg._residual, cg._product = np.array([[0.0, 7.0]]), np.array([[0.0, 0.0]]), 5e-324
    cg._exchanged = True
    step = np.array([[1.0, 2.0]])
    np.testing.assert_array_equal(cg._conjugate(np.array([[1e10, 0.0]]), step), step)


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


@pytest.mark.parametrize(("K", "spared"), [(1.0, True), (0.9, False), (2.0, False)])
def test_a_weight_of_one_for_all_is_recognised(K: float, spared: bool) -> None:
    """It spares multiplications; an array of ones does not."""
    cg = ProjectedCG(np.copy, np.copy, np.array([[1.0, 2.0]]))
    cg.set_problem(np.zeros((1, 2)), np.broadcast_to(K, (1, 2)), target=3.0, approach=None)
    assert cg._unweighted is spared
    cg.set_problem(np.zeros((1, 2)), np.full((1, 2), K), target=3.0, approach=None)
    assert not cg._unweighted
