"""Projected CG on small problems, against principal pivoting on the same matrices."""

from __future__ import annotations

import numpy as np
import pytest

from refimpl.contact.active_set import complementarity
from refimpl.contact.preconditioner import SpectralPreconditioner, _over_q
from refimpl.contact.projected_cg import ProjectedCG, relative_gap
from refimpl.grid import Grid
from refimpl.operators.dense import DenseInfluence
from refimpl.operators.fft import Counter

M, SIDE, COMPLIANCE = 10, 1e-3, 1e-11
GRID = Grid(SIDE, M)
A = COMPLIANCE * DenseInfluence(GRID, 0.0).normal_matrix
RANDOM = np.random.default_rng(11)
X = (GRID.centres - SIDE / 2) / SIDE
BOWL = 4e-6 * (X[:, None] ** 2 + X[None, :] ** 2) + RANDOM.uniform(0, 2e-7, (M, M))
WEIGHTS = RANDOM.uniform(0.9, 1.0, (M, M))
"""Stand for cos theta_x cos theta_y."""


def start(pressure: np.ndarray | None = None) -> ProjectedCG:
    spectral = SpectralPreconditioner((M, M), GRID.spacing, COMPLIANCE, Counter())
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
    approach = cg.approach(cg.separation)
    q = (WEIGHTS * (BOWL - approach)).ravel()
    exact = complementarity(A, q, (found > 0).ravel()).pressure.reshape(M, M)
    np.testing.assert_allclose(found, exact, atol=1e-9 * exact.max(), rtol=0)


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


def test_the_preconditioner_is_symmetric_and_positive() -> None:
    spectral = SpectralPreconditioner((7, 5), 1e-4, COMPLIANCE, Counter())
    matrix = np.array([spectral(row.reshape(7, 5)).ravel() for row in np.eye(35)])
    np.testing.assert_allclose(matrix, matrix.T, atol=1e-14 * matrix.max())
    assert np.linalg.eigvalsh(matrix).min() > 0


def test_the_preconditioner_clusters_the_spectrum() -> None:
    """What it is there for: the condition number of 100 elements falls by half at least."""
    spectral = SpectralPreconditioner((M, M), GRID.spacing, COMPLIANCE, Counter())
    matrix = np.array([spectral(row.reshape(M, M)).ravel() for row in np.eye(M * M)])
    values = np.sort(np.linalg.eigvals(matrix @ A).real)
    assert values[0] > 0
    assert values[-1] / values[0] < 0.5 * np.linalg.cond(A)


def test_the_spectrum_on_a_disc_lies_between_one_and_about_two() -> None:
    """What the first step's length rests on; a periodic window and one fold cost a few per cent below one."""
    n = 24
    grid = Grid(SIDE, n)
    spectral = SpectralPreconditioner((n, n), grid.spacing, COMPLIANCE, Counter())
    x = np.arange(n) - (n - 1) / 2
    disc = (x[:, None] ** 2 + x[None, :] ** 2 < (0.45 * n) ** 2).ravel()
    inverse = np.array([spectral(row.reshape(n, n)).ravel() for row in np.eye(n * n)[disc]])[:, disc]
    flexibility = COMPLIANCE * DenseInfluence(grid, 0.0).normal_matrix[np.ix_(disc, disc)]
    # on the tangent space of the load, as CG works
    tangent = np.eye(disc.sum()) - 1 / disc.sum()
    values = np.sort(np.linalg.eigvals(tangent @ inverse @ tangent @ flexibility).real)[1:]
    assert values[0] > 0.9
    assert values[-1] < 2.2


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


def test_relative_gap() -> None:
    assert relative_gap(0.0, 0.0) == 0
    assert relative_gap(1.0, 2.0) == 0.5
    assert relative_gap(1.0, 0.0) == np.inf
    assert relative_gap(1.0, -1.0) == np.inf


@pytest.mark.parametrize("shape", [(4, 12), (12, 4), (12, 12)])
def test_the_mean_has_half_of_the_smallest_frequency(shape: tuple[int, int]) -> None:
    """q = pi over the longer edge, along either axis."""
    precondition = SpectralPreconditioner(shape, 0.5, 3.0, Counter(), band_limited=True)
    q = np.pi / (max(shape) * 0.5)
    np.testing.assert_allclose(precondition(np.ones(shape)), q / (2 * np.pi * 3.0), rtol=1e-14)


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


def test_one_fold_is_nearly_the_full_sum() -> None:
    """Against twenty folds: 0.081 off in the band's corner, 0.025 in the mean; without one 0.22, 0.06."""
    n, spacing = 12, 0.5
    folded = 1 / (2 * np.pi * 3.0 * SpectralPreconditioner((n, n), spacing, 3.0, Counter())._symbol)
    q_x = (2 * np.pi * np.fft.fftfreq(n, spacing)[:, None]).astype(np.float64)
    q_y = (2 * np.pi * np.fft.rfftfreq(n, spacing)[None, :]).astype(np.float64)
    error = np.abs(folded / _over_q(q_x, q_y, spacing, folds=20) - 1)
    assert error.max() <= 0.085
    assert error.mean() <= 0.03


def test_the_symbol_in_the_bands_corner_and_in_its_middle() -> None:
    """By hand: bands meet there at odd multiples of pi/h, with sinc(1/2) = 2/pi and sinc(3/2) = -2/(3 pi)."""
    n, spacing = 64, 0.5
    precondition = SpectralPreconditioner(
        shape=(n, n), spacing=spacing, compliance=1 / (2 * np.pi), counter=Counter()
    )
    sincs = {-1: 2 / np.pi, 1: 2 / np.pi, 3: -2 / (3 * np.pi)}
    folded = sum(sincs[k] * sincs[m] / np.hypot(k, m) for k in sincs for m in sincs) * spacing / np.pi
    assert precondition._symbol[n // 2, n // 2] == pytest.approx(1 / folded, rel=1e-12)
    # long waves see the half-space alone: sincs and folds are of second order in q h
    for k, m in ((1, 0), (0, 1), (1, 1), (-1, 1)):
        q = 2 * np.pi * np.hypot(k, m) / (n * spacing)
        assert precondition._symbol[k, m] == pytest.approx(q, rel=(q * spacing) ** 2)


def test_a_preconditioners_cost_is_of_the_next_fast_length() -> None:
    counter = Counter()
    SpectralPreconditioner((11, 7), 0.5, 3.0, counter)(np.ones((11, 7)))
    assert counter.point_logs == pytest.approx(96 * np.log2(96), rel=1e-14)  # 12 and 8
