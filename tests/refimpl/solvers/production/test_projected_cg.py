"""Projected CG on small problems, against principal pivoting on the same matrices."""

from __future__ import annotations

import numpy as np
import pytest

from refimpl.grid import Array, Grid
from refimpl.operators.influence import window_influence
from refimpl.operators.preconditioner import Apply, SpectralPreconditioner
from refimpl.solvers.production.projected_cg import ProjectedCG
from verification.exact.dense_influence import DenseInfluence
from verification.exact.pivoting import complementarity

M, SIDE, COMPLIANCE = 10, 1e-3, 1e-11
GRID = Grid.square(SIDE, M)
A = COMPLIANCE * DenseInfluence(GRID, 0.0).normal_matrix
RANDOM = np.random.default_rng(11)
X = (GRID.x - SIDE / 2) / SIDE
BOWL = 4e-6 * (X[:, None] ** 2 + X[None, :] ** 2) + RANDOM.uniform(0, 2e-7, (M, M))
WEIGHTS = RANDOM.uniform(0.9, 1.0, (M, M))
"""Stand for cos theta_x cos theta_y."""
ONES = np.ones((M, M))
FIRST = np.where(np.quantile(BOWL, 0.2) >= BOWL, 1e6, 0.0)


def flexibility(pressure: Array) -> Array:
    return (A @ pressure.ravel()).reshape(pressure.shape)


def spectral() -> SpectralPreconditioner:
    operator = window_influence(GRID, 0.0)
    return SpectralPreconditioner(operator, COMPLIANCE * operator.symbol)


def start(pressure: Array = FIRST, apply: Apply = flexibility) -> ProjectedCG:
    return ProjectedCG(apply, spectral(), pressure)


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
    cg.set_problem(WEIGHTS * BOWL, WEIGHTS, target=None, approach=approach)
    q = (WEIGHTS * (BOWL - approach)).ravel()
    exact = complementarity(A, q, np.zeros(M * M, dtype=bool)).pressure.reshape(M, M)
    found = run(cg)
    assert np.array_equal(found > 0, exact > 0)
    np.testing.assert_allclose(found, exact, atol=1e-11 * exact.max(), rtol=0)


@pytest.mark.parametrize("target", [1e4, 1e7, 1e8, 1e9, 10**9.5, 1e12])
def test_prescribed_load(target: float) -> None:
    """The load holds exactly at every step; the approach found gives the same state when prescribed."""
    cg = start()
    cg.set_problem(WEIGHTS * BOWL, WEIGHTS, target=target, approach=None)
    while max(cg.residuals()) > 1e-12:  # late changes of the contact leave a part of the last direction
        cg.iterate()
        assert np.vdot(WEIGHTS, cg.pressure) == pytest.approx(target, rel=1e-13)
    found = run(cg)
    approach = cg.approach
    q = (WEIGHTS * (BOWL - approach)).ravel()
    exact = complementarity(A, q, (found > 0).ravel()).pressure.reshape(M, M)
    np.testing.assert_allclose(found, exact, atol=1e-9 * exact.max(), rtol=0)


def test_a_weight_that_is_one_somewhere_is_not_one_for_all() -> None:
    K = WEIGHTS.copy()
    K[0, 0] = 1.0
    cg = start()
    cg.set_problem(K * BOWL, K, target=1e7, approach=None)
    run(cg)
    np.testing.assert_allclose(cg.separation, cg.normal_displacement / K + BOWL, rtol=1e-14)


def test_any_start_leads_to_one_state() -> None:
    states = []
    for first in (ONES, np.eye(M), np.full((M, M), 1e9)):
        cg = start(first)
        cg.set_problem(WEIGHTS * BOWL, WEIGHTS, target=1e7, approach=None)
        states.append(run(cg))
    for other in states[1:]:
        np.testing.assert_allclose(other, states[0], atol=1e-10 * states[0].max(), rtol=0)


def test_a_single_element() -> None:
    spike = np.full((M, M), 1e-3)
    spike[3, 4] = 0.0
    cg = start(ONES)
    cg.set_problem(spike, ONES, target=5e5, approach=None)
    found = run(cg)
    assert np.count_nonzero(found) == 1
    assert found[3, 4] == pytest.approx(5e5, rel=1e-14)


@pytest.mark.parametrize(("load", "doubts"), [(1e3, 12), (1e9, 3)])  # a few elements, and all of them
def test_one_application_a_step_once_lengths_are_trusted(load: float, doubts: int) -> None:
    counted = 0

    def counting(pressure: Array) -> Array:
        nonlocal counted
        counted += 1
        return flexibility(pressure)

    cg = start(apply=counting)
    cg.set_problem(BOWL, ONES, target=load, approach=None)
    counted = 0
    for _ in range(12):
        cg.iterate()
    assert 12 <= counted <= 12 + doubts


@pytest.mark.parametrize(("target", "approach"), [(1e4, None), (1e7, None), (1e9, None), (None, 4e-7)])
def test_the_unit_of_pressure_changes_no_bit(target: float | None, approach: float | None) -> None:
    """Powers of two scale without rounding, so every decision must be the same."""
    unit = 2.0**-60
    one, precondition = start(), spectral()
    other = ProjectedCG(lambda f: flexibility(f) / unit, lambda r: unit * precondition(r), unit * FIRST)
    scaled = None if target is None else unit * target
    one.set_problem(WEIGHTS * BOWL, WEIGHTS, target=target, approach=approach)
    other.set_problem(WEIGHTS * BOWL, WEIGHTS, target=scaled, approach=approach)
    for _ in range(15):
        one.iterate()
        other.iterate()
        assert np.array_equal(other.pressure, unit * one.pressure)
        assert np.array_equal(other.contact, one.contact)
        assert other.residuals() == one.residuals()


@pytest.mark.parametrize(("target", "approach"), [(1e12, None), (None, 1e-4)])
def test_steps_are_conjugate_while_the_set_stays(target: float | None, approach: float | None) -> None:
    """All elements in contact, on a slight unevenness: CG, which steepest descent is not."""
    cg = start(np.full((M, M), 1e7))
    cg.set_problem(BOWL, ONES, target=target, approach=approach)
    steps: list[Array] = []
    for _ in range(8):
        before = cg.pressure
        cg.iterate()
        assert cg.contact.all()
        steps.append((cg.pressure - before).ravel())
    energies = np.array(steps) @ A @ np.array(steps).T
    sizes = np.sqrt(np.diag(energies))
    # steps fall by a tenth each, and lose digits of the pressure that they are differences of
    rounding = 1e-15 * np.linalg.norm(cg.pressure) / np.linalg.norm(steps, axis=1)
    bound = 1e-10 + 10 * (rounding[:, None] + rounding)
    assert np.all(np.abs(energies / np.outer(sizes, sizes) - np.eye(8)) <= bound)
    assert bound[:4, :4].max() < 1e-3


@pytest.mark.parametrize("misfit", [0.125, -0.125])
@pytest.mark.parametrize(
    ("clearance", "stiffness", "certain"),
    [(0.26, 1.0, True), (0.25, 1.0, False), (1.0, 7.9, True), (1.0, 8.0, False), (0.25, 8.0, False)],
)
def test_contact_is_certain_beyond_twice_the_misfit(
    misfit: float, clearance: float, stiffness: float, certain: bool
) -> None:
    """Of an element under a pressure of 2, and of another with that clearance; a third is far away."""
    cg = ProjectedCG(lambda f: f.copy(), lambda r: r.copy(), np.array([[2.0, 0.0, 0.0]]))
    cg.set_problem(
        np.array([[misfit - 1.0, clearance + 1.0, 1e9]]), np.ones((1, 3)), target=None, approach=1.0
    )
    assert cg.contact_is_certain(stiffness) is certain
