"""The energy norm of proven bounds: its least eigenvalue on any elements, its dual, its rounding."""

from __future__ import annotations

import math

import mpmath as mp
import numpy as np
import pytest

import refimpl as rf
from refimpl.bounds.energy_norm import _ROUNDING, EnergyNorm, smallest_symbol
from tests.refimpl.solution.frozen import M, posed, scene, widened
from verification.exact.dense_influence import DenseInfluence


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


def test_an_indefinite_norm_has_no_dual() -> None:
    n = 4
    K = 2.0 * (np.indices((n, n)).sum(axis=0) % 2)
    norm = EnergyNorm(posed(np.zeros((n, n)), load=1.0, periodic=True), K)
    assert -1 < norm.floor < 0
    everywhere = np.ones((n, n), dtype=bool)
    assert math.isinf(norm.dual_norm(np.ones((n, n)), everywhere))
    assert norm.dual_norm(np.zeros((n, n)), everywhere) == 0


def test_dual_norm_is_a_bound_whatever_conjugate_gradients_return(monkeypatch: pytest.MonkeyPatch) -> None:
    norm = EnergyNorm(rf.solve(scene(1), M, tolerance=0.5).details.problem, np.ones((M, M)))
    right, where = np.random.default_rng(3).standard_normal((M, M)), np.ones((M, M), dtype=bool)
    z, az = norm.solve(right, where)
    exact = norm.dual_norm(right, where)
    for share in (0.0, 0.5, 1.5):
        monkeypatch.setattr(norm, "solve", lambda *_, share=share: (share * z, share * az))
        assert 0.99 * exact <= norm.dual_norm(right, where) < math.inf


@pytest.mark.parametrize(
    ("aspect", "least", "most"), [(1.0, 0.0, 1e-10), (1.7, 0.9e-12, 1.1e-12), (1e3, 0.9e-12, 1.1e-12)]
)
def test_it_is_the_integral_to_many_digits(aspect: float, least: float, most: float) -> None:
    """By other code: Poisson's sum for small t, tanh-sinh quadrature.

    Below the integral by 1e-12 of its value; square elements have a constant of ten digits.
    """

    def alternating(t: mp.mpf) -> mp.mpf:
        if t < 2:
            waves = (
                (-1) ** n / mp.mpf(2 * n + 1) * mp.exp(-(((n + 0.5) * mp.pi / t) ** 2)) for n in range(12)
            )
            return 4 / (mp.sqrt(mp.pi) * t) * mp.fsum(waves)
        tails = ((-1) ** m * mp.erfc((m + mp.mpf(1) / 2) * t) for m in range(12))
        return mp.sqrt(mp.pi) / t * (1 - 2 * mp.fsum(tails))

    with mp.workdps(25):
        a = mp.mpf(aspect)
        total = mp.quad(
            lambda t: alternating(t) * a * alternating(a * t), [0, 0.5, 1, 2, 4, 8, 16, 64, mp.inf]
        )
        exact = 2 / mp.sqrt(mp.pi) * total
        assert least < (exact - mp.mpf(smallest_symbol(aspect))) / exact < most
