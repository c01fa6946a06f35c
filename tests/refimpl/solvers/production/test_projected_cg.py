"""Projected CG, free and capped: steps by hand, on lists and on windows. Its states: `test_plain`."""

from __future__ import annotations

import math

import numpy as np
import pytest

import refimpl as rf
from refimpl.grid import Array, Grid
from refimpl.operators.influence import window_influence
from refimpl.operators.preconditioner import Apply, SpectralPreconditioner
from refimpl.solvers.production import contact_vectors
from refimpl.solvers.production.capped_cg import CappedCG, filled_up
from refimpl.solvers.production.contact_vectors import cut_at_zero
from refimpl.solvers.production.projected_cg import ProjectedCG
from verification.exact.dense_influence import DenseInfluence

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


def test_a_weight_that_is_one_somewhere_is_not_one_for_all() -> None:
    K = WEIGHTS.copy()
    K[0, 0] = 1.0
    cg = start()
    cg.set_problem(K * BOWL, K, target=1e7, approach=None)
    run(cg)
    np.testing.assert_allclose(cg.separation, cg.normal_displacement / K + BOWL, rtol=1e-14)


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


@pytest.mark.parametrize("misfit", [0.125, -0.125])
@pytest.mark.parametrize(
    ("clearance", "stiffness", "undecided"),
    [(0.26, 1.0, 0), (0.25, 1.0, 1), (1.0, 7.9, 0), (1.0, 8.0, 1), (0.25, 8.0, 2)],
)
def test_contact_is_decided_beyond_twice_the_misfit(
    misfit: float, clearance: float, stiffness: float, undecided: int
) -> None:
    """Of an element under a pressure of 2, and of another with that clearance; a third is far away."""
    cg = ProjectedCG(lambda f: f.copy(), lambda r: r.copy(), np.array([[2.0, 0.0, 0.0]]))
    cg.set_problem(
        np.array([[misfit - 1.0, clearance + 1.0, 1e9]]), np.ones((1, 3)), target=None, approach=1.0
    )
    assert cg.undecided(stiffness) == undecided
    assert cg.undecided(stiffness, np.array([[True, False, False]])) == (stiffness >= 2 / 0.25)


def winkler(
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
    cg = winkler(4.0, [unit, unit, unit], [0.25 * unit, -1.25 * unit, -0.25 * unit])  # residuals -1/2, 1, 0
    cg.iterate()
    np.testing.assert_allclose(cg.pressure / unit, [[0.0, 3.0, 1.0]], rtol=1e-15)
    np.testing.assert_allclose(cg.normal_displacement / unit, [[0.0, 0.75, 0.25]], rtol=1e-15)
    assert cg.contact.tolist() == [[False, True, True]]
    cg.iterate()
    np.testing.assert_allclose(cg.pressure / unit, [[0.0, 5.0, 1.0]], rtol=1e-14)


def test_an_exact_step_is_cut_at_zero_pressure_and_what_is_cut_leaves() -> None:
    cg = winkler(1.0, [1.0, 1.0], [1.0, -3.0])
    cg._trusted = False
    cg.iterate()
    np.testing.assert_array_equal(cg.pressure, [[0.0, 3.0]])
    assert cg.contact.tolist() == [[False, True]]
    assert max(cg.residuals()) == 0


def test_a_trial_that_leaves_nothing_is_given_up_for_the_exact_step() -> None:
    cg = winkler(0.1, [1.0, 2.0], [-5.0, -5.0])  # residuals -5 and -15, of which a tenth would do
    cg.iterate()
    np.testing.assert_allclose(cg.pressure, [[0.5, 0.5]], rtol=1e-14)


def test_a_contact_that_is_not_at_its_approach_is_off_by_that() -> None:
    """By the work of its pressure on what misses it, over the energy, on either side of the approach."""
    for pressure in (0.25, 1e6):
        for b in (-1.25, 1.25):
            off, _ = winkler(2.0, [pressure, pressure], [b - pressure / 2, b - pressure / 2]).residuals()
            energy = 2 * 0.5 * pressure**2 / 2
            assert off == pytest.approx(2 * pressure * 1.25 / energy, rel=1e-9)


@pytest.mark.parametrize("approach", [2.0, -0.5])
def test_penetration_is_relative_to_the_approach(approach: float) -> None:
    cg = ProjectedCG(np.copy, np.copy, np.array([[1.0, 0.0]]))
    cg.set_problem(
        np.array([[approach - 1.0, approach - 0.25]]), np.ones((1, 2)), target=None, approach=approach
    )
    assert cg.residuals()[1] == pytest.approx(0.25 / abs(approach), rel=1e-15)


def cut(pressure: list[float], step: list[float], target: float | None) -> tuple[bool, np.ndarray]:
    """True if the cut trial has any pressure, and the change that leads to it, with weights of one."""
    before, change = np.array([pressure]), np.array([step])
    return cut_at_zero(before + change, before, change, np.ones_like(before), target), change


def test_little_load_that_a_cut_adds_is_taken_from_what_rises() -> None:
    """Here 1 of 11,000: the third rises by 3, the fourth falls as it did, the second ends at zero."""
    kept, change = cut([5000.0, 1.0, 4999.0, 1000.0], [0.0, -2.0, 4.0, -2.0], target=11000.0)
    assert kept
    np.testing.assert_allclose(change, [[0.0, -1.0, 3.0, -2.0]], rtol=1e-12)


def test_weights_count() -> None:
    """An element of twice the weight bears twice the load."""
    before, change = np.array([[300.0, 1.0, 199.5]]), np.array([[1.0, -3.0, 0.5]])
    weights = np.array([[2.0, 1.0, 2.0]])
    assert cut_at_zero(before + change, before, change, weights, target=1001.0)
    assert float((weights * (before + change)).sum()) == pytest.approx(1001.0, rel=1e-15)


def capped_cg(
    pressure: list[float], gap: list[float], *, approach: float | None, cap: float = 4.0
) -> CappedCG:
    """Under the pressures' own load, or at an approach."""
    f = np.array([pressure])
    cg = CappedCG(lambda p: 1.0 * p, lambda r: 1.0 * r, f, cap)
    target = float(f.sum()) if approach is None else None
    cg.set_problem(np.array([gap]), np.broadcast_to(1.0, f.shape), target=target, approach=approach)
    return cg


def test_without_free_elements_the_approach_is_the_middle() -> None:
    """Between 4 + 1 at the cap and 9 without pressure; without the latter it is 5."""
    assert capped_cg([4.0, 4.0, 0.0], [0.5, 1.0, 9.0], approach=None).approach == 7.0
    assert capped_cg([4.0, 4.0], [0.5, 1.0], approach=None).approach == 5.0


@pytest.mark.parametrize(("pressure", "undecided"), [(1.0, 0), (3.7, 2), (4.0, 2)])
def test_contact_is_decided_only_well_below_the_cap(pressure: float, undecided: int) -> None:
    cg = capped_cg([pressure, 0.0], [1.0, 50.0], approach=pressure + 1.0)
    assert cg.undecided(1.0) == undecided


def test_pressures_are_filled_up_to_the_load_and_no_farther_than_the_cap() -> None:
    ones: Array = np.ones((1, 3))
    np.testing.assert_allclose(filled_up(np.array([[1.0, 2.0, 3.0]]), ones, 9.0, 4.0), [[5 / 3, 10 / 3, 4.0]])
    full = filled_up(np.array([[1.0, 2.0, 0.0]]), ones, 9.0, 4.0)
    np.testing.assert_array_equal(full, [[4.0, 4.0, 0.0]])
    assert not math.isinf(full.max())


@pytest.mark.parametrize("name", ["table1-rough", "rough-planes"])
def test_solutions_are_the_same_by_either(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """To rounding: measured 5e-15 of the largest pressure."""
    found = []
    for share in (0.0, 1.0):
        monkeypatch.setattr(contact_vectors, "LIST_SHARE", share)
        found.append(rf.solve(rf.read_scene(name), 48, tolerance=1e-10))
    one, other = found
    assert one.converged
    assert other.converged
    assert np.array_equal(one.contact, other.contact)
    np.testing.assert_allclose(one.pressure, other.pressure, rtol=0, atol=1e-12 * one.max_pressure)
