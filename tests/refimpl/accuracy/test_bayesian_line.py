"""Limits of numbers that fall in line with bars of their spread, and the digits that a bar leaves."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy import optimize, stats

from refimpl.accuracy.bayesian_line import Bias, Intercept, Prior, fit_line
from refimpl.accuracy.digits import bar_of, digits_of, usable, verdict
from refimpl.accuracy.discretisation_error import AREA
from refimpl.grid import Array


@pytest.mark.parametrize("distance", [0.0, 0.3, 1.0, 1.52, 1.54, 4.0])
def test_a_bar_is_exceeded_by_5_percent_of_a_normal_distribution(distance: float) -> None:
    """On both sides of 3 deviations, 1.53 spreads, where one side is all that counts."""
    bar = Intercept(2.0, 0.5).error_bound(2.0 + 0.5 * distance) / 0.5 * stats.norm.ppf(0.975)
    shift = distance * stats.norm.ppf(0.975)
    assert stats.norm.sf(bar - shift) + stats.norm.sf(bar + shift) == pytest.approx(0.05, rel=1e-6)


@pytest.mark.parametrize("grids", [1, 2, 3])
def test_a_factor_that_is_known_moves_the_number_and_widens_nothing(grids: int) -> None:
    """Nine nodes at one place are one node, however their tails are summed."""
    for seed in range(20):
        draw = np.random.default_rng(seed)
        values, sizes = 1 + draw.normal(0, 0.1, grids), draw.uniform(0.1, 0.3, grids)
        weights, prior = np.ones(grids), Prior(0.05, 2.0)
        found = fit_line(values, weights, prior, Bias(sizes, 0.7, 0.0))
        alone = fit_line(values - 0.7 * sizes, weights, prior)
        assert found.value == pytest.approx(alone.value, rel=1e-12)
        assert found.half_width == pytest.approx(alone.half_width, rel=2e-4)  # as bounds are sought


@pytest.mark.parametrize("spread", [0.0, 1e-300, math.inf])
def test_bars_of_extreme_spreads(spread: float) -> None:
    assert Intercept(2.0, spread).error_bound(3.0) == (math.inf if math.isinf(spread) else 1.0)
    assert Intercept(2.0, spread).error_bound(2.0) == pytest.approx(spread)


def integrated(values: Array, weights: Array, prior: Prior, bias: Bias) -> tuple[float, float]:
    """Value and 95 % bound of the model, its factor integrated over 1001 points instead of nine nodes."""
    factor = bias.mean + bias.spread * np.linspace(-6, 6, 1001)
    precision = weights**-2.0
    rest = values - factor[:, None] * bias.sizes
    centre = rest @ precision / precision.sum()
    freedom = prior.weight + len(values) - 1
    squares = (rest - centre[:, None]) ** 2 @ precision
    variance = (prior.weight * prior.scatter**2 + squares) / freedom
    share = stats.norm.pdf(factor, bias.mean, bias.spread) * variance ** (-0.5 * freedom)
    share /= share.sum()
    value, scale = float(share @ centre), np.sqrt(variance / precision.sum())

    def outside(bound: float) -> float:
        either = (bound - (centre - value), bound + (centre - value))
        return sum(float(share @ stats.t.sf(side / scale, freedom)) for side in either)

    widest = 100 * float(scale.max() + np.abs(centre - value).max())
    return value, float(optimize.brentq(lambda bound: outside(bound) - 0.05, 0.0, widest))


def test_nine_nodes_do_for_the_factors_integral() -> None:
    """Of 100 ladders nine in ten have bounds within 1.5 % of the integral's, and all within 12 %."""
    off = []
    for seed in range(100):
        draw = np.random.default_rng(seed)
        spacing = np.sort(draw.uniform(0.2, 1.0, draw.integers(1, 5)))[::-1]
        weights, sizes = (spacing / spacing[-1]) ** 1.5, spacing * draw.uniform(0.02, 0.3)
        prior = AREA._replace(scatter=0.2 * draw.uniform(0.01, 0.05))
        scatter = prior.scatter * weights * draw.standard_normal(len(spacing))
        bias = Bias(sizes, 0.72, 0.03)
        values = 1 + sizes * draw.normal(0.72, 0.03) + scatter
        found = fit_line(values, weights, prior, bias)
        value, bound = integrated(values, weights, prior, bias)
        off.append((abs(found.value - value) / bound, abs(found.half_width / bound - 1)))
    assert np.all(np.quantile(off, 0.9, axis=0) < (5e-5, 0.02))
    assert np.max(off) < 0.15


@pytest.mark.parametrize("power", [-80, -30, 40])
def test_bounds_know_no_unit(power: int) -> None:
    """Areas of a nanometre's scene in m^2 are far below what a root is sought to, if it has a unit."""
    unit = 2.0**power
    values, weights, edge = np.array([1.2, 1.07, 1.03]), np.array([8.0, 2.8, 1.0]), np.array([0.4, 0.2, 0.1])
    one = fit_line(values, weights, Prior(0.01, 6.0), Bias(edge, 0.78, 0.07))
    other = fit_line(unit * values, weights, Prior(unit * 0.01, 6.0), Bias(unit * edge, 0.78, 0.07))
    assert other == (unit * one.value, unit * one.half_width, one.orders)


def test_a_wider_scatter_widens_the_spread_and_a_single_grid_has_its_prior() -> None:
    calm, wild = np.array([1.0, 1.0, 1.0]), np.array([1.3, 0.9, 1.0])
    weights, prior = np.array([8.0, 2.8, 1.0]), Prior(0.01, 2.0)
    assert fit_line(wild, weights, prior).half_width > 2 * fit_line(calm, weights, prior).half_width
    alone = fit_line(np.array([3.0]), np.ones(1), prior)
    assert alone.value == 3.0
    assert alone.half_width == pytest.approx(4.303 * 0.01, rel=1e-3)  # Student's t, two degrees of freedom


@pytest.mark.parametrize(
    ("value", "error", "printed", "bar"),
    [
        (0.112913, 0.2, "0.11", "+- 0.2"),  # the three numbers once printed with six digits
        (222802.0, 3e7, "220000", "+- 3e+07"),
        (5.84, 3.0, "6", "+- 3"),
        (0.0992525, 0.00104, "0.0993", "+- 0.0010"),
        (0.9996, 0.02, "1.00", "+- 0.02"),
        (1.61e-7, 3e-9, "1.61e-07", "+- 3e-09"),
        (-0.5567, 0.01, "-0.557", "+- 0.010"),
        (0.0, 0.003, "0", "+- 0.003"),
        (1234567.0, 0.0, "1.23457e+06", ""),
    ],
)
def test_a_number_has_the_digits_that_its_bar_leaves(
    value: float, error: float, printed: str, bar: str
) -> None:
    assert (digits_of(value, error), bar_of(error)) == (printed, bar)


@pytest.mark.parametrize(("error", "named"), [(0.0, ""), (0.5, ""), (0.51, "(not usable)")])
def test_half_of_the_value_is_the_largest_usable_bar(error: float, named: str) -> None:
    assert verdict(error, -1.0) == named
    assert usable(error, 1.0) is not bool(named)
