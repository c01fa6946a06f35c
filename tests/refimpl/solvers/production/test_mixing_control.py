"""When updates are mixed, when their history is dropped, and when they have stagnated."""

from __future__ import annotations

import pytest

from refimpl.solvers.production.anderson import MixingControl


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


def test_progress_renews_patience() -> None:
    control = begun(needs_mixing=True)
    mixing = control.mixing
    for k in range(1, 60):
        control.record(0.9 if k % 9 else 0.4**k, 0.0)
    assert not control.stagnated
    assert control.mixing is mixing
