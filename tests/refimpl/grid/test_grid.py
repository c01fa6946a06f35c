"""Sums over a grid's fields."""

from __future__ import annotations

import numpy as np

from refimpl.grid import inner


def test_short_products_are_blas_and_long_ones_go_row_by_row() -> None:
    """To the last bit: what BLAS does with a long one is up to its threads.

    Of one product alone both ways may round alike: which do is up to the processor.
    """
    draw = np.random.default_rng(2)
    for n, one in ((100, True), (150, False)):
        fields = draw.standard_normal((20, 2, n, n))
        whole = [float(np.vdot(a, b)) for a, b in fields]
        by_row = [float(np.vecdot(a, b).sum()) for a, b in fields]
        assert whole != by_row
        assert [inner(a, b) for a, b in fields] == (whole if one else by_row)
