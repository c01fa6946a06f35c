"""Anderson's mixing on linear maps, and when updates are mixed or have stagnated."""

from __future__ import annotations

import numpy as np
import pytest

from refimpl.grid import Array
from refimpl.solvers.production import anderson
from refimpl.solvers.production.anderson import AndersonMixing, MixingControl


def skew(n: int, radius: float, seed: int) -> Array:
    """A skew matrix of that spectral radius."""
    a = np.random.default_rng(seed).normal(size=(n, n))
    b = a - a.T
    found: Array = radius * b / np.linalg.norm(b, 2)
    return found


def iterates(matrix: Array, start: Array, updates: int) -> list[Array]:
    """Iterates of the mixing on ``g(x) = matrix x``."""
    mixing, used = AndersonMixing(), [start]
    for _ in range(updates):
        used.append(mixing.next(used[-1], (matrix @ used[-1].ravel()).reshape(start.shape)))
    return used


@pytest.mark.parametrize(("updates", "depth"), [(1, 20), (3, 20), (6, 20), (6, 3), (9, 3), (5, 1)])
def test_the_defect_that_remains_is_least_over_the_last_differences(
    updates: int, depth: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """By least squares of a reference; as long as all differences are kept this is GMRES' residual."""
    monkeypatch.setattr(anderson, "DEPTH", depth)
    n = 12
    matrix, start = skew(n, 2.0, seed=2), np.ones((1, n))
    used = np.array([x.ravel() for x in iterates(matrix, start, updates)])
    defects = used @ matrix.T - used
    kept = slice(max(0, updates - 1 - depth), updates - 1)
    changes, moves = np.diff(defects, axis=0).T[:, kept], np.diff(used, axis=0).T[:, kept]
    last = defects[updates - 1]
    shares = np.linalg.lstsq(changes, last, rcond=None)[0] if updates > 1 else np.empty(0)
    remains = last - changes @ shares
    expected = used[updates - 1] - moves @ shares + 0.5 * remains
    np.testing.assert_allclose(used[updates], expected, rtol=0, atol=1e-10 * np.abs(used).max())


def test_differences_that_are_alike_but_for_little_count_once() -> None:
    """Their difference is noise: a step that makes use of it would be a thousand times as long."""
    mixing = AndersonMixing()
    for x, defect in ((0.0, (4.0, 1e-3)), (1.0, (3.0, 1e-3)), (2.0, (2.0, 1e-3 + 1e-6))):
        used = np.array([[x, 0.0]])
        found = mixing.next(used, used + np.array([defect]))
    # the defect along their common direction vanishes there
    assert found[0, 0] == pytest.approx(4.0, rel=1e-6)
    assert found[0, 1] == pytest.approx(0.5e-3, rel=1e-2)


def test_without_a_defect_nothing_moves() -> None:
    """Differences of zero are kept, and may be subtracted any number of times."""
    mixing, x = AndersonMixing(), np.array([[1.0, 2.0]])
    for _ in range(3):
        x = mixing.next(x, x)
    assert np.array_equal(x, [[1.0, 2.0]])


def begun(*, has_lag: bool = True, needs_mixing: bool = False) -> MixingControl:
    return MixingControl(1.0, has_lag=has_lag, needs_mixing=needs_mixing)


def test_mixing_is_there_from_the_first_where_a_coarser_grid_needed_it() -> None:
    assert begun(needs_mixing=True).mixing is not None
    assert begun().mixing is None
    assert begun(has_lag=False, needs_mixing=True).mixing is None


@pytest.mark.parametrize(
    ("feedbacks", "mixed"),
    [
        ((0.31, 0.31), True),
        ((0.31, 0.29, 0.31), False),
        ((0.29, 0.31, 0.31), True),
        ((0.29, 0.29, 0.29), False),
        ((2.0,), False),
    ],
)
def test_two_updates_in_a_row_of_strong_feedback_start_the_mixing(
    feedbacks: tuple[float, ...], mixed: bool
) -> None:
    """A single one may be a contact that opens."""
    control = begun()
    for feedback in feedbacks:
        control.record(0.9, feedback)
    assert (control.mixing is not None) is mixed


@pytest.mark.parametrize("unit", [1.0, 1e-6])
@pytest.mark.parametrize(("residuals", "mixed"), [([0.51] * 5, True), ([0.51] * 4 + [0.49], False)])
def test_five_updates_that_do_not_halve_the_best_residual_start_the_mixing(
    residuals: list[float], mixed: bool, unit: float
) -> None:
    control = MixingControl(unit, has_lag=True, needs_mixing=False)
    for residual in residuals:
        control.record(residual * unit, 0.0)
    assert (control.mixing is not None) is mixed
    assert not control.stagnated


def test_without_lag_nothing_is_mixed_and_five_updates_stagnate() -> None:
    control = begun(has_lag=False)
    for _ in range(5):
        assert not control.stagnated
        control.record(0.9, 0.9)
    assert control.mixing is None
    assert control.stagnated


def test_mixed_updates_drop_their_history_after_ten_and_stagnate_after_thirty() -> None:
    control = begun(needs_mixing=True)
    mixings = []
    for _ in range(30):
        assert not control.stagnated
        mixings.append(control.mixing)
        control.record(0.9, 0.9)
    assert control.stagnated
    assert [len({id(m) for m in mixings[i : i + 10]}) for i in (0, 10, 20)] == [1, 1, 1]
    assert len({id(m) for m in mixings}) == 3


def test_patience_begins_anew_where_mixing_starts() -> None:
    control = begun()
    for _ in range(2):
        control.record(0.9, 0.9)
    for _ in range(30):
        assert not control.stagnated
        control.record(0.9, 0.9)
    assert control.stagnated
