"""How far the numbers found on grids are from the continuous problem's: the discretisation's error bars.

Each number is the intercept q of a line over the grids (`refimpl.accuracy.bayesian_line`), ``y_k = q + c e_k
+ r_k``. In an area ``e_k`` is what whole elements add along the contact's edge (Yastrebov, Anciaux and
Molinari 2017), and ``r_k`` which elements the edge happens to catch: the count of n edge elements varies as
sqrt(n), and n goes as 1 / h, so ``w`` falls as h^(3/2). Friction takes its edge's share from the area, by
``tau / N``. The highest pressure is that of a parabola through the peak, and ``e_k`` its drop to the
neighbours (`refimpl.accuracy.peak`); approaches count from first touch, a summit as well
(`refimpl.accuracy.first_contact`). Where bodies differ, tau on whole elements pulls at more than the contact,
which falls as h only (`PULLED`). Every other number's ``w`` is told by the grids themselves: by how much of
the contact is edge, by how slopes bend from element to element. These fall as powers of h where a surface is
resolved; where it is not they do not, and bars stay wide. Where elements that bear half of the highest
pressure stand alone nothing bounds what finer grids find there, and where spots are single elements nothing
but the number itself bounds area and friction.

The priors were fitted to random scenes of a training set (`verification.coverage`: seeds 1000 to 1199; by
likelihood in `verification.coverage.priors`); what they promise was judged on the scenes of other seeds. How
bars open where nothing is resolved was chosen on surfaces of noise and on measured ones as well
(`test_accuracy_estimates.py`).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np

from refimpl.accuracy.bayesian_line import DECAY, Bias, Estimate, Prior, line
from refimpl.accuracy.first_contact import POWERS, first_touch, missed, missed_share, touched
from refimpl.accuracy.grid_features import GridResult
from refimpl.grid import Array
from refimpl.model.forces import EDGE_SHARE

EDGE_SIZE, EDGE_SIZE_SPREAD = 0.78, 0.07  # c0, s_c
SINGLES = 1.5  # what a lone element's edge counts more than an edge
SUMMIT, SUMMIT_SPREAD = 0.028, 0.009  # c0, s_c: of its drop, as a pressure's parabola peaks too high
_RAN_OFF = 1e100  # of any number in SI units: squares still fit a double
_ROUNDING = 1e-6  # instead of zero
_SLOPES, _AREAS = 2, 8  # powers of what spots that are not single elements let grids know of either
_UNKNOWN = 0.15  # of an area, at most, as sigma: with its edge's share a bar then reaches down to none

AREA = Prior(0.18, 6.0)  # unit: element area times the root of number and `alike` of the edge elements
BULK = Prior(0.003, 1.0)  # friction without tau's share; unit of this and the last: value (edge / area)^1.5
PEAK = Prior(0.008, 2.5)  # unit: the summit's drop
BINORMAL = Prior(0.0002, 1.0)  # unit: normal force, else as the next
OTHER = Prior(0.02, 2.0)  # unit: as of friction
PULLED = {"approach": 0.6, "normal_force": 1.2, "max_pressure": 0.6}
"""95 % bounds of tau's pull on the edge, over what it does to the depth: of the approach under a load, of the
others at an approach. Set so that a smooth ball under tau of 0.7 of its pressure stays within its bars, and
judged on random scenes (`verification.cases.error_bars.pulled`)."""


class _Grids:
    """What a sequence of grids found, coarse to fine."""

    def __init__(self, results: Sequence[GridResult]) -> None:
        self.results = results
        self.thin, self.spacing = thinness(results), self.each(lambda result: result.spacing)

    def each(self, number: Callable[[GridResult], float]) -> Array:
        """A number of each grid."""
        return np.array([number(result) for result in self.results])

    def found(self, name: str) -> Array:
        """A reported number of each grid."""
        return self.each(lambda result: result.numbers[name])

    def finest(self, name: str) -> float:
        """The finest grid's, without its sign."""
        return abs(self.results[-1].numbers[name])

    def hung(self, unit: float) -> Array:
        """Sizes of a scatter that hangs on the highest peak, less than its pressure does."""
        return np.array([r.peak.widened(t * unit, 0.5) for r, t in zip(self.results, self.thin, strict=True)])

    def smooth(self, values: Array, prior: Prior, *sizes: Array, bias: Bias | None = None) -> Estimate:
        """From ``values`` that scatter by ``prior.scatter`` times the first of ``sizes``, and the others."""
        size = np.hypot.reduce([prior.scatter * sizes[0], *sizes[1:]])
        if math.isinf(size[-1]):
            return Estimate(float(values[-1]), math.inf)
        return line(values, _weights(size, self.spacing), prior._replace(scatter=float(size[-1])), bias)


def estimates(results: Sequence[GridResult]) -> dict[str, Estimate]:
    """Estimates of the reported numbers, from grids coarse to fine (one at least)."""
    grids = _Grids([touched(result) for result in results])
    area, load = _area(grids.results), grids.finest("normal_force")
    slip = grids.each(lambda result: result.slip)
    across = grids.thin * load, unevenness(grids.results) * load
    found = {
        "friction_coefficient": _sheared(grids, "friction_coefficient", area, slip, 1.0),
        "friction_force": _sheared(grids, "friction_force", area, slip * grids.found("normal_force"), load),
        "contact_area": area,
        "contact_area_corrected": area,
        "max_pressure": _peak(grids),
        "binormal_force": grids.smooth(grids.found("binormal_force"), BINORMAL, *across),
    }
    last = grids.results[-1]
    if last.loaded:
        return found | {"approach": _approach(grids).widened(PULLED["approach"] * last.pulled * last.depth)}
    bounds = missed(last)
    widened = {name: estimate.widened(bounds[name]) for name, estimate in found.items()}
    widened["normal_force"] = _force(grids)
    for name in ("normal_force", "max_pressure"):
        widened[name] = widened[name].widened(PULLED[name] * last.pulled * grids.finest(name))
    return widened


def _sheared(grids: _Grids, name: str, area: Estimate, share: Array, unit: float) -> Estimate:
    """A number that contains ``share`` times the contact area, and slopes times ``unit``."""
    values = grids.found(name) - share * grids.found("contact_area")
    rest = grids.smooth(values, BULK, grids.thin * grids.finest(name), unevenness(grids.results) * unit)
    slipping = float(share[-1])
    return Estimate(rest.value + slipping * area.value, rest.spread).widened(slipping * area.spread)


def _peak(grids: _Grids) -> Estimate:
    """The highest pressure: that of the parabola, which peaks too high by a share of its drop.

    Elements of even pressure give way by less than the waves they stand for, ``q^2 h^2 / 24`` of it: of a
    wave that alone would be a 24th of the drop. A periodic scene's operator gives way as waves do.
    """
    drop = grids.each(lambda result: result.peak.drop)
    bias = Bias(drop, 0.0 if grids.results[-1].periodic else SUMMIT, SUMMIT_SPREAD)
    size = grids.each(lambda result: result.peak.widened(result.peak.drop))
    return grids.smooth(grids.each(lambda result: result.peak.height), PEAK, size, bias=bias)._replace(
        orders=(2.0, 2.0)
    )


def _approach(grids: _Grids) -> Estimate:
    """The approach under a load, counted from the surfaces' own first touch."""
    values = grids.found("approach") + grids.each(lambda result: result.touch.height)
    return grids.smooth(values, OTHER, grids.hung(grids.finest("approach")), grids.each(first_touch))


def _force(grids: _Grids) -> Estimate:
    """The force at an approach, which the first touch moves by its power of the approach."""
    load = grids.finest("normal_force")
    size = POWERS["normal_force"] * load * grids.each(missed_share)
    return grids.smooth(grids.found("normal_force"), OTHER, grids.hung(load), size)


def thinness(results: Sequence[GridResult]) -> Array:
    """How much of each grid's contact is edge, to the order at which an area's scatter falls."""
    return np.array([min(1.0, result.edge_share) for result in results]) ** DECAY


def unevenness(results: Sequence[GridResult]) -> Array:
    """How far slopes within elements leave mu open; all of it where spots are single elements."""
    uneven = np.array([result.unevenness for result in results])
    whole = abs(results[-1].numbers["friction_coefficient"])
    wider: Array = np.maximum(uneven, np.minimum(uneven / _known(results, _SLOPES), whole))
    return wider


def _known(results: Sequence[GridResult], power: int) -> Array:
    """How well grids know beside what they say: not at all where all spots are single elements.

    Powers are measures, not laws, of surfaces of noise: bars of slopes missed by a tenth with 1, of corrected
    areas by a sixth with 4.
    """
    known: Array = np.maximum(1 - singleness(results) ** 2, _ROUNDING) ** power
    return known


def singleness(results: Sequence[GridResult]) -> Array:
    """How far spots are single elements: the edge's share of the contact over a lone element's."""
    return np.array([result.edge_share for result in results]) / (4 * EDGE_SHARE)


def _weights(size: Array, spacing: Array) -> Array:
    """``w_k``: each grid's own size of the scatter over the finest's; none counts for more than a finer one.

    So numbers that a surface keeps changing below the elements' size are not thought to settle. Where the
    finest grid knows of no scatter, that of the others is the area's.
    """
    if not size[-1] > 0:
        steps: Array = (spacing / spacing[-1]) ** DECAY
        return steps
    weights: Array = np.maximum.accumulate(size[::-1])[::-1] / size[-1]
    return weights


def discretisation(results: Sequence[GridResult]) -> dict[str, dict[str, float]]:
    """Discretisation parts of the finest numbers: none without contact, no bound where a state ran off."""
    found = results[-1].numbers
    if not results[-1].touching:
        return {}
    if not all(abs(value) < _RAN_OFF for value in found.values()):
        given = "normal_force" if results[-1].loaded else "approach"
        return {name: {"discretisation": math.inf} for name in found if name != given}
    return {
        name: {"discretisation": estimate.bar(found[name])} for name, estimate in estimates(results).items()
    }


def _area(results: Sequence[GridResult]) -> Estimate:
    """Contact area: the edge's mean share is a regressor, its scatter that of a count.

    A lone element's edge counts for more: finer grids find less of it than of an edge. On the training
    scenes once more is likeliest, on surfaces of noise and on measured ones 1.5 to 2 times.
    """
    area, edge = np.transpose([(result.numbers["contact_area"], result.edge) for result in results])
    scatter = area_scatter(results)
    prior = AREA._replace(scatter=AREA.scatter * scatter[-1])
    bias = Bias(edge * (1 + SINGLES * singleness(results) ** 2), EDGE_SIZE, EDGE_SIZE_SPREAD)
    return line(area, scatter / scatter[-1], prior, bias)


def area_scatter(results: Sequence[GridResult]) -> Array:
    """Each grid's unit of the area's scatter (m^2): a count's, and of single elements' spots more.

    Of those no more than what makes the bar reach down to no area.
    """
    edge, area, spacing, alike = np.transpose(
        [(result.edge, result.numbers["contact_area"], result.spacing, result.alike) for result in results]
    )
    elements = np.maximum(edge / (EDGE_SHARE * spacing**2), 1.0)
    counted = np.sqrt(elements * alike) * spacing**2
    scatter: Array = np.maximum(
        counted, np.minimum(counted / _known(results, _AREAS), _UNKNOWN * area / AREA.scatter)
    )
    return scatter
