"""Principal pivoting on complementarity problems with known answers, easy, degenerate and hard."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from refimpl.grid import Mask
from verification.exact import pivoting
from verification.exact.pivoting import complementarity, restricted_solve


def by_enumeration(G: np.ndarray, q: np.ndarray) -> np.ndarray:
    """The solution by trying all supports; the one for which both inequalities hold."""
    n = len(q)
    for support in itertools.product([False, True], repeat=n):
        on = np.array(support)
        f = np.zeros(n)
        if on.any():
            f[on] = np.linalg.solve(G[np.ix_(on, on)], -q[on])
        if f.min() >= -1e-12 and (G @ f + q).min() >= -1e-12:
            return f
    raise AssertionError("no solution: not a P-matrix")


def random_p_matrix(n: int, seed: int, skew: float) -> np.ndarray:
    """A positive definite part and a skew one of any size: a P-matrix, as ``a + beta c`` is."""
    random = np.random.default_rng(seed)
    B, S = random.standard_normal((2, n, n))
    return B @ B.T + 0.1 * np.eye(n) + skew * (S - S.T)


@settings(derandomize=True, deadline=None, max_examples=60)
@given(st.integers(1, 7), st.integers(0, 10**6), st.sampled_from([0.0, 1.0, 10.0]), st.integers(0, 127))
@example(n=7, seed=0, skew=10.0, start=0)
def test_random_problems(n: int, seed: int, skew: float, start: int) -> None:
    G = random_p_matrix(n, seed, skew)
    q = np.random.default_rng(seed + 1).standard_normal(n)
    begin = np.array([bool(start >> k & 1) for k in range(n)])
    found = complementarity(G, q, begin)
    np.testing.assert_allclose(found.pressure, by_enumeration(G, q), atol=1e-9)
    assert np.array_equal(found.free, found.free & (found.pressure >= 0))


EYE2, HALF = np.eye(2), np.array([[2.0, 1.0], [1.0, 2.0]])


@pytest.mark.parametrize(
    ("G", "q", "start", "pressure", "solves"),
    [
        (np.eye(3), [1.0, 1.0, 1.0], [0, 0, 0], [0.0, 0.0, 0.0], 1),  # nothing to do
        (np.eye(50), [-1.0] * 50, [0] * 50, [1.0] * 50, 2),  # one exchange of all, not fifty of one
        (np.diag([1.0, 2.0]), [-1.0, -1.0], [0, 0], [1.0, 0.5], 2),
        # neither pressure nor gap: an element that may belong to either side stays where it is
        (np.eye(4), [0.0] * 4, [1] * 4, [0.0] * 4, 1),
        (np.eye(4), [0.0] * 4, [0] * 4, [0.0] * 4, 1),
        *((HALF, [-2.0, -1.0], [k & 1, k >> 1], [1.0, 0.0], None) for k in range(4)),
        # gaps and pressures that differ from zero by rounding, in the problem's own size
        *((EYE2, [-1.0, gap], [1, 0], [1.0, 0.0], 1) for gap in (-1e-17, 0.0, 1e-17)),
        *((EYE2, [-unit, 0.1 * unit], [k, k], [unit, 0.0], 2) for unit in (1.0, 1e-30) for k in (0, 1)),
        (np.eye(3), [-1.0, 1e-17, -2.0], [1, 1, 1], [1.0, 0.0, 2.0], 1),
    ],
)
def test_known_solutions(
    G: np.ndarray, q: list[float], start: list[int], pressure: list[float], solves: int | None
) -> None:
    found = complementarity(G, np.array(q), np.array(start, dtype=bool))
    np.testing.assert_allclose(found.pressure, pressure, rtol=1e-15, atol=1e-15 * max(pressure))
    assert found.pressure.min() >= 0
    assert solves is None or found.solves == solves
    if solves == 1:
        assert found.free.tolist() == [bool(k) for k in start]


@pytest.mark.parametrize("n", range(2, 9))
def test_murtys_worst_case(n: int) -> None:
    """Murty's (1978) example, on which single exchanges alone take 2^n steps: f = (0, ..., 0, 1)."""
    G = np.eye(n) + 2 * np.triu(np.ones((n, n)), 1)
    found = complementarity(G, -np.ones(n), np.zeros(n, dtype=bool))
    expected = np.zeros(n)
    expected[-1] = 1
    np.testing.assert_allclose(found.pressure, expected, atol=1e-12)


CYCLIC = np.array([[1.0, 2.0, 0.0], [0.0, 1.0, 2.0], [2.0, 0.0, 1.0]])
HARD = [
    (CYCLIC, -np.ones(3), np.array([True, False, False])),
    (CYCLIC, -np.ones(3), np.array([True, True, False])),
    (np.kron(np.eye(4), CYCLIC), -np.ones(12), np.tile([True, False, False], 4)),
    *(
        (random_p_matrix(n, seed, skew), -np.ones(n), np.zeros(n, dtype=bool))
        for n, seed, skew in ((15, 2, 30.0), (12, 0, 100.0), (20, 5, 50.0), (20, 13, 50.0))
    ),
]


@pytest.mark.parametrize(("G", "q", "start"), HARD)
def test_single_exchanges_follow_ten_of_blocks_without_progress(
    G: np.ndarray, q: np.ndarray, start: Mask, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Judice and Pires's rule, judged by the history: one of the last ten counts was a new lowest, or not."""
    visited: list[Mask] = []

    def recorded(G: np.ndarray, right: np.ndarray, active: Mask) -> np.ndarray:
        visited.append(active.copy())
        return restricted_solve(G, right, active)

    monkeypatch.setattr(pivoting, "restricted_solve", recorded)
    found = complementarity(G, q, start)
    assert found.solves == len(visited)
    assert min(found.pressure.min(), (G @ found.pressure + q).min()) >= -1e-9
    counts: list[int] = []
    singles = 0
    for active, after in itertools.pairwise(visited):
        f = restricted_solve(G, -q, active)
        infeasible = np.flatnonzero(np.where(active, f < 0, G @ f + q < 0))
        counts.append(len(infeasible))
        recent = range(max(0, len(counts) - 10), len(counts))
        progress = any(counts[k] < min(counts[:k], default=len(q) + 1) for k in recent)
        expected = infeasible if progress else infeasible[-1:]
        assert np.flatnonzero(active ^ after).tolist() == expected.tolist()
        singles += not progress
    assert singles > 0


@pytest.mark.parametrize("n", [2, 40])
def test_a_matrix_without_the_property_is_named_in_time(n: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """After some tens of exchanges an element: the hard problems above need up to seven."""
    solves = 0

    def counted(G: np.ndarray, right: np.ndarray, active: Mask) -> np.ndarray:
        nonlocal solves
        solves += 1
        return restricted_solve(G, right, active)

    monkeypatch.setattr(pivoting, "restricted_solve", counted)
    with pytest.raises(ArithmeticError, match="no P-matrix"):
        complementarity(-np.eye(n), -np.ones(n), np.zeros(n, dtype=bool))
    assert 10 * (n + 10) <= solves <= 100 * (n + 10)


def test_restricted_solve_takes_several_right_sides() -> None:
    G, right = np.array([[4.0, 1.0], [1.0, 3.0]]), np.array([[8.0, 4.0], [5.0, 6.0]])
    np.testing.assert_array_equal(restricted_solve(G, right, np.array([True, False])), [[2.0, 1.0], [0, 0]])
    np.testing.assert_array_equal(restricted_solve(G, right, np.array([False, False])), np.zeros((2, 2)))
