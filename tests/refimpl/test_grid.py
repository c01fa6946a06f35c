"""Sums over a grid's fields."""

from __future__ import annotations

import numpy as np

from refimpl.grid import inner


def test_short_products_are_blas_and_long_ones_go_row_by_row() -> None:
    """To the last bit: what BLAS does with a long one is up to its threads."""
    draw = np.random.default_rng(2)
    for n, one in ((100, True), (150, False)):
        a, b = draw.standard_normal((2, n, n))
        whole, by_row = float(np.vdot(a, b)), float(np.vecdot(a, b).sum())
        assert whole != by_row
        assert inner(a, b) == (whole if one else by_row)
