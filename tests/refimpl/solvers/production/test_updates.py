"""When updates are mixed, when that begins anew, and when they are given up."""

from __future__ import annotations

import pytest

from refimpl.solvers.production.updates import Updates


def begun(*, lags: bool = True, strong: bool = False) -> Updates:
    return Updates(1.0, lags=lags, strong=strong)


def test_mixing_is_there_from_the_first_where_a_coarser_grid_needed_it() -> None:
    assert begun(strong=True).mixing is not None
    assert begun().mixing is None
    assert begun(lags=False, strong=True).mixing is None


@pytest.mark.parametrize(
    ("brought", "mixed"),
    [
        ((0.31, 0.31), True),
        ((0.31, 0.29, 0.31), False),
        ((0.29, 0.31, 0.31), True),
        ((0.29, 0.29, 0.29), False),
        ((2.0,), False),
    ],
)
def test_two_in_a_row_that_bring_much_back_are_mixed(brought: tuple[float, ...], mixed: bool) -> None:
    """One may be a contact that opens."""
    updates = begun()
    for share in brought:
        updates.led_to(0.9, share)
    assert (updates.mixing is not None) is mixed


@pytest.mark.parametrize("unit", [1.0, 1e-6])
@pytest.mark.parametrize(("residuals", "mixed"), [([0.51] * 5, True), ([0.51] * 4 + [0.49], False)])
def test_five_that_do_not_halve_the_best_are_mixed(residuals: list[float], mixed: bool, unit: float) -> None:
    updates = Updates(unit, lags=True, strong=False)
    for residual in residuals:
        updates.led_to(residual * unit, 0.0)
    assert (updates.mixing is not None) is mixed
    assert not updates.given_up


def test_where_nothing_lags_nothing_is_mixed_and_five_are_enough() -> None:
    updates = begun(lags=False)
    for _ in range(5):
        assert not updates.given_up
        updates.led_to(0.9, 0.9)
    assert updates.mixing is None
    assert updates.given_up


def test_mixed_ones_begin_anew_after_ten_and_are_given_up_after_thirty() -> None:
    updates = begun(strong=True)
    mixings = []
    for _ in range(30):
        assert not updates.given_up
        mixings.append(updates.mixing)
        updates.led_to(0.9, 0.9)
    assert updates.given_up
    assert [len({id(m) for m in mixings[i : i + 10]}) for i in (0, 10, 20)] == [1, 1, 1]
    assert len({id(m) for m in mixings}) == 3


def test_progress_renews_patience() -> None:
    updates = begun(strong=True)
    mixing = updates.mixing
    for k in range(1, 60):
        updates.led_to(0.9 if k % 9 else 0.4**k, 0.0)
    assert not updates.given_up
    assert updates.mixing is mixing
