"""Anderson's mixing against what it must be on linear maps."""

from __future__ import annotations

import numpy as np
import pytest

from refimpl.grid import Array
from refimpl.solvers.production import anderson
from refimpl.solvers.production.anderson import Mixing


def skew(n: int, radius: float, seed: int) -> Array:
    """A skew matrix of that spectral radius."""
    a = np.random.default_rng(seed).normal(size=(n, n))
    b = a - a.T
    found: Array = radius * b / np.linalg.norm(b, 2)
    return found


def followed(matrix: Array, start: Array, updates: int) -> list[Array]:
    """What is held by turns, on ``g(x) = matrix x``."""
    mixed, held = Mixing(), [start]
    for _ in range(updates):
        held.append(mixed.mixed(held[-1], (matrix @ held[-1].ravel()).reshape(start.shape)))
    return held


@pytest.mark.parametrize("radius", [2.0, 5.0, 30.0])
def test_a_linear_map_is_solved_in_as_many_updates_as_it_has_dimensions(radius: float) -> None:
    """And one to begin with; plain updates grow by the radius each."""
    n, start = 8, np.ones((2, 4))
    held = followed(skew(n, radius, seed=1), start, n + 1)
    assert np.abs(held[-1]).max() <= 1e-9 * radius
    assert np.abs(held[-2]).max() > 1e-6


@pytest.mark.parametrize("updates", [1, 3, 6])
def test_what_is_left_lacking_is_gmres_residual(updates: int) -> None:
    """Before the share is added: least over all combinations, by the normal equations of a reference."""
    n = 12
    matrix, start = skew(n, 2.0, seed=2), np.ones((1, n))
    held = np.array([x.ravel() for x in followed(matrix, start, updates)])
    lacks = held @ matrix.T - held
    differences = np.diff(lacks, axis=0).T[:, : updates - 1]
    last = lacks[updates - 1]
    shares = np.linalg.lstsq(differences, last, rcond=None)[0] if updates > 1 else np.empty(0)
    moved = np.diff(held, axis=0).T[:, : updates - 1]
    left = last - differences @ shares
    expected = held[updates - 1] - moved @ shares + 0.5 * left
    np.testing.assert_allclose(held[updates], expected, rtol=0, atol=1e-10)


def test_only_the_last_differences_are_remembered(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(anderson, "_DEPTH", 3)
    mixed, x = Mixing(), np.ones((1, 10))
    matrix = skew(10, 2.0, seed=3)
    held, lacks = [], []
    for _ in range(6):
        asked = (matrix @ x.ravel())[None]
        held.append(x)
        lacks.append(asked - x)
        x = mixed.mixed(x, asked)
    changes, moves = np.diff(lacks, axis=0)[-3:], np.diff(held, axis=0)[-3:]
    np.testing.assert_allclose(mixed._changes, changes, rtol=0, atol=1e-14)
    np.testing.assert_allclose(mixed._steps, moves + 0.5 * changes, rtol=0, atol=1e-14)
    expected = [[np.vdot(a, b) for a in mixed._changes] for b in mixed._changes]
    np.testing.assert_allclose(mixed._products, expected, rtol=1e-13)


def test_differences_that_are_alike_but_for_little_count_once() -> None:
    """What they differ by is nobody's: a step that makes use of it would be a thousand times as long."""
    mixed = Mixing()
    for x, lack in ((0.0, (4.0, 1e-3)), (1.0, (3.0, 1e-3)), (2.0, (2.0, 1e-3 + 1e-6))):
        held = np.array([[x, 0.0]])
        found = mixed.mixed(held, held + np.array([lack]))
    assert found[0, 0] == pytest.approx(4.0, rel=1e-6)  # there nothing lacks along what they have in common
    assert found[0, 1] == pytest.approx(0.5e-3, rel=1e-2)


def test_where_nothing_is_lacking_nothing_moves() -> None:
    """Differences of zero are remembered, and taken back as often as one likes."""
    mixed, x = Mixing(), np.array([[1.0, 2.0]])
    for _ in range(3):
        x = mixed.mixed(x, x)
    assert np.array_equal(x, [[1.0, 2.0]])


def test_arguments_are_left_as_they_are() -> None:
    mixed = Mixing()
    held, asked = np.ones((1, 3)), np.full((1, 3), 2.0)
    for _ in range(3):
        mixed.mixed(held, asked)
    assert np.array_equal(held, np.ones((1, 3)))
    assert np.array_equal(asked, np.full((1, 3), 2.0))
