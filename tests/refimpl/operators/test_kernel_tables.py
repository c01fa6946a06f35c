"""Tables of the influence integrals: values at any offset, growth, and how many are kept."""

from __future__ import annotations

import numpy as np
import pytest

from refimpl.kernels import normal_integral, normal_table, tangential_integral, tangential_table
from refimpl.operators.kernel_tables import signed_table, unit_table

INTEGRALS = {"normal": normal_integral, "tangential": tangential_integral}
ACCURACY = 1e-13
"""Relative, of either value: what `refimpl.kernels` promises."""

of_kinds = pytest.mark.parametrize("kind", INTEGRALS)


@of_kinds
@pytest.mark.parametrize("aspect", [1.0, 0.1, 1.7])
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
def test_smaller_tables_are_views_that_cannot_be_written(kind: str) -> None:
    large = unit_table(kind, (40, 50), 0.61)
    small = unit_table(kind, (20, 40), 0.61)
    assert np.shares_memory(small, large)
    assert not small.flags.writeable
    with pytest.raises(ValueError, match="read-only"):
        large[0, 0] = 1.0
