"""Estimates from a sequence of grids, on numbers made up to have a known limit."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy import optimize, stats

import refimpl as rf
from refimpl import discretisation
from refimpl.discretisation import (
    AREA,
    EDGE_SHARE,
    EDGE_SIZE,
    EDGE_SIZE_SPREAD,
    _weights,
    area_scatter,
    estimates,
    thinness,
)
from refimpl.estimate import Bias, Estimate, Prior, line
from refimpl.grid import Array
from refimpl.grid_result import GridResult
from refimpl.refine import OPENING, relative_bar, uncertainty
from refimpl.solution import REPORTED
from refimpl.validity import Limit
from tests.refimpl.made_up import AREA_LIMIT, BETA, PEAK, SIDE, SLIP, made_up, told

HERTZ_GRIDS = (80, 96, 112, 128, 160, 192, 224, 256, 320, 384, 448, 512)


def test_numbers_that_follow_the_model_are_extrapolated() -> None:
    found = estimates([made_up(M) for M in (32, 64, 128)])
    for name in ("contact_area", "contact_area_corrected"):
        assert found[name].value == pytest.approx(AREA_LIMIT, rel=1e-3)
        assert abs(found[name].value - AREA_LIMIT) < found[name].spread
    mu = found["friction_coefficient"]
    assert mu.value == pytest.approx(BETA + SLIP * AREA_LIMIT, rel=1e-3)
    assert abs(mu.value - BETA - SLIP * AREA_LIMIT) < mu.spread
    peak = found["max_pressure"]
    assert peak.value == pytest.approx(PEAK, rel=1e-6)
    assert abs(peak.value - PEAK) < peak.spread < 0.02 * PEAK


def test_a_bar_reaches_from_the_number_over_the_estimate() -> None:
    results = [made_up(M) for M in (32, 64)]
    area = estimates(results)["contact_area"]
    raw = results[-1].numbers["contact_area"]
    bar = uncertainty(results)["contact_area"]["discretisation"]
    assert raw - area.value + 0.83 * area.spread < bar < raw - area.value + 0.9 * area.spread
    assert relative_bar(results, "contact_area") == pytest.approx(bar / raw)


@pytest.mark.parametrize("distance", [0.0, 0.3, 1.0, 1.52, 1.54, 4.0])
def test_a_bar_is_exceeded_by_5_percent_of_a_normal_distribution(distance: float) -> None:
    """On both sides of 3 deviations, 1.53 spreads, where one side is all that counts."""
    bar = Estimate(2.0, 0.5).bar(2.0 + 0.5 * distance) / 0.5 * stats.norm.ppf(0.975)
    shift = distance * stats.norm.ppf(0.975)
    assert stats.norm.sf(bar - shift) + stats.norm.sf(bar + shift) == pytest.approx(0.05, rel=1e-6)


def test_finer_grids_are_foretold_a_nearer_number_and_a_shorter_spread() -> None:
    """By the first and the second of its orders, each in its own way."""
    still = Estimate(1.0, 0.8, orders=(1.0, 2.0))
    assert still.foretold(1.0, 0.25) == pytest.approx(0.05)
    assert still.foretold(21.0, 0.25) == pytest.approx(Estimate(1.0, 0.05).bar(6.0))


@pytest.mark.parametrize("grids", [1, 2, 3])
def test_a_factor_that_is_known_moves_the_number_and_widens_nothing(grids: int) -> None:
    """Nine nodes at one place are one node, however their tails are summed."""
    for seed in range(20):
        draw = np.random.default_rng(seed)
        values, sizes = 1 + draw.normal(0, 0.1, grids), draw.uniform(0.1, 0.3, grids)
        weights, prior = np.ones(grids), Prior(0.05, 2.0)
        found = line(values, weights, prior, Bias(sizes, 0.7, 0.0))
        alone = line(values - 0.7 * sizes, weights, prior)
        assert found.value == pytest.approx(alone.value, rel=1e-12)
        assert found.spread == pytest.approx(alone.spread, rel=2e-4)  # as closely as bounds are sought


@pytest.mark.parametrize("spread", [0.0, 1e-300, math.inf])
def test_bars_of_extreme_spreads(spread: float) -> None:
    assert Estimate(2.0, spread).bar(3.0) == (math.inf if math.isinf(spread) else 1.0)
    assert Estimate(2.0, spread).bar(2.0) == pytest.approx(spread)


def test_an_edge_of_unforeseen_size_is_learnt_from_the_grids() -> None:
    thick = [made_up(M, size=EDGE_SIZE + 3 * EDGE_SIZE_SPREAD) for M in (32, 64, 128, 256, 512)]
    assumed = thick[-1].numbers["contact_area"] - EDGE_SIZE * thick[-1].edge
    found = estimates(thick)["contact_area"]
    assert abs(found.value - AREA_LIMIT) < abs(assumed - AREA_LIMIT)


def test_slopes_that_change_within_elements_leave_mu_open() -> None:
    """Once found 0.249 +- 0.009 of a measured surface, and 0.07 on grids that resolve it."""
    found = [told(mu, M, 0.02) for mu, M in ((0.09, 32), (0.12, 64), (0.25, 512))]
    mu = estimates(found)["friction_coefficient"]
    assert mu.bar(0.25) > 0.15
    alone = estimates(found[-1:])["friction_coefficient"]
    assert alone.spread > 12.7 * 0.02  # Student's t with one degree of freedom
    settling = [told(0.1 + u, M, u) for u, M in ((0.08, 32), (0.02, 64), (0.0003, 512))]
    assert estimates(settling)["friction_coefficient"].bar(0.1003) < 2e-3


def test_what_slopes_leave_open_of_mu_they_leave_open_of_forces() -> None:
    """Per newton of the load, along and across the sliding."""
    for name in ("friction_force", "binormal_force"):
        grids = [made_up(64, unevenness=u) for u in (0.0, 0.02)]
        even, uneven = (
            estimates([replace(grid, numbers={**grid.numbers, name: 1e-3})])[name].spread for grid in grids
        )
        assert uneven > 12.7 * 0.02 * 70.0 > 10 * even


def test_no_grid_counts_for_more_than_a_finer_one() -> None:
    spacing = np.array([16.0, 8.0, 4.0, 2.0])
    assert _weights(np.array([1.0, 6.0, 3.0, 2.0]), spacing).tolist() == [3.0, 3.0, 1.5, 1.0]
    assert _weights(np.array([1.0, 1.0, 1.0, 0.0]), spacing) == pytest.approx((spacing / 2) ** 1.5)


def test_single_elements_leave_an_area_open_down_to_nothing() -> None:
    area = 12 * (SIDE / 64) ** 2
    numbers = {**made_up(64).numbers, "contact_area": area}
    single = replace(made_up(64), edge=4 * EDGE_SHARE * area, numbers=numbers)
    assert area < estimates([single])["contact_area"].bar(area) < 1.3 * area
    many = replace(single, numbers={**numbers, "contact_area": 1e4 * area}, edge=4e4 * EDGE_SHARE * area)
    assert 1e4 * area < estimates([many])["contact_area"].bar(1e4 * area) < 1.3e4 * area
    assert estimates([many])["contact_area"].spread == pytest.approx(0.4e4 * area, rel=0.02)


def test_what_is_known_of_spots_of_few_elements() -> None:
    """Half as much edge as single elements have: of a count's scatter 16/9, of the edge 3/8 more."""
    result = made_up(64)
    area = result.numbers["contact_area"]
    few, many = (
        replace(result, edge=share * 4 * EDGE_SHARE * area, unevenness=0.01) for share in (0.5, 0.01)
    )
    counted = [math.sqrt(r.edge / EDGE_SHARE) * r.spacing for r in (few, many)]
    assert area_scatter([few, many]) == pytest.approx([counted[0] * 16 / 9, counted[1]], rel=1e-3)
    off = EDGE_SIZE * few.edge * (1 + discretisation.SINGLES / 4)
    assert estimates([few])["contact_area"].value == pytest.approx(area - off)
    assert discretisation.unevenness([few, many]) == pytest.approx([0.01 * 16 / 9, 0.01], rel=1e-3)
    single = replace(few, edge=4 * EDGE_SHARE * area)
    mu = many.numbers["friction_coefficient"]
    small = replace(few, numbers={**few.numbers, "friction_coefficient": 9.0})
    assert discretisation.unevenness([small, single, many]) == pytest.approx(
        [0.01 * 16 / 9, mu, 0.01], rel=1e-3
    )


def test_the_finest_grids_slip_turns_area_into_friction() -> None:
    coarse, fine = made_up(32), made_up(128)
    mu = BETA + 3 * SLIP * coarse.numbers["contact_area"]
    coarse = replace(coarse, slip=3 * SLIP, numbers={**coarse.numbers, "friction_coefficient": mu})
    found = estimates([coarse, fine])
    assert found["friction_coefficient"].value == pytest.approx(BETA + SLIP * found["contact_area"].value)
    assert found["friction_coefficient"].spread == pytest.approx(SLIP * found["contact_area"].spread, rel=0.3)


def test_a_coarse_grids_area_hardly_counts_beside_a_fine_ones() -> None:
    grids = [made_up(M) for M in (32, 64, 256)]
    area = grids[0].numbers["contact_area"]
    moved = replace(grids[0], numbers={**grids[0].numbers, "contact_area": 1.001 * area})
    one, other = (estimates(results)["contact_area"].value for results in (grids, [moved, *grids[1:]]))
    assert abs(other - one) < 0.02 * 1e-3 * area


def test_a_grid_without_contact_knows_nothing_beside_one_that_has() -> None:
    numbers = dict.fromkeys(REPORTED, 0.0) | {"normal_force": 70.0}
    apart, found = replace(made_up(32), numbers=numbers, edge=0.0), made_up(64)
    assert thinness([apart, found]).tolist() == [1.0, (found.edge / found.numbers["contact_area"]) ** 1.5]
    assert thinness([replace(found, edge=2 * found.numbers["contact_area"])]) == [1.0]
    assert thinness([replace(found, edge=-0.5 * found.numbers["contact_area"])]) == [0.0]  # of holes
    assert discretisation.discretisation([found, apart]) == {}
    assert set(discretisation.discretisation([apart, found])) == set(REPORTED) - {"normal_force"}


@pytest.mark.parametrize("number", [1e101, -1e101, math.inf, math.nan])
def test_a_state_that_ran_off_has_no_discretisation(number: float) -> None:
    ran_off = replace(made_up(64), numbers={**made_up(64).numbers, "friction_force": number})
    assert discretisation.discretisation([ran_off]) == {}


def test_what_an_edge_leaves_open_of_forces_goes_with_the_load() -> None:
    grids = [
        replace(
            made_up(64), numbers={**made_up(64).numbers, "normal_force": load, "binormal_force": load / 1e3}
        )
        for load in (70.0, 140.0)
    ]
    one, twice = (estimates([grid])["binormal_force"].spread for grid in grids)
    assert twice == pytest.approx(2 * one)
    thin = (grids[0].edge / grids[0].numbers["contact_area"]) ** 1.5
    assert one == pytest.approx(
        12.706 * discretisation.BINORMAL.scatter * thin * 70.0, rel=1e-3
    )  # Student's t


def test_what_an_edge_leaves_open_of_forces_goes_with_the_finest_grids_load() -> None:
    def spread(*loads: float) -> float:
        results = [made_up(M, unevenness=0.01) for M in (32, 64)]
        forces = [{"normal_force": load, "binormal_force": 5.0} for load in loads]
        several = zip(results, forces, strict=True)
        return estimates([replace(r, numbers={**r.numbers, **f}) for r, f in several])[
            "binormal_force"
        ].spread

    assert spread(700.0, 70.0) == pytest.approx(spread(70.0, 70.0))
    assert spread(70.0, 700.0) > 5 * spread(70.0, 70.0)


def test_single_elements_leave_mu_open_too() -> None:
    """Once 0.3 +- 0.03 of a surface of noise, whose finer grids found 0.1."""
    area = 12 * (SIDE / 64) ** 2
    results = [
        replace(
            told(mu, M, 0.03), edge=share * area, numbers={**told(mu, M, 0.03).numbers, "contact_area": area}
        )
        for mu, M in ((0.29, 32), (0.3, 64), (0.3, 128))
        for share in (4 * EDGE_SHARE,)
    ]
    assert 0.3 < estimates(results)["friction_coefficient"].bar(0.3) < 0.9
    spread_out = [replace(result, edge=result.edge / 10) for result in results]
    assert estimates(spread_out)["friction_coefficient"].bar(0.3) < 0.06


@pytest.mark.filterwarnings("ignore::refimpl.surfaces.base.SurfaceWarning")
@pytest.mark.parametrize("seed", range(4))
def test_bars_on_heights_that_differ_from_point_to_point(seed: int) -> None:
    """No grid resolves these. Of 160 solves of 32 such surfaces, 128 to 512 a side, all bars held, the peak's
    and the approach's in 90 for having no end. With grids of 32 and 64 before, which the bars take for
    surfaces that settle, A's, f_max's and the approach's hold in all, mu's in 155 and Q's in 154.
    """
    noise = np.random.default_rng(seed).normal(scale=60e-9, size=(128, 128))
    scene = rf.Scene(
        upper=rf.Body(rf.Material(E=200e9, nu=0.3), rf.Sphere(radius=0.01)),
        lower=rf.Body(rf.Material(E=118e9, nu=0.3), noise),
        friction=rf.Friction(tau=15e6, beta=0.08),
        load=0.05,
        side=50e-6,
    )
    fine = rf.solve(scene, 768, tolerance=1e-5)
    for M in (128, 192, 256, 512):
        found = rf.solve(scene, M, tolerance=1e-5)
        bars = {name: sum(found.uncertainty[name].values()) for name in REPORTED}
        for name, bar in bars.items():
            assert abs(getattr(found, name) - getattr(fine, name)) <= bar, (M, name)
        for name in ("friction_coefficient", "binormal_force", "contact_area"):
            assert math.isfinite(bars[name])
        wide = bars["max_pressure"] > found.max_pressure and bars["approach"] > found.approach
        assert wide, M
        assert Limit.RADIUS in {warning.limit for warning in found.warnings}


def draws(count: int, grids: int) -> tuple[Array, Array, Array]:
    """Numbers from the model itself with q = 0, their weights and edges, in the unit of the scatter."""
    rng = np.random.default_rng(7)
    weights = 2.0 ** (1.5 * np.arange(grids)[::-1])
    edge = 5 * 2.0 ** np.arange(grids)[::-1]
    size = rng.normal(EDGE_SIZE, EDGE_SIZE_SPREAD, count)
    sigma = AREA.scatter * np.sqrt(AREA.weight / rng.chisquare(AREA.weight, count))
    noise = rng.standard_normal((count, grids)) * weights * sigma[:, None]
    return size[:, None] * edge + noise, weights, edge


@pytest.mark.parametrize("grids", [1, 2, 4])
def test_bounds_hold_for_95_in_100_draws_from_the_model(grids: int) -> None:
    values, weights, edge = draws(800, grids)
    bias = Bias(edge, EDGE_SIZE, EDGE_SIZE_SPREAD)
    found = [line(row, weights, AREA, bias) for row in values]
    share = np.mean([abs(estimate.value) <= estimate.spread for estimate in found])
    assert abs(share - 0.95) < 0.03  # 3.9 standard errors of 800 draws


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
        bias = Bias(sizes, EDGE_SIZE, EDGE_SIZE_SPREAD)
        values = 1 + sizes * draw.normal(EDGE_SIZE, EDGE_SIZE_SPREAD) + scatter
        found, (value, bound) = line(values, weights, prior, bias), integrated(values, weights, prior, bias)
        off.append((abs(found.value - value) / bound, abs(found.spread / bound - 1)))
    assert np.all(np.quantile(off, 0.9, axis=0) < (5e-5, 0.02))
    assert np.max(off) < 0.15


def test_zeros_are_exact() -> None:
    assert line(np.zeros(3), np.ones(3), Prior(0.1, 2.0)) == Estimate(0.0, 0.0)


def test_a_wider_scatter_widens_the_spread_and_a_single_grid_has_its_prior() -> None:
    calm, wild = np.array([1.0, 1.0, 1.0]), np.array([1.3, 0.9, 1.0])
    weights, prior = np.array([8.0, 2.8, 1.0]), Prior(0.01, 2.0)
    assert line(wild, weights, prior).spread > 2 * line(calm, weights, prior).spread
    alone = line(np.array([3.0]), np.ones(1), prior)
    assert alone.value == 3.0
    assert alone.spread == pytest.approx(4.303 * 0.01, rel=1e-3)  # Student's t with two degrees of freedom


def test_bars_hold_against_hertz() -> None:
    """Of twelve areas one is outside its 95 % bar, by 1 %: at 160, whose edge catches most elements."""
    scene = rf.read_scene("hertz")
    a = (3 * scene.load * 0.14 / (4 * scene.materials.reduced_modulus)) ** (1 / 3)
    area, peak = math.pi * a**2, 1.5 * scene.load / (math.pi * a**2)
    found = {M: GridResult.of(rf.solve(scene, M)) for M in (*OPENING, *HERTZ_GRIDS)}
    shares = []
    for M in HERTZ_GRIDS:
        results = [found[N] for N in (*OPENING, M)]
        bars, numbers = uncertainty(results), results[-1].numbers
        shares.append(abs(numbers["contact_area"] - area) / sum(bars["contact_area"].values()))
        assert abs(numbers["max_pressure"] - peak) <= sum(bars["max_pressure"].values())
    assert sum(share > 1 for share in shares) <= 2
    assert max(shares) < 1.1
    assert np.median(shares) > 0.5  # no longer than need be


def test_constants_agree_with_the_perimeter_correction() -> None:
    contact = np.zeros((8, 8), dtype=bool)
    contact[2:5, 3:6] = True  # 12 edges
    corrected = rf.forces.perimeter_corrected_area(contact, 1.0)  # type: ignore[attr-defined]  # submodule
    assert 9 - corrected == pytest.approx(12 * discretisation.EDGE_SHARE)
