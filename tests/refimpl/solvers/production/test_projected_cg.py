"""Projected CG on small problems, against principal pivoting on the same matrices."""

from __future__ import annotations

import numpy as np
import pytest

from refimpl.grid import Grid
from refimpl.model.gap import relative_gap
from refimpl.operators.dense import DenseInfluence
from refimpl.operators.fft import FFTInfluence
from refimpl.operators.preconditioner import SpectralPreconditioner
from refimpl.solvers.pivoting import complementarity
from refimpl.solvers.production.projected_cg import ProjectedCG

M, SIDE, COMPLIANCE = 10, 1e-3, 1e-11
GRID = Grid(SIDE, M)
A = COMPLIANCE * DenseInfluence(GRID, 0.0).normal_matrix
RANDOM = np.random.default_rng(11)
X = (GRID.centres - SIDE / 2) / SIDE
BOWL = 4e-6 * (X[:, None] ** 2 + X[None, :] ** 2) + RANDOM.uniform(0, 2e-7, (M, M))
WEIGHTS = RANDOM.uniform(0.9, 1.0, (M, M))
"""Stand for cos theta_x cos theta_y."""


def start(pressure: np.ndarray | None = None) -> ProjectedCG:
    spectral = SpectralPreconditioner(FFTInfluence(GRID, 0.0), COMPLIANCE)
    first = np.where(np.quantile(BOWL, 0.2) >= BOWL, 1e6, 0.0) if pressure is None else pressure
    return ProjectedCG(lambda f: (A @ f.ravel()).reshape(f.shape), spectral, first)


def run(cg: ProjectedCG, steps: int = 80) -> np.ndarray:
    for _ in range(steps):
        if max(cg.residuals()) < 1e-14:
            break
        cg.iterate()
    assert max(cg.residuals()) < 1e-12
    return cg.pressure


@pytest.mark.parametrize("approach", [1e-7, 4e-7, 1.5e-6, 1e-5])
def test_prescribed_approach(approach: float) -> None:
    """From a few elements to all of them in contact."""
    cg = start()
    cg.freeze(WEIGHTS * BOWL, WEIGHTS, target=None, approach=approach)
    q = (WEIGHTS * (BOWL - approach)).ravel()
    exact = complementarity(A, q, np.zeros(M * M, dtype=bool)).pressure.reshape(M, M)
    found = run(cg)
    assert np.array_equal(found > 0, exact > 0)
    np.testing.assert_allclose(found, exact, atol=1e-11 * exact.max(), rtol=0)


@pytest.mark.parametrize("target", [1e4, 1e7, 1e9])
def test_prescribed_load(target: float) -> None:
    """The load holds exactly at every step; the approach found gives the same state when prescribed."""
    cg = start()
    cg.freeze(WEIGHTS * BOWL, WEIGHTS, target=target, approach=None)
    for _ in range(5):
        cg.iterate()
        assert np.vdot(WEIGHTS, cg.pressure) == pytest.approx(target, rel=1e-13)
    found = run(cg)
    approach = cg.approach
    q = (WEIGHTS * (BOWL - approach)).ravel()
    exact = complementarity(A, q, (found > 0).ravel()).pressure.reshape(M, M)
    np.testing.assert_allclose(found, exact, atol=1e-9 * exact.max(), rtol=0)


@pytest.mark.parametrize("uniform", [1.0, 0.9, 1.1])
def test_one_weight_for_all_may_be_broadcast(uniform: float) -> None:
    found = []
    for K in (np.broadcast_to(uniform, (M, M)), np.full((M, M), uniform)):
        cg = start()
        cg.freeze(BOWL, K, target=1e7, approach=None)
        found.append((run(cg), cg.approach, cg._unweighted))
    (one, approach, spared), (other, same, counted) = found
    np.testing.assert_allclose(one, other, rtol=0, atol=1e-12 * other.max())
    assert approach == pytest.approx(same, rel=1e-12)
    assert spared is (uniform == 1)
    assert not counted


def test_a_weight_that_is_one_somewhere_is_not_one_for_all() -> None:
    K = WEIGHTS.copy()
    K[0, 0] = 1.0
    cg = start()
    cg.freeze(K * BOWL, K, target=1e7, approach=None)
    run(cg)
    assert not cg._unweighted
    np.testing.assert_allclose(cg.separation, cg.normal_displacement / K + BOWL, rtol=1e-14)


def test_a_single_element_may_be_all_there_is() -> None:
    cg = ProjectedCG(lambda f: f / 2, lambda r: r.copy(), np.array([[1.0]]))
    cg.freeze(np.array([[0.5]]), np.broadcast_to(1.0, (1, 1)), target=3.0, approach=None)
    assert cg._unweighted
    assert cg.approach == 2.0


def test_any_start_leads_to_one_state() -> None:
    states = []
    for first in (np.ones((M, M)), np.eye(M), np.full((M, M), 1e9)):
        cg = start(first)
        cg.freeze(WEIGHTS * BOWL, WEIGHTS, target=1e7, approach=None)
        states.append(run(cg))
    for other in states[1:]:
        np.testing.assert_allclose(other, states[0], atol=1e-10 * states[0].max(), rtol=0)


def test_the_displacement_is_always_that_of_the_pressure() -> None:
    cg = start()
    cg.freeze(BOWL, np.ones((M, M)), target=1e7, approach=None)
    for _ in range(10):
        cg.iterate()
        exact = (A @ cg.pressure.ravel()).reshape(M, M)
        np.testing.assert_allclose(cg.normal_displacement, exact, rtol=1e-12)
        assert cg.pressure.min() >= 0
        assert not np.any(cg.pressure[~cg.contact])


def test_a_single_element() -> None:
    spike = np.full((M, M), 1e-3)
    spike[3, 4] = 0.0
    cg = start(np.ones((M, M)))
    cg.freeze(spike, np.ones((M, M)), target=5e5, approach=None)
    found = run(cg)
    assert np.count_nonzero(found) == 1
    assert found[3, 4] == pytest.approx(5e5, rel=1e-14)


@pytest.mark.parametrize(("load", "doubts"), [(1e3, 12), (1e9, 3)])  # a few elements, and all of them
def test_one_application_a_step_once_lengths_are_trusted(load: float, doubts: int) -> None:
    counted = 0
    cg = start()
    apply = cg._apply

    def counting(f: np.ndarray) -> np.ndarray:
        nonlocal counted
        counted += 1
        return apply(f)

    cg._apply = counting
    cg.freeze(BOWL, np.ones((M, M)), target=load, approach=None)
    untrusted = 0
    for _ in range(12):
        untrusted += not cg._trusted
        cg.iterate()
    assert 12 <= counted <= 12 + untrusted
    assert untrusted <= doubts


def test_an_exact_step_restores_the_trust() -> None:
    cg = start()
    assert cg._trusted
    cg._trusted = False
    cg.freeze(BOWL, np.ones((M, M)), target=1e7, approach=None)
    cg.iterate()
    assert cg._trusted


@pytest.mark.parametrize(("target", "approach"), [(1e4, None), (1e7, None), (1e9, None), (None, 4e-7)])
def test_the_unit_of_pressure_changes_no_bit(target: float | None, approach: float | None) -> None:
    """Powers of two scale without rounding, so every decision must be the same."""
    unit = 2.0**-60
    one = start()
    spectral = one._precondition
    other = ProjectedCG(
        lambda f: (A @ f.ravel()).reshape(f.shape) / unit, lambda r: unit * spectral(r), unit * one.pressure
    )
    one.freeze(WEIGHTS * BOWL, WEIGHTS, target=target, approach=approach)
    other.freeze(WEIGHTS * BOWL, WEIGHTS, target=None if target is None else unit * target, approach=approach)
    for _ in range(15):
        one.iterate()
        other.iterate()
        assert np.array_equal(other.pressure, unit * one.pressure)
        assert np.array_equal(other.contact, one.contact)
        assert other.residuals() == one.residuals()


@pytest.mark.parametrize(("target", "approach"), [(1e12, None), (None, 1e-4)])
def test_directions_are_conjugate_while_the_set_stays(target: float | None, approach: float | None) -> None:
    """All elements in contact, on a slight unevenness: CG, which steepest descent is not."""
    cg = start(np.full((M, M), 1e7))
    cg.freeze(BOWL, np.ones((M, M)), target=target, approach=approach)
    directions: list[np.ndarray] = []
    for _ in range(8):
        cg.iterate()
        assert cg.contact.all()
        assert cg._direction is not None
        directions.append(cg._direction.ravel())
    energies = np.array(directions) @ A @ np.array(directions).T
    sizes = np.sqrt(np.diag(energies))
    # rounding grows from step to step as the directions fall by a tenth each: measured 1e-11
    assert np.abs(energies / np.outer(sizes, sizes) - np.eye(8)).max() <= 1e-9


@pytest.mark.parametrize("target", [1e8, 10**9.5, 1e12])
def test_directions_keep_the_load_when_the_contact_changes(target: float) -> None:
    """Late changes leave something of the last direction, whose part off the contact must be made up for."""
    cg = start()
    cg.freeze(WEIGHTS * BOWL, WEIGHTS, target=target, approach=None)
    while max(cg.residuals()) > 1e-6:
        before = cg.contact.copy()
        cg.iterate()
        assert cg._direction is not None
        direction = cg._support.onto(cg._direction)
        assert not direction[~before].any()
        assert abs(np.vdot(WEIGHTS, direction)) <= 1e-14 * M**2 * np.abs(direction).max()


def test_relative_gap() -> None:
    assert relative_gap(0.0, 0.0) == 0
    assert relative_gap(1.0, 2.0) == 0.5
    assert relative_gap(1.0, 0.0) == np.inf
    assert relative_gap(1.0, -1.0) == np.inf
    assert relative_gap(-1.0, 2.0) == -0.5


def test_a_trial_is_a_little_shorter_than_the_last_length() -> None:
    """At first than what the preconditioned spectrum, between 1 and 2, suggests."""
    asked: list[np.ndarray] = []
    cg = start(np.ones((M, M)))
    apply = cg._apply

    def recording(f: np.ndarray) -> np.ndarray:
        asked.append(f)
        return apply(f)

    cg._apply = recording
    cg.freeze(np.zeros((M, M)), np.ones((M, M)), target=None, approach=1e-6)
    cg.iterate()
    assert cg._direction is not None
    np.testing.assert_allclose(asked[0], 0.8 * 0.7 * cg._direction, rtol=1e-6)


def test_a_step_that_overshoots_every_element_leaves_no_tension() -> None:
    """At an approach nothing keeps the sum: springs that do not reach the other body all leave."""
    cg = ProjectedCG(lambda f: f.copy(), lambda r: r.copy(), np.array([[1.0, 2.0]]))
    cg.freeze(np.array([[5.0, 4.0]]), np.ones((1, 2)), target=None, approach=0.0)
    assert max(cg.residuals()) > 0.1
    cg._trusted = False
    cg.iterate()
    assert not cg.pressure.any()
    assert not cg.contact.any()
    assert cg.residuals() == (0.0, 0.0)


@pytest.mark.parametrize("misfit", [0.125, -0.125])
@pytest.mark.parametrize(
    ("clearance", "stiffness", "beyond"),
    [(0.26, 1.0, True), (0.25, 1.0, False), (1.0, 7.9, True), (1.0, 8.0, False), (0.25, 8.0, False)],
)
def test_no_doubt_is_left_beyond_twice_the_misfit(
    misfit: float, clearance: float, stiffness: float, beyond: bool
) -> None:
    """Of an element under a pressure of 2, and of another with that clearance; a third is far away."""
    cg = ProjectedCG(lambda f: f.copy(), lambda r: r.copy(), np.array([[2.0, 0.0, 0.0]]))
    cg.freeze(np.array([[misfit - 1.0, clearance + 1.0, 1e9]]), np.ones((1, 3)), target=None, approach=1.0)
    assert cg.beyond_doubt(stiffness) is beyond


def test_elements_about_to_touch_are_doubtful() -> None:
    cg = ProjectedCG(lambda f: f.copy(), lambda r: r.copy(), np.array([[2.0, 0.0]]))
    cg.freeze(np.array([[-1.0, 0.5]]), np.ones((1, 2)), target=None, approach=1.0)
    cg._enter(cg.separation < cg.approach)
    assert cg.contact.all()
    assert not cg.beyond_doubt(1e-9)
