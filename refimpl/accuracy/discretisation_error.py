"""Discretisation error bars: how far the numbers found on grids are from those of the continuous problem.

Each number is the intercept q of a line over the grids (`bayesian_line`), ``y_k = q + c e_k + r_k``.

- Areas: ``e_k`` is the excess of whole elements along the contact's edge (`contact_edge`), and ``r_k``
  depends on which elements the edge happens to contain: the count of n edge elements varies as sqrt(n), and n
  as 1 / h, so its scatter falls as h^(3/2). Elements of an edge along small whole numbers come in and out
  together (`straight_edges`). Friction takes its edge's share from the area, by ``tau / N``.
- Maximum pressure: that of a parabola through the peak, with its curvature drop for ``e_k`` (`peak`).
  Approaches count from first contact, which is a peak as well (`first_contact`).
- Where the bodies differ, tau on whole elements displaces more than tau on the contact; this falls as h only
  (`SHEAR_BOUNDS`).
- Approaches: by the border of a free domain, where the pressure of a contact that is cut off is singular as
  under a punch (`BORDER_BOUND`, order h), and by the differences that slopes are (`SLOPE_BOUND`, order h^2).
  Under a load the mean gap is the approach but for a constant, so that it scatters with the gap's edge as
  well (`gap_scatter`): nearly full contacts have gaps of few elements. Where pressures do not fall towards
  the edge (`rising_share`), at rims and single elements, it moves as h.
- Every other number scatters as powers of the edge fraction, and as slopes bend from element to element.
  Where waves of pressure or slopes are shorter than elements, bars stay wide. Where elements with half of the
  maximum pressure stand alone, nothing bounds that pressure.

The constants are fitted to random scenes and judged on others (`verification.coverage.fit`).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np

from refimpl.accuracy.bayesian_line import DEFAULT_ORDER, Bias, Intercept, Prior, fit_line
from refimpl.accuracy.constants import constant, table
from refimpl.accuracy.first_contact import (
    HERTZ_EXPONENTS,
    at_first_contact,
    first_contact_bounds,
    first_contact_error,
    first_contact_share,
)
from refimpl.accuracy.grid_features import GridFeatures
from refimpl.accuracy.iteration_error import CORRECTED
from refimpl.accuracy.scatter import (
    area_scatter,
    border_slopes,
    edge_scatter,
    gap_scatter,
    plastic_area,
    rising_share,
    slope_scatter,
    straight_share,
)
from refimpl.grid import Array

_DIVERGED = 1e100  # in SI units; squares are still doubles

_UNMEASURED = constant("unmeasured_elements")
EXCESS_SPREAD = constant("excess_spread")  # standard deviation of all faces' excess together, over it
AREA = Prior(1.0, constant("area_freedom"))  # unit: `area_scatter`
# c0, s_c: the parabola of a pressure peaks too high, over its curvature drop
PEAK_BIAS, PEAK_BIAS_SPREAD = constant("peak_bias"), constant("peak_bias_spread")
# unit: the peak's curvature drop; value times the share of straight edges squared, which move as a whole
PEAK_SCATTER, PEAK_FREEDOM = table("peak_scatter"), constant("peak_freedom")
# units of friction without tau's share, and of Q: each of `rest_sizes`
BULK_SCATTER, BULK_FREEDOM = table("bulk_scatter"), constant("bulk_freedom")
BINORMAL_SCATTER, BINORMAL_FREEDOM = table("binormal_scatter"), constant("binormal_freedom")
APPROACH_SCATTER = table("approach_scatter")  # units: `approach_sizes`
APPROACH_FREEDOM = constant("approach_freedom")
HIDDEN_GAP = constant("hidden_gap_bound")  # 95 %: approach by gaps that no element shows, over `hidden_gap`
FORCE = Prior(constant("force_scatter"), constant("force_freedom"))  # unit: value (edge / area)^1.5
SHEAR_BOUNDS = {
    name: constant(f"shear_bound_{name}") for name in ("approach", "normal_force", "max_pressure")
}
"""95 % bounds of the change by tau on the contact's edge, over its change of the depth: of the approach under
a load, of the others at an approach. Set so that a smooth ball under tau of 0.7 of its pressure stays within
its bars, and judged on random scenes (`verification.cases.error_bars.pulled`)."""


def rest_sizes(results: Sequence[GridFeatures]) -> Array:
    """Return units of the scatter of mu without tau's share, shape (4, grids).

    The edge fraction's 3/2 power times mu; slopes within elements, apart and in phase; at a free border.
    """
    mu = abs(results[-1].numbers["friction_coefficient"])
    slopes = (slope_scatter(results, name) for name in ("slope_sampling_error", "slope_line_error"))
    return np.array([edge_scatter(results) * mu, *slopes, [border_slopes(result) for result in results]])


def approach_sizes(results: Sequence[GridFeatures]) -> Array:
    """Return units of the scatter of an approach under a load (m), shape (6, grids).

    The edge towards which pressures do not fall (order h); waves that the grid misses; the gap's edge; a free
    border (h); differences for slopes (h^2); first contact.
    """
    last = results[-1]
    unit = max(abs(last.numbers["approach"]), last.depth)
    return np.array(
        [
            [unit * min(result.edge_fraction, 1.0) * rising_share(result) for result in results],
            [unit * result.missed_share for result in results],
            [gap_scatter(result) for result in results],
            [result.border_fraction * result.depth for result in results],
            [result.slope_displacement_error for result in results],
            [first_contact_error(result) for result in results],
        ]
    )


class _Grids:
    """The features of a sequence of grids, coarse to fine, as arrays."""

    def __init__(self, results: Sequence[GridFeatures]) -> None:
        self.results = results
        self.edge_scatter = edge_scatter(results)
        self.spacing = self.each(lambda result: result.grid.element_size)

    def each(self, number: Callable[[GridFeatures], float]) -> Array:
        return np.array([number(result) for result in self.results])

    def found(self, name: str) -> Array:
        return self.each(lambda result: result.numbers[name])

    def finest(self, name: str) -> float:
        return abs(self.results[-1].numbers[name])

    @property
    def unmeasured(self) -> bool:
        """True if the finest grid's contact is too few elements for a bar."""
        return self.finest("contact_area") < (_UNMEASURED + 0.5) * self.results[-1].grid.element_area

    def peak_scatter(self, unit: float) -> Array:
        """Return sizes of a scatter that grows with the root of the peak's error factor."""
        return np.array(
            [r.peak.widened(t * unit, 0.5) for r, t in zip(self.results, self.edge_scatter, strict=True)]
        )

    def smooth(
        self, values: Array, freedom: float, scales: Array, sizes: Array, bias: Bias | None = None
    ) -> Intercept:
        """Estimate from values that scatter by the root sum of squares of ``scales`` times ``sizes``."""
        size = np.hypot.reduce(scales[:, None] * sizes)
        if math.isinf(size[-1]):
            return Intercept(float(values[-1]), math.inf)
        return fit_line(values, _weights(size, self.spacing), Prior(float(size[-1]), freedom), bias)


def estimates(results: Sequence[GridFeatures]) -> dict[str, Intercept]:
    """Return estimates of the reported numbers from grids coarse to fine; the hardness as p_max is exact."""
    found, last = _estimates(results), results[-1]
    if last.yields:
        found["max_pressure"] = Intercept(last.numbers["max_pressure"], 0.0)
    else:
        area = _area_that_may_yield(last, found["max_pressure"])
        is_open = area > 0 and math.isinf(found["contact_area"].half_width)
        found["plastic_area"] = Intercept(0.0, math.inf if is_open else area)
    return found


def _area_that_may_yield(fine: GridFeatures, peak: Intercept) -> float:
    """Return the area (m^2) of elements whose pressure is within the maximum's error of the hardness."""
    if fine.hardness is None:
        return 0.0
    top = fine.numbers["max_pressure"]
    error = peak.error_bound(top)
    if top + error < fine.hardness:
        return 0.0
    level = max(0.0, (fine.hardness - error) / top)
    return fine.highest_areas[int(level * (len(fine.highest_areas) - 1))]


def _estimates(results: Sequence[GridFeatures]) -> dict[str, Intercept]:
    grids = _Grids([at_first_contact(result) for result in results])
    area, load = _area(grids), grids.finest("normal_force")
    dmu_dA = grids.each(lambda result: result.dmu_dA)
    across = load * rest_sizes(grids.results)
    across[0] = load * grids.edge_scatter * grids.each(lambda result: result.rms_slope > 0)  # else Q is zero
    found = {
        "friction_coefficient": _sheared(grids, "friction_coefficient", area, dmu_dA, 1.0),
        "friction_force": _sheared(grids, "friction_force", area, dmu_dA * grids.found("normal_force"), load),
        "contact_area": area,
        "contact_area_corrected": area,
        "plastic_area": plastic_area(grids.results[-1]),
        "max_pressure": _peak(grids),
        "binormal_force": grids.smooth(
            grids.found("binormal_force"), BINORMAL_FREEDOM, BINORMAL_SCATTER, across
        ),
    }
    found |= {name: found[raw] for name, raw in CORRECTED.items()}
    last = grids.results[-1]
    if last.loaded:
        by_shear = SHEAR_BOUNDS["approach"] * last.shear_by_edge * last.depth
        by_gaps = HIDDEN_GAP * last.hidden_gap
        return found | {"approach": _approach(grids).widened(math.hypot(by_shear, by_gaps))}
    bounds = first_contact_bounds(last)
    widened = {name: estimate.widened(bounds.get(name, 0.0)) for name, estimate in found.items()}
    widened["normal_force"] = _force(grids)
    for name in ("normal_force", "max_pressure"):
        widened[name] = widened[name].widened(SHEAR_BOUNDS[name] * last.shear_by_edge * grids.finest(name))
    return widened


def _sheared(grids: _Grids, name: str, area: Intercept, share: Array, unit: float) -> Intercept:
    """Return a number that contains ``share`` times the contact area, and slopes times ``unit``."""
    values = grids.found(name) - share * grids.found("contact_area")
    rest = grids.smooth(values, BULK_FREEDOM, BULK_SCATTER, unit * rest_sizes(grids.results))
    per_area = float(share[-1])
    return Intercept(rest.value + per_area * area.value, rest.half_width).widened(per_area * area.half_width)


def _peak(grids: _Grids) -> Intercept:
    """Return the maximum pressure: the parabola's, minus its bias, a share of the curvature drop.

    Elements of constant pressure displace less than waves, by ``q^2 h^2 / 24``; band-limited ones do not.
    """
    if not grids.results[-1].peak.smooth:
        return Intercept(grids.finest("max_pressure"), math.inf)
    drop = grids.each(lambda result: result.peak.curvature_drop)
    bias = Bias(drop, 0.0 if grids.results[-1].grid.band_limited else PEAK_BIAS, PEAK_BIAS_SPREAD)
    size = grids.each(lambda result: result.peak.widened(result.peak.curvature_drop))
    heights = grids.each(lambda result: result.peak.height)
    along = heights * grids.each(straight_share) ** 2
    found = grids.smooth(heights, PEAK_FREEDOM, PEAK_SCATTER, np.array([size, along]), bias)
    return found._replace(orders=(2.0, 2.0))


def _approach(grids: _Grids) -> Intercept:
    """Return the approach under a load, from first contact; nothing bounds that of at most four elements."""
    values = grids.found("approach") + grids.each(lambda result: result.first_contact.height)
    found = grids.smooth(values, APPROACH_FREEDOM, APPROACH_SCATTER, approach_sizes(grids.results))
    return found.widened(math.inf) if grids.unmeasured else found


def _force(grids: _Grids) -> Intercept:
    """Return the force at an approach, with the error of first contact by its exponent of the approach."""
    load = grids.finest("normal_force")
    sizes = grids.peak_scatter(load), HERTZ_EXPONENTS["normal_force"] * load * grids.each(first_contact_share)
    scales = np.array([FORCE.scatter, 1.0])
    return grids.smooth(grids.found("normal_force"), FORCE.weight, scales, np.array(sizes))


def _weights(size: Array, spacing: Array) -> Array:
    """Return ``w_k``: each grid's scatter over the finest grid's, and not less than a finer grid's.

    So a number that keeps changing is not taken as converged. Without scatter they are those of an area.
    """
    if not size[-1] > 0:
        steps: Array = (spacing / spacing[-1]) ** DEFAULT_ORDER
        return steps
    weights: Array = np.maximum.accumulate(size[::-1])[::-1] / size[-1]
    return weights


def discretisation(results: Sequence[GridFeatures]) -> dict[str, dict[str, float]]:
    """Return the parts of the finest grid's numbers: none without contact, infinite where it diverged."""
    found = results[-1].numbers
    if not results[-1].touching:
        return {}
    if not all(abs(value) < _DIVERGED for value in found.values()):
        given = "normal_force" if results[-1].loaded else "approach"
        return {name: {"discretisation": math.inf} for name in found if name != given}
    bounds = {name: estimate.error_bound(found[name]) for name, estimate in estimates(results).items()}
    return {name: {"discretisation": bound} for name, bound in bounds.items()}


def _area(grids: _Grids) -> Intercept:
    """Return the contact area: the excess along the edge is a regressor, and the scatter is that of a count.

    In a contact of at most four elements the faces do not locate the edge: the error bar is the whole area.
    """
    bias = Bias(grids.each(lambda result: result.excess), 1.0, EXCESS_SPREAD)
    scatter = grids.each(area_scatter)[None]
    found = grids.smooth(grids.found("contact_area"), AREA.weight, np.ones(1), scatter, bias)
    return found.widened(grids.finest("contact_area")) if grids.unmeasured else found
