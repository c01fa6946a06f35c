"""Orders and grid uncertainties against manufactured series whose answer is known."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from verification.framework.rates import extrapolate, fit_order

H = [0.4, 0.2, 0.1, 0.05]


@given(order=st.floats(0.5, 6.0), constant=st.floats(1e-6, 1e6), ratio=st.floats(1.2, 4.0))
def test_a_pure_power_gives_its_order_back(order: float, constant: float, ratio: float) -> None:
    h = [ratio**-k for k in range(4)]
    found = fit_order(h, [constant * s**order for s in h])
    # Rounding in log(error) is a few ulp of |log(error)| <= 50, over a fit that spans log(1.2**3) = 0.55.
    assert found.order == pytest.approx(order, abs=1e-12)
    assert found.constant == pytest.approx(constant, rel=1e-11)
    assert found.local == pytest.approx([order] * 3, abs=1e-12)
    assert found.credible(order)
    assert not found.credible(order + 0.6)
    assert not found.credible(order - 0.6)


def test_the_order_is_the_least_squares_one() -> None:
    # Hand-made: log2 errors 0, 1, 1 at log2 spacings 0, 1, 2 have slope 1/2 and intercept 1/6.
    found = fit_order([4.0, 2.0, 1.0], [2.0, 2.0, 1.0])
    assert found.order == pytest.approx(0.5, abs=1e-14)
    assert found.constant == pytest.approx(2 ** (1 / 6), rel=1e-14)
    assert found.local == pytest.approx([0.0, 1.0], abs=1e-14)
    assert found.scatter == pytest.approx(np.log(2) * np.sqrt(1 / 18), rel=1e-13)  # of -1/6, 1/3, -1/6
    assert found.credible(0.5)  # the local ones lie at the very ends
    assert not found.credible(1.0)


@given(
    order=st.floats(0.8, 4.0),
    limit=st.floats(-10, 10),
    factor=st.sampled_from([-3.0, -0.1, 0.1, 3.0]),
    ratio=st.floats(1.5, 3.0),
)
def test_richardson_gives_limit_order_and_uncertainty_back(
    order: float, limit: float, factor: float, ratio: float
) -> None:
    h = [ratio**-k for k in range(4)]
    found = extrapolate(h, [limit + factor * s**order for s in h], expected_order=order)
    correction = abs(factor) * h[-1] ** order
    # Values of size 10 carry 2e-15; the smallest correction is 0.1 * 3**-12 = 2e-7, which leaves 1e-8 of it.
    assert found.credible
    assert found.order == pytest.approx(order, abs=1e-5)
    assert found.extrapolated == pytest.approx(limit, abs=1e-3 * correction)
    assert found.uncertainty == pytest.approx(1.25 * correction, rel=1e-3)
    assert found.safety_factor == 1.25


@pytest.mark.parametrize(
    ("values", "why"),
    [
        ([1.0 + 0.3 * h**0.9 for h in H], "first order where second is expected"),
        ([1.0 + (-1) ** k * 0.1 * h for k, h in enumerate(H)], "oscillates"),
        ([1.1, 1.1, 1.1, 1.1], "constant"),
        (
            [1.0 + 0.01 * h**2 + 0.4 * h**6 * 100 for h in H],
            "coarse grids are outside the asymptotic range",
        ),
        ([1.5, 1.3, 1.2, 0.7], "diverges"),
    ],
)
def test_an_order_that_is_not_credible_costs_a_factor_of_three(values: list[float], why: str) -> None:
    found = extrapolate(H, values, expected_order=2.0)
    assert not found.credible, why
    assert found.safety_factor == 3.0
    assert found.uncertainty >= 3.0 * np.ptp(values)


def test_grids_that_hardly_differ_are_doubted_by_all_of_the_correction() -> None:
    # What three close grids range over says little of how far the limit is.
    h, values = [1.2, 1.1, 1.0], [1.3, 1.1, 1.0]
    factor, _ = np.polyfit(np.square(h), values, 1)
    assert factor * h[-1] ** 2 > 2 * np.ptp(values)
    for scale in (1.0, 0.1):
        found = extrapolate([scale * s for s in h], values, expected_order=2.0)
        assert not found.credible
        assert found.uncertainty == pytest.approx(3.0 * factor, rel=1e-9)


def test_the_misfit_is_part_of_the_uncertainty() -> None:
    noisy = [1.0 + h**2 for h in H]
    noisy[-1] += 3e-4
    found = extrapolate(H, noisy, expected_order=2.0)
    assert found.credible
    assert found.order is not None
    assert found.order > 2.0  # so that the expected order's fit, which is linear, is the one that counts
    slope, limit = np.polyfit(np.square(H), noisy, 1)
    misfit = abs(noisy[-1] - limit - slope * H[-1] ** 2)
    assert misfit > 1e-5
    assert found.uncertainty == pytest.approx(1.25 * slope * H[-1] ** 2 + misfit, rel=1e-9)


def test_one_local_order_off_is_enough_to_doubt() -> None:
    errors = [h**2 for h in H]
    errors[2] *= 1.6
    assert abs(fit_order(H, errors).order - 2.0) < 0.3
    assert not fit_order(H, errors).credible(2.0)
    found = extrapolate(H, [1.0 + e for e in errors], expected_order=2.0)
    assert found.order is not None
    assert abs(found.order - 2.0) < 0.5
    assert not found.credible


@pytest.mark.parametrize("order", [1.0, 2.0])
def test_the_uncertainty_covers_the_true_error(order: float) -> None:
    """Series with a higher-order tail: the limit lies within the stated uncertainty of the finest value."""
    rng = np.random.default_rng(3)
    for tail in rng.uniform(-1, 1, size=100):
        values = [2.0 + 0.5 * h**order + tail * h ** (order + 1) for h in H]
        found = extrapolate(H, values, expected_order=order)
        assert abs(found.finest - 2.0) <= found.uncertainty


@pytest.mark.parametrize(
    ("spacing", "values"),
    [
        ([0.2, 0.1], [1.0, 2.0]),
        ([0.1, 0.2, 0.4], [1.0, 2.0, 3.0]),
        ([0.4, 0.2, 0.2], [1.0, 2.0, 3.0]),
        ([0.4, 0.2, 0.0], [1.0, 2.0, 3.0]),
        ([0.4, 0.2, 0.1], [1.0, np.nan, 3.0]),
        ([0.4, 0.2, 0.1], [1.0, 2.0]),
    ],
)
def test_bad_series_are_refused(spacing: list[float], values: list[float]) -> None:
    with pytest.raises(ValueError):
        fit_order(spacing, values)
    with pytest.raises(ValueError):
        extrapolate(spacing, values, expected_order=2.0)


def test_no_order_is_found_of_zero_nor_expected() -> None:
    with pytest.raises(ValueError, match="logarithm"):
        fit_order([0.4, 0.2, 0.1], [1.0, 0.5, 0.0])
    with pytest.raises(ValueError, match="expected_order"):
        extrapolate([0.4, 0.2, 0.1], [1.0, 0.5, 0.25], expected_order=0.0)
