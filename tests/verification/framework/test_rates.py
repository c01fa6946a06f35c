"""Orders of manufactured series whose answer is known."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from verification.framework.rates import fit_order


@given(order=st.floats(0.5, 6.0), constant=st.floats(1e-6, 1e6), ratio=st.floats(1.2, 4.0))
def test_a_pure_power_gives_its_order_back(order: float, constant: float, ratio: float) -> None:
    h = [ratio**-k for k in range(4)]
    found = fit_order(h, [constant * s**order for s in h])
    # Rounding in log(error) is a few ulp of |log(error)| <= 50, over a fit that spans log(1.2**3) = 0.55.
    assert found.order == pytest.approx(order, abs=1e-12)
    assert found.constant == pytest.approx(constant, rel=1e-11)
    assert found.local == pytest.approx([order] * 3, abs=1e-12)


def test_the_order_is_the_least_squares_one() -> None:
    # Hand-made: log2 errors 0, 1, 1 at log2 spacings 0, 1, 2 have slope 1/2 and intercept 1/6.
    found = fit_order([4.0, 2.0, 1.0], [2.0, 2.0, 1.0])
    assert found.order == pytest.approx(0.5, abs=1e-14)
    assert found.constant == pytest.approx(2 ** (1 / 6), rel=1e-14)
    assert found.local == pytest.approx([0.0, 1.0], abs=1e-14)


@pytest.mark.parametrize(
    ("spacing", "errors"),
    [
        ([0.2, 0.1], [1.0, 2.0]),
        ([0.1, 0.2, 0.4], [1.0, 2.0, 3.0]),
        ([0.4, 0.2, 0.0], [1.0, 2.0, 3.0]),
        ([0.4, 0.2, 0.1], [1.0, np.nan, 3.0]),
        ([0.4, 0.2, 0.1], [1.0, 0.5, 0.0]),
    ],
)
def test_bad_series_are_refused(spacing: list[float], errors: list[float]) -> None:
    with pytest.raises(ValueError):
        fit_order(spacing, errors)
