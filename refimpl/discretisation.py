"""What a sequence of grids tells of the continuous problem: a Bayesian line through the numbers found.

A number ``y_k`` found on grid k of spacing ``h_k`` is modelled as

    y_k = q + c e_k + r_k,   c ~ N(c0, s_c^2),   r_k ~ N(0, (sigma w_k)^2),   sigma^2 ~ scaled inverse chi^2.

``q`` is the number of the continuous problem, ``e_k`` the area that whole elements add along the
contact's edge (Yastrebov, Anciaux and Molinari 2017), of which only the size ``c`` is uncertain, and
``r_k`` what is left. In an area that is which elements the edge happens to catch: the count of n edge
elements varies as sqrt(n), and n goes as 1 / h, so ``w`` falls as h^(3/2). ``q`` given c and sigma is
normal; sigma integrates to a Student distribution, and c numerically (Gelman et al. 2013, ch. 3, 14).
Friction takes its edge's share from the area, by ``tau / N``. Every other number's ``w`` is told by the
grids themselves: by how much of the contact is edge, by how sharp the peak is, by how slopes bend from
element to element. These fall as powers of h where a surface is resolved; where it is not they do not, and
bars stay wide. Where the peak stands alone nothing bounds what finer grids find there, and where spots are
single elements nothing but the number itself bounds area and friction.

The priors were fitted to random scenes of a training set (`verification.coverage`: seeds 1000 to 1199; by
likelihood in `verification.coverage.priors`); what they promise was judged on the scenes of other seeds. How
bars open where nothing is resolved was chosen on 16 surfaces of noise, and judged on 16 others
(`test_accuracy_estimates.py`).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cache
from typing import NamedTuple

import numpy as np
from scipy import optimize, special

from refimpl.grid import Array
from refimpl.grid_result import GridResult

EDGE_SHARE = (math.pi - 1 + math.log(2)) / 24  # of an edge element, in `perimeter_corrected_area`
EDGE_SIZE, EDGE_SIZE_SPREAD = 0.78, 0.07  # c0, s_c
SINGLES = 1.5  # what a lone element's edge counts more than an edge
_TWO_SIDED, _ONE_SIDED = 1.959964, 1.644854  # a normal distribution's 95 %
_RAN_OFF = 1e100  # of any number in SI units: squares still fit a double
DECAY = 1.5  # order of the area's scatter
_LONE = 2.0  # drop of a peak whose neighbours bear half as much, in the mean
_ROUNDING = 1e-6  # instead of zero
_UNKNOWN = 0.15  # of an area, at most, as sigma: with its edge's share a bar then reaches down to none


class Prior(NamedTuple):
    """Of a scatter: sigma on the finest grid in the number's unit, and how many grids that is worth."""

    scatter: float
    weight: float


AREA = Prior(0.2, 6.0)  # unit: element area times the root of number and `alike` of the edge elements
BULK = Prior(0.003, 1.0)  # friction without tau's share; unit of this and the last: value (edge / area)^1.5
PEAK = Prior(0.05, 3.0)  # unit: peak times its drop to the neighbours
BINORMAL = Prior(0.002, 1.0)  # unit: normal force, else as the next
OTHER = Prior(0.1, 1.0)


class Estimate(NamedTuple):
    """A number of the continuous problem, and the 95 % bound of its error."""

    value: float
    spread: float

    def bar(self, found: float) -> float:
        """95 % bound of the error of a number found on a grid.

        A normal distribution's, of which the bound needs one side alone where the number found is far off.
        Of the wider tails that make ``spread`` one side is shorter still.

        >>> [round(Estimate(1.0, 0.1).bar(found), 6) for found in (1.0, 1.05, 1.5)]
        [0.1, 0.134, 0.583923]
        """
        distance, deviation = abs(found - self.value), self.spread / _TWO_SIDED
        if not distance < 3 * deviation:
            return distance + _ONE_SIDED * deviation
        return deviation * math.sqrt(special.chndtrix(0.95, 1.0, (distance / deviation) ** 2))


def estimates(results: Sequence[GridResult]) -> dict[str, Estimate]:
    """Estimates of the reported numbers, from grids coarse to fine (one at least)."""
    columns = {name: np.array([result.numbers[name] for result in results]) for name in results[0].numbers}
    fine = {name: abs(float(column[-1])) for name, column in columns.items()}
    area, force = columns["contact_area"], columns["normal_force"]
    slip, drop = (np.array([getattr(result, name) for result in results]) for name in ("slip", "drop"))
    spacing = np.array([result.spacing for result in results])
    thin, uneven, lone = thinness(results), unevenness(results), drop >= _LONE

    def smooth(values: Array, prior: Prior, *sizes: Array) -> Estimate:
        size = np.hypot.reduce([prior.scatter * sizes[0], *sizes[1:]])
        if math.isinf(size[-1]):
            return Estimate(float(values[-1]), math.inf)
        return line(values, _weights(size, spacing), prior._replace(scatter=float(size[-1])))

    def peaked(name: str, prior: Prior, size: Array) -> Estimate:
        """A number that hangs on the highest peak, of which a grid knows less the less its neighbours bear.

        One that stands alone may be of any size below its element's, and of any pressure.
        """
        widened = np.full(size.shape, np.inf)
        np.divide(size, 1 - (drop / _LONE) ** 2, out=widened, where=~lone)
        return smooth(columns[name], prior, widened)

    def sheared(name: str, share: Array, unit: float) -> Estimate:
        """A number that contains ``share`` times the contact area, and slopes times ``unit``."""
        rest = smooth(columns[name] - share * area, BULK, thin * fine[name], uneven * unit)
        value = rest.value + float(share[-1]) * whole.value
        return Estimate(value, math.hypot(rest.spread, float(share[-1]) * whole.spread))

    whole, load = _area(results, area), fine["normal_force"]
    return {
        "friction_coefficient": sheared("friction_coefficient", slip, 1.0),
        "friction_force": sheared("friction_force", slip * force, load),
        "contact_area": whole,
        "contact_area_corrected": whole,
        "max_pressure": peaked("max_pressure", PEAK, drop * columns["max_pressure"]),
        "approach": peaked("approach", OTHER, thin * fine["approach"]),
        **({} if results[-1].loaded else {"normal_force": peaked("normal_force", OTHER, thin * load)}),
        "binormal_force": smooth(columns["binormal_force"], BINORMAL, thin * load, uneven * load),
    }


def thinness(results: Sequence[GridResult]) -> Array:
    """How much of each grid's contact is edge, to the order at which an area's scatter falls."""
    return np.array([min(1.0, _edge_share(result)) for result in results]) ** DECAY


def _edge_share(result: GridResult) -> float:
    area = result.numbers["contact_area"]
    return max(result.edge, 0.0) / area if area > 0 else 1.0


def unevenness(results: Sequence[GridResult]) -> Array:
    """How far slopes within elements leave mu open; all of it where spots are single elements."""
    uneven = np.array([result.unevenness for result in results])
    whole = abs(results[-1].numbers["friction_coefficient"])
    wider: Array = np.maximum(uneven, np.minimum(uneven / _known(results), whole))
    return wider


def _known(results: Sequence[GridResult]) -> Array:
    """How well grids know areas beside what a count says: not at all where all spots are single elements.

    The outer square is a measure, not a law: without it bars missed by a tenth on surfaces of noise.
    """
    known: Array = np.maximum(1 - singleness(results) ** 2, _ROUNDING) ** 2
    return known


def singleness(results: Sequence[GridResult]) -> Array:
    """How far spots are single elements: the edge's share of the contact over a lone element's."""
    return np.array([_edge_share(result) for result in results]) / (4 * EDGE_SHARE)


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
    """Discretisation parts of the finest grid's numbers; none without contact or of a state that ran off."""
    found = results[-1].numbers
    if not results[-1].touching or not all(abs(value) < _RAN_OFF for value in found.values()):
        return {}
    return {
        name: {"discretisation": estimate.bar(found[name])} for name, estimate in estimates(results).items()
    }


def _area(results: Sequence[GridResult], area: Array) -> Estimate:
    """Contact area: the edge's mean share is a regressor, its scatter that of a count.

    A lone element's edge counts for more: finer grids find less of it than of an edge. On the training
    scenes once more is likeliest, on surfaces of noise and on measured ones 1.5 to 2 times.
    """
    edge = np.array([result.edge for result in results])
    scatter = area_scatter(results)
    prior = AREA._replace(scatter=AREA.scatter * scatter[-1])
    return line(area, scatter / scatter[-1], prior, edge * (1 + SINGLES * singleness(results) ** 2))


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
        counted, np.minimum(counted / _known(results), _UNKNOWN * area / AREA.scatter)
    )
    return scatter


def line(values: Array, weights: Array, prior: Prior, edge: Array | None = None) -> Estimate:
    """``q`` of the model above, from ``values`` on grids coarse to fine with ``w_k = weights``.

    ``prior.scatter`` is sigma of the finest grid in the number's unit.

    >>> line(np.array([1.04, 1.02, 1.01]), np.array([8.0, 2.8, 1.0]), Prior(0.001, 1.0)).value < 1.015
    True
    """
    if not np.any(values):
        return Estimate(0.0, 0.0)
    sizes, shares = (np.zeros(1), np.ones(1)) if edge is None else _edge_sizes()
    rest = values - sizes[:, None] * (0 if edge is None else edge)
    precision = weights**-2.0
    centre = rest @ precision / precision.sum()
    squares = ((rest - centre[:, None]) ** 2) @ precision
    freedom = prior.weight + len(values) - 1
    variance = (prior.weight * prior.scatter**2 + squares) / freedom
    variance = np.maximum(variance, np.finfo(float).tiny + (np.finfo(float).eps * values[-1]) ** 2)
    shares = shares * (variance / variance.min()) ** (-0.5 * freedom)
    shares = shares / shares.sum()
    value = float(shares @ centre)
    scale = np.sqrt(variance / precision.sum())
    return Estimate(value, _bound(shares, centre - value, scale, freedom))


def _bound(shares: Array, centres: Array, scales: Array, freedom: float) -> float:
    """What a mixture of Student's distributions exceeds, either way together, with 5 %."""
    widest = float(np.max(np.abs(centres)) + np.max(scales) * special.stdtrit(freedom, 0.975))
    if len(shares) == 1:
        return widest

    either_way = np.array([centres, -centres])

    def beyond(bound: float) -> float:
        tails = special.stdtr(freedom, (either_way - bound) / scales)
        return float((tails @ shares).sum()) - 0.05

    return float(optimize.brentq(beyond, 0.0, widest, rtol=1e-4)) if beyond(widest) < 0 else widest


@cache
def _edge_sizes() -> tuple[Array, Array]:
    """Nodes and weights of the prior of ``c`` (Gauss-Hermite)."""
    nodes, weights = np.polynomial.hermite_e.hermegauss(9)
    return EDGE_SIZE + EDGE_SIZE_SPREAD * nodes, weights / weights.sum()
