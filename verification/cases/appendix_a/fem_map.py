"""The shipped map of coefficient errors: solved afresh, read between its nodes, and its slopes of 2 %."""

from __future__ import annotations

from importlib.resources import as_file, files

import numpy as np

from appendix_a.fem.coefficient_map import CoefficientMap, interpolation_error
from appendix_a.fem.departure import departure
from appendix_a.fem.geometry import sinusoid_boundary
from appendix_a.fem.map2d import compute
from appendix_a.fem.sinusoid import setup_for
from appendix_a.leading_order import slope_of_error
from appendix_a.strip import first_order
from refimpl import Material
from refimpl.half_space.influence_error import coefficient_error
from verification.cases import Measured, case
from verification.cases.appendix_a.fem import POINTS, POINTS_REASON, percent


def shipped_map() -> CoefficientMap:
    """Return the table that comes with the solver."""
    with as_file(files("refimpl") / "data" / "coefficient_error.json") as path:
        return CoefficientMap.read(path)


RANDOM_POINTS, DRAWN_FROM, SEED = 120, 60, 2001  # the seed was chosen before any point was computed


@case("appendix-fem/map-between-nodes", metric="at_most", tolerance=1.0, tier="full")
def map_between_nodes() -> Measured:
    """The shipped map between its nodes, at 60 random points that its stated error was not drawn from.

    Claim: what is stated of interpolation holds on waves of 8 to 300 half-widths: next elements, and all
    Source: refimpl/data/coefficient_error.json; appendix_a.fem.coefficient_map.interpolation_error
    Tolerance: error over stated error, the largest; the bounds were drawn above 60 other points
    """
    table = shipped_map()
    offsets = np.array(table.offset)
    beside = np.abs(offsets) == 2.0
    rng = np.random.default_rng(SEED)
    errors, stated = [], []
    for _ in range(RANDOM_POINTS):
        slope, wavelength = rng.uniform(1, 30), float(np.exp(rng.uniform(np.log(8), np.log(300))))
        position, nu = rng.uniform(0, 1), rng.uniform(0, 0.4999)
        reach = max(3 * wavelength, 40.0)
        boundary = sinusoid_boundary(slope, wavelength, position, reach)
        fresh = departure(setup_for(wavelength, reach), 1, boundary, offsets).at(nu)
        looked_up = table.departure(slope, wavelength, position, nu)
        error = np.abs(percent(looked_up - fresh, nu, offsets))
        errors.append([round(float(e), 4) for e in (error[beside].max(), error.max())])
        stated.append(interpolation_error(slope))
    ratio = np.array(errors) / np.array(stated)
    return Measured(value=float(ratio[DRAWN_FROM:].max()), data={"error over stated": ratio})


CREST_FLANK_VALLEY = (0.0, 0.25, 0.5)


@case("appendix-fem/two-percent", metric="absolute", tolerance=0.6)
def two_percent() -> Measured:
    """Slope at which the next element's coefficient is 2 % wrong.

    Claim: on a flank, at nu = 0.3, the slope of 2 % is that of the first-order formula: 4.2 degrees
    Source: paper, Appendix A: 'less than 2 %'; appendix_a.leading_order
    Tolerance: second order adds 0.3 tan^2 to 0.52 tan, 4 % at 4 degrees; slopes step by 0.25
    """
    table, slopes = shipped_map(), np.arange(0.25, 30.01, 0.25)
    beside = table.offset.index(2.0)
    percents = (abs(table.percent(float(slope), 64.0, 0.25, 0.3)[beside]) for slope in slopes)
    reached = next((slope for slope, off in zip(slopes, percents, strict=True) if off >= 2.0), np.inf)
    return Measured(value=float(reached), reference=slope_of_error(2.0, 0.3), unit="degrees")


@case("appendix-fem/map", metric="at_most", tolerance=POINTS, tier="full", tolerance_reason=POINTS_REASON)
def whole_map() -> Measured:
    """The plane map on crest, flank and valley, solved afresh.

    Claim: these points are known to 0.02 percentage points, so is every other by the table's own statement;
    the shipped table is this map
    Source: appendix_a.fem.map2d
    """
    fresh, shipped = compute(positions=CREST_FLANK_VALLEY), shipped_map()
    at = [shipped.position.index(position) for position in CREST_FLANK_VALLEY]
    parts = [(fresh.kappa_part, shipped.kappa_part), (fresh.constant_part, shipped.constant_part)]
    # the table has five decimals; other machines round the solves differently
    drift = max(float(np.max(np.abs(new - old[:, :, at]))) for new, old in parts)
    if drift > 1e-5:
        raise ValueError(f"the shipped table differs from the fresh one by {drift:.2g}")
    stated, everywhere = fresh.error_percentage_points, shipped.error_percentage_points
    worst = max(float(stated.max()), float(everywhere.max()))
    data = {"geometries": [stated.size], "drift of the shipped table": [drift]}
    return Measured(value=worst, unit="percentage points", data=data)


@case("appendix-fem/small-slope-error", metric="relative", tolerance=0.005)
def small_slope_error() -> Measured:
    """Coefficient error that a solution states, on a small slope.

    Claim: at 0.1 degrees on a flank the error read from the map is that of first-order theory
    Source: appendix_a.strip.first_order; refimpl.half_space.influence_error
    Tolerance: second order over first: of the slope's size, 0.0017; 0.0010 measured, times five
    """
    slope, wavelength, flank, nu = 0.1, 64.0, 0.25, 0.3
    wavy, flat = first_order(slope, wavelength, flank, nu, offsets=[-2.0, 2.0])
    body = Material(E=200e9, nu=nu)
    stated = coefficient_error(float(np.radians(slope)), body, wavelength=wavelength, position=flank)
    return Measured(stated, float(np.max(np.abs((wavy - flat) / flat))))
