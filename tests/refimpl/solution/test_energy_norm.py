"""The energy norm of proven bounds: its least eigenvalue, its dual, its rounding."""

from __future__ import annotations

import math

import mpmath as mp
import numpy as np
import pytest

import refimpl as rf
from refimpl.bounds.energy_norm import _ROUNDING, SMALLEST_SYMBOL, EnergyNorm
from refimpl.grid import Array
from tests.refimpl.solution.frozen import M, posed, scene, widened
from verification.exact.dense_influence import DenseInfluence


def test_smallest_symbol_is_enclosed_from_below() -> None:
    """2/sqrt(pi) times the integral of S(pi, t)^2: by Poisson's sum for small t, by error functions else."""

    def S(t: mp.mpf) -> mp.mpf:
        if t < 2:
            k = [mp.pi * (2 * n + 1) for n in range(12)]
            terms = [(-1) ** n * 4 / k[n] * mp.exp(-((k[n] / (2 * t)) ** 2)) for n in range(12)]
            return mp.sqrt(mp.pi) / t * mp.fsum(terms)
        ends = [mp.erf(t * (mp.mpf(j) + mp.mpf(1) / 2)) for j in range(13)]
        B = [ends[0]] + [(ends[j] - ends[j - 1]) / 2 for j in range(1, 13)]
        return mp.sqrt(mp.pi) / t * (B[0] + 2 * mp.fsum((-1) ** j * B[j] for j in range(1, 13)))

    with mp.workdps(20):
        assert abs(S(mp.mpf("1.9999999")) - S(mp.mpf("2.0000001"))) < 1e-6
        finite = mp.quad(lambda t: S(t) ** 2, [0.05, 0.3, 0.6, 1, 2, 4, 8, 16])
        value = 2 / mp.sqrt(mp.pi) * (finite + mp.pi / 16)  # erf is 1 to 20 digits beyond t = 16
        assert 0 < value - mp.mpf(SMALLEST_SYMBOL) < 1e-10


def test_the_claim_behind_the_smallest_symbol() -> None:
    """S(theta, t) >= S(pi, t) >= 0, and A falls with s: sampled, as the proof says."""
    theta = np.linspace(0, np.pi, 201)[1:, None]
    k = theta + 2 * np.pi * np.arange(-60, 61)
    sign = (-1.0) ** np.arange(-60, 61)
    before = np.ones(len(theta))
    for s in np.geomspace(1e-3, 3, 60):
        A = np.sum(sign * 2 * np.sin(theta / 2) * np.exp(-(k**2) * s) / k, axis=1)
        assert A.min() >= A[-1] - 1e-13
        assert A[-1] >= -1e-13
        assert np.max(A - before) <= 1e-13
        before = A


@pytest.mark.parametrize("periodic", [False, True])
@pytest.mark.parametrize(
    ("shape", "lengths"),
    [((10, 10), (1.0, 1.0)), ((12, 8), (1.5, 1.0)), ((9, 12), (1.0, 0.4)), ((8, 11), (0.3, 2.0))],
)
def test_least_eigenvalue_and_dual_norm(
    shape: tuple[int, int], lengths: tuple[float, float], periodic: bool
) -> None:
    problem = posed(np.zeros(shape), lengths=lengths, load=1.0, periodic=periodic)
    K = np.random.default_rng(2).uniform(0.99, 1.0, shape)
    norm = EnergyNorm(problem, K)
    influence = DenseInfluence(problem.grid, 0.0)
    a = problem.pair.normal_compliance * influence.normal_matrix + norm.lift * np.outer(K, K)
    least = float(np.linalg.eigvalsh(a)[0])
    assert 0.9 * least <= norm.floor <= least
    assert norm.diagonal == pytest.approx(a.diagonal().max(), rel=1e-3)
    right, where = np.random.default_rng(3).standard_normal((2, *shape))
    inside = where > 0
    index = np.flatnonzero(inside)
    exact = math.sqrt(right[inside] @ np.linalg.solve(a[np.ix_(index, index)], right[inside]))
    assert exact <= norm.dual_norm(right, inside) <= 1.02 * exact
    assert norm.dual_norm(np.zeros(shape), inside) == 0.0
    e = right * inside
    exact = math.sqrt(e.ravel() @ a @ e.ravel())
    assert exact <= norm.norm(e) <= (1 + 1e-9) * exact


@pytest.mark.parametrize("n", [2, 4])
@pytest.mark.parametrize("uneven", [0.0, 0.5])
@pytest.mark.parametrize("m", [2, 4])
def test_floor_of_a_periodic_rectangle_parts_the_mean_from_the_waves(n: int, m: int, uneven: float) -> None:
    """Waves have the plain matrix's stiffness less what the lift takes, the mean half of the lift's."""
    K = 0.3 + uneven * np.random.default_rng(n).random((n, m)) ** 2
    problem = posed(np.zeros((n, m)), lengths=(1.7, 0.6 * m), load=1.0, periodic=True)
    norm = EnergyNorm(problem, K)
    mean = np.full(n * m, 1 / math.sqrt(n * m))
    plain = problem.pair.normal_compliance * DenseInfluence(problem.grid, 0.0).normal_matrix
    along, across = float(mean @ K.ravel()) ** 2, float(np.sum((K.ravel() - (mean @ K.ravel()) * mean) ** 2))
    waves = float(np.linalg.eigvalsh(plain)[1]) - norm.lift * across
    assert norm.floor == pytest.approx(min(waves, 0.5 * norm.lift * along))
    assert norm.floor <= np.linalg.eigvalsh(plain + norm.lift * np.outer(K, K))[0]


@pytest.mark.parametrize("periodic", [False, True])
@pytest.mark.parametrize("shape", [(4, 4), (6, 3)])
def test_rounding_is_of_the_sum_of_all_coefficients(shape: tuple[int, int], periodic: bool) -> None:
    """The centre of a rectangle of nearly twice the lengths meets each offset once: no row is worse.

    Rounding allows for twice the lengths; 1/rho over a rectangle has a closed form (Johnson 1985, 3.25).
    """
    n, m = shape
    problem, K = posed(np.zeros(shape), load=1.0, periodic=periodic, lengths=(1.7, 1.2)), np.full(shape, 0.7)
    norm, wide = EnergyNorm(problem, K), widened(problem.grid)
    row = problem.pair.normal_compliance * DenseInfluence(wide, 0.0).normal_matrix[wide.elements // 2]
    one, other = np.random.default_rng(7).standard_normal((2, *shape))
    size = float(np.linalg.norm(one) + np.linalg.norm(other))
    a, b = problem.grid.lengths
    reach = problem.pair.normal_compliance * 4 * (a * math.asinh(b / a) + b * math.asinh(a / b))
    assert 1 < reach / row.sum() < (2 * n / (2 * n - 1)) * (2 * m / (2 * m - 1))
    worst = reach + norm.lift * 0.49 * n * m
    assert norm.rounding(one, other) == pytest.approx(_ROUNDING * worst * size, rel=1e-12, abs=0)


def test_dual_norm_of_a_unit_impulse() -> None:
    norm = EnergyNorm(posed(np.zeros((3, 3)), load=1.0), np.ones((3, 3)))
    a = np.array([norm.apply(row.reshape(3, 3)).ravel() for row in np.eye(9)])
    impulse = np.eye(9)[4].reshape(3, 3)
    exact = math.sqrt(np.linalg.inv(a)[4, 4])
    assert exact <= norm.dual_norm(impulse, np.ones((3, 3), dtype=bool)) <= 1.001 * exact


def test_conjugate_gradients_stop_at_a_hundredth(monkeypatch: pytest.MonkeyPatch) -> None:
    """As soon as what is left counts for no more than that of the norm, and no sooner."""
    norm = EnergyNorm(posed(np.zeros((7, 7)), load=1.0), np.ones((7, 7)))
    right, where = np.random.default_rng(5).random((2, 7, 7))
    inside = where > 0.3

    def enough(z: Array, az: Array) -> bool:
        left = float(np.linalg.norm((right - az)[inside]))
        return left / math.sqrt(norm.floor) <= 0.01 * math.sqrt(float(np.vdot(z, az)))

    found, states = norm.solve(right, inside), []
    for iterations in range(8):
        monkeypatch.setitem(EnergyNorm.solve.__globals__, "_ITERATIONS", iterations)
        states.append(norm.solve(right, inside))
    first = [enough(*state) for state in states].index(True)
    assert first > 1
    assert np.array_equal(states[first], found)
    assert np.array_equal(states[-1], found)


def test_dual_norm_allows_for_the_rounding_of_its_product(monkeypatch: pytest.MonkeyPatch) -> None:
    """It may turn the energy by its length times z, and lies across what is left at worst."""
    norm, everywhere = (
        EnergyNorm(posed(np.zeros((5, 5)), load=1.0), np.ones((5, 5))),
        np.ones((5, 5), dtype=bool),
    )
    right = np.random.default_rng(5).random((5, 5))
    z, _ = norm.solve(right, everywhere)
    exact = norm.dual_norm(right, everywhere)
    monkeypatch.setattr(norm, "rounding", lambda *_: 0.1)
    least = exact**2 + 0.1 * float(np.linalg.norm(z)) + 0.1**2 / norm.floor
    assert norm.dual_norm(right, everywhere) ** 2 >= least


def test_an_indefinite_norm_has_no_dual() -> None:
    n = 4
    K = 2.0 * (np.indices((n, n)).sum(axis=0) % 2)
    norm = EnergyNorm(posed(np.zeros((n, n)), load=1.0, periodic=True), K)
    assert -1 < norm.floor < 0
    everywhere = np.ones((n, n), dtype=bool)
    assert math.isinf(norm.dual_norm(np.ones((n, n)), everywhere))
    assert norm.dual_norm(np.zeros((n, n)), everywhere) == 0


def test_dual_norm_is_a_bound_whatever_conjugate_gradients_return(monkeypatch: pytest.MonkeyPatch) -> None:
    norm = EnergyNorm(rf.solve(scene(1), M, tolerance=0.5).problem, np.ones((M, M)))
    right, where = np.random.default_rng(3).standard_normal((M, M)), np.ones((M, M), dtype=bool)
    z, az = norm.solve(right, where)
    exact = norm.dual_norm(right, where)
    for share in (0.0, 0.5, 1.5):
        monkeypatch.setattr(norm, "solve", lambda *_, share=share: (share * z, share * az))
        assert 0.99 * exact <= norm.dual_norm(right, where) < math.inf
