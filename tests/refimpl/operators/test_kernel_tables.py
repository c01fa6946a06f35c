"""Tables of the influence integrals: values at any offset, growth, and how many are kept."""

from __future__ import annotations

import numpy as np
import pytest

from refimpl.grid import Array
from refimpl.kernels import normal_integral, normal_table, tables, tangential_integral, tangential_table
from refimpl.operators.kernel_tables import signed_table, unit_table

INTEGRALS = {"normal": normal_integral, "tangential": tangential_integral}
ACCURACY = 1e-13
"""Relative, of either value: what `refimpl.kernels` promises."""

of_kinds = pytest.mark.parametrize("kind", INTEGRALS)


@of_kinds
@pytest.mark.parametrize("aspect", [1.0, 0.1, 0.31, 1.7, 10.0])
@pytest.mark.parametrize("shape", [(1, 1), (90, 70), (3, 150), (150, 3)])
def test_values_are_the_integrals_at_random_offsets(kind: str, aspect: float, shape: tuple[int, int]) -> None:
    random = np.random.default_rng(6)
    i, j = (random.integers(0, n, 200) for n in shape)
    found = unit_table(kind, shape, aspect)
    assert found.shape == shape
    exact = INTEGRALS[kind](i.astype(float), aspect * j, 1.0, aspect)
    np.testing.assert_allclose(found[i, j], exact, rtol=2 * ACCURACY)


@of_kinds
@pytest.mark.parametrize("aspect", [1.0, 0.37])
def test_signed_offsets_have_the_kernels_parity(kind: str, aspect: float) -> None:
    rows, columns = np.array([-2, -1, 0, 1, 2, 9]), np.array([0, 1, -3])
    found = signed_table(kind, rows, columns, aspect)
    exact = INTEGRALS[kind](rows[:, None].astype(float), aspect * columns, 1.0, aspect)
    np.testing.assert_allclose(found, exact, rtol=2 * ACCURACY)
    sign = -1 if kind == "tangential" else 1
    assert np.array_equal(found[:2], sign * found[[4, 3]])


@of_kinds
@pytest.mark.parametrize("aspect", [1.0, 0.53, 2.9])
def test_a_table_grows_without_a_change_of_any_bit(kind: str, aspect: float) -> None:
    """Whatever shapes were asked for before, also where one axis grows and the other does not."""
    table = normal_table if kind == "normal" else tangential_table
    for shape in ((5, 5), (9, 40), (30, 30), (12, 90), (70, 60), (2, 3), (200, 9)):
        assert np.array_equal(unit_table(kind, shape, aspect), table(*shape, 1.0, aspect))


@of_kinds
def test_growth_computes_only_what_is_new(kind: str, monkeypatch: pytest.MonkeyPatch) -> None:
    points = 0
    across = tables.across

    def counted(inner: object, outer: Array, other: Array, *rest: object) -> Array:
        nonlocal points
        points += np.broadcast(outer, other).size
        return across(inner, outer, other, *rest)

    monkeypatch.setattr(tables, "across", counted)
    unit_table(kind, (60, 60), 0.57)
    unit_table(kind, (63, 63), 0.57)
    unit_table(kind, (50, 62), 0.57)
    # the closed form serves the nearest; slabs that end within the first table are not computed again
    assert 60**2 - 5**2 < points < 63**2 + 60 * 60


@of_kinds
def test_smaller_tables_are_views_that_cannot_be_written(kind: str) -> None:
    large = unit_table(kind, (40, 50), 0.61)
    small = unit_table(kind, (20, 40), 0.61)
    assert np.shares_memory(small, large)
    assert not small.flags.writeable
    with pytest.raises(ValueError, match="read-only"):
        large[0, 0] = 1.0


@of_kinds
@pytest.mark.parametrize(("shape", "aspect"), [((7, 100), 0.71), ((100, 7), 0.73)])
def test_a_strip_has_a_table_of_its_own_and_no_square_one(
    kind: str, shape: tuple[int, int], aspect: float
) -> None:
    """Up to a ratio of four, windows of all shapes share a square table, most of which a strip wastes."""
    strip = unit_table(kind, shape, aspect)
    assert strip.base.shape == shape
    window, other = unit_table(kind, (10, 40), aspect), unit_table(kind, (40, 11), aspect)
    assert np.shares_memory(window, other)


@of_kinds
def test_tables_used_last_are_kept(kind: str) -> None:
    """Eight of them; each aspect ratio of elements is another table."""
    first, second, *others = (1.5 + k / 64 for k in range(8))
    tables = {aspect: unit_table(kind, (4, 4), aspect) for aspect in (first, second, *others)}
    assert np.shares_memory(tables[first], unit_table(kind, (4, 4), first))  # kept, and now the last used
    unit_table(kind, (4, 4), 9.0)
    assert np.shares_memory(tables[first], unit_table(kind, (4, 4), first))
    assert not np.shares_memory(tables[second], unit_table(kind, (4, 4), second))
