"""``python -m verification.coverage.priors --store FILE --json FILE``: what training scenes ask of priors.

`refimpl.accuracy.discretisation_error` models a number found on nested grids as ``y_k = q + c e_k + r_k``.
Nothing is known of q beforehand, so the likelihood of the other parameters is that of the numbers'
differences from grid to grid: no reference is needed, and none can be wrong. It is greatest at the values
written here, beside those adopted and the logarithm of the likelihood that these give away.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy import optimize, special

from refimpl.accuracy import discretisation_error
from refimpl.accuracy.discretisation_error import (
    AREA,
    BINORMAL,
    BULK,
    EDGE_SIZE,
    EDGE_SIZE_SPREAD,
    OTHER,
    PEAK,
    PEAK_BIAS,
    PEAK_BIAS_SPREAD,
    SINGLE_EXCESS,
)
from refimpl.accuracy.first_contact import PEAK_ERROR, first_contact_error
from refimpl.accuracy.grid_features import GridFeatures
from refimpl.grid import Array
from verification.coverage.store import ladders, rungs
from verification.framework.files import write_result
from verification.framework.provenance import provenance

SOLVED = 1e-7
"""Scatter that solves to a certificate of 1e-6 leave, over the number."""
QUIET = 1e-9
"""Scatter of Q, over the load: Newton's third law cancels most of Q."""
OBLIQUE = 1e-5
"""Of Q over the load, from where on a scene counts: mirror images have none, and their grids scatter less."""
_NODES, _SHARES = np.polynomial.hermite_e.hermegauss(15)


@dataclass(frozen=True)
class Numbers:
    """One scene's numbers on its grids, coarse to fine, in one unit: values, weights w_k, edges e_k."""

    values: Array
    weights: Array
    edge: Array


def areas(results: Sequence[GridFeatures], singles: float) -> Numbers:
    """Contact areas over the finest grid's scatter; a lone element's edge counts ``1 + singles`` times."""
    area = np.array([result.numbers["contact_area"] for result in results])
    edge = np.array([result.edge for result in results])
    scatter = discretisation_error.area_scatter(results)
    wider = edge * (1 + singles * discretisation_error.single_element_share(results) ** 2)
    wider += discretisation_error.straight_excess(results)
    return Numbers(area / scatter[-1], scatter / scatter[-1], wider / scatter[-1])


def rests(results: Sequence[GridFeatures], bulk: float, unevenness: float) -> Numbers:
    """Friction without tau's share, for a scatter of one: both parts of its size are given."""
    numbers = [result.numbers for result in results]
    mu = np.array([found["friction_coefficient"] for found in numbers])
    area = np.array([found["contact_area"] for found in numbers])
    dmu_dA = np.array([result.dmu_dA for result in results])
    uneven = discretisation_error.slope_scatter(results)
    thin = discretisation_error.edge_scatter(results) * abs(mu[-1])
    size = np.hypot.reduce([bulk * thin, unevenness * uneven, np.full(thin.shape, SOLVED * abs(mu[-1]))])
    weights = np.maximum.accumulate(size[::-1])[::-1]
    return Numbers(mu - dmu_dA * area, weights, np.zeros_like(mu))


def binormals(results: Sequence[GridFeatures], binormal: float, unevenness: float) -> Numbers:
    """Binormal forces over the load, for a scatter of one: both parts of its size are given."""
    forces, loads = np.transpose(
        [(result.numbers["binormal_force"], result.numbers["normal_force"]) for result in results]
    )
    thin, uneven = discretisation_error.edge_scatter(results), discretisation_error.slope_scatter(results)
    size = np.hypot.reduce([binormal * thin, unevenness * uneven, np.full(thin.shape, QUIET)])
    weights = np.maximum.accumulate(size[::-1])[::-1]
    return Numbers(forces / loads[-1], weights, np.zeros_like(forces))


def peaks(results: Sequence[GridFeatures]) -> Numbers:
    """Heights of the pressure's peaks over the finest grid's scatter; their drops for edges."""
    sizes = np.array([result.peak.widened(result.peak.curvature_drop) for result in results])
    weights = np.maximum.accumulate(sizes[::-1])[::-1] / sizes[-1]
    heights, drops = np.transpose([(result.peak.height, result.peak.curvature_drop) for result in results])
    return Numbers(heights / sizes[-1], weights, drops / sizes[-1])


def approaches(results: Sequence[GridFeatures], other: float, touch: float) -> Numbers:
    """Approaches from the surfaces' own first contact, for a scatter of one: both parts of it are given."""
    found = np.array([result.numbers["approach"] for result in results])
    thin = other * discretisation_error.edge_scatter(results) * max(abs(found[-1]), results[-1].depth)
    hung = np.array([result.peak.widened(size, 0.5) for result, size in zip(results, thin, strict=True)])
    touched = np.array([first_contact_error(result) for result in results]) * (touch / PEAK_ERROR)
    size = np.hypot.reduce([hung, touched, np.full(thin.shape, SOLVED * abs(found[-1]))])
    weights = np.maximum.accumulate(size[::-1])[::-1]
    return Numbers(found + [result.first_contact.height for result in results], weights, np.zeros_like(found))


def bounded(results: Sequence[GridFeatures]) -> list[GridFeatures]:
    """The grids on which the error factors of the peak and of first contact are finite."""
    return [r for r in results if np.isfinite(r.peak.error_factor * r.first_contact.error_factor)]


def _over_load(result: GridFeatures) -> float:
    return abs(result.numbers["binormal_force"]) / result.numbers["normal_force"]


def log_likelihood(
    scenes: Iterable[Numbers], edge_size: float, edge_spread: float, scatter: float, weight: float
) -> float:
    """Natural log-likelihood of the parameters; q and each scene's own sigma and c integrated out."""
    sizes, total = edge_size + edge_spread * _NODES, 0.0
    for scene in scenes:
        precision, count = scene.weights**-2.0, len(scene.values)
        rest = scene.values - sizes[:, None] * scene.edge
        centre = rest @ precision / precision.sum()
        squares = ((rest - centre[:, None]) ** 2) @ precision
        freedom, prior = weight + count - 1, weight * scatter**2
        each = 0.5 * (weight * np.log(prior) - freedom * np.log(prior + squares))
        total += float(special.logsumexp(each, b=_SHARES / _SHARES.sum()))
        total += float(special.gammaln(freedom / 2) - special.gammaln(weight / 2))
        total -= float(np.log(scene.weights).sum() + 0.5 * np.log(precision.sum()))
    return total


def fitted(
    likelihood: Callable[[Array], float], adopted: dict[str, float]
) -> dict[str, dict[str, float] | float]:
    """Positive parameters where the likelihood is greatest, and what the adopted ones give away of it."""
    start = np.log(list(adopted.values()))
    found = optimize.minimize(
        lambda logs: -likelihood(np.exp(logs)), start, method="Nelder-Mead", options={"maxiter": 2000}
    )
    best = dict(zip(adopted, np.exp(found.x).tolist(), strict=True))
    return {
        "adopted": adopted,
        "likeliest": best,
        "given_away": -float(found.fun) - likelihood(np.exp(start)),
    }


def document(store: Path) -> dict[str, object]:
    """All fits, on the scenes of a store; of peaks on scenes with two grids that have them."""
    results = [[rung.result for rung in rungs] for rungs in ladders(store).values()]
    sheared = [grids for grids in results if grids[-1].numbers["friction_coefficient"] > 0]
    across = [grids for grids in results if _over_load(grids[-1]) > OBLIQUE]
    summits = [grids for grids in map(bounded, results) if len(grids) > 1]

    def of_area(p: Array) -> float:
        size, spread, scatter, weight, singles = p
        return log_likelihood([areas(grids, singles) for grids in results], size, spread, scatter, weight)

    def of_rest(p: Array) -> float:
        bulk, unevenness, weight = p
        return log_likelihood([rests(grids, bulk, unevenness) for grids in sheared], 0.0, 0.0, 1.0, weight)

    def of_binormal(p: Array) -> float:
        binormal, unevenness, weight = p
        found = [binormals(grids, binormal, unevenness) for grids in across]
        return log_likelihood(found, 0.0, 0.0, 1.0, weight)

    def of_peak(p: Array) -> float:
        size, spread, scatter, weight = p
        free = [grids for grids in summits if not grids[-1].grid.periodic]  # waves have no bias
        return log_likelihood([peaks(grids) for grids in free], size, spread, scatter, weight)

    def of_approach(p: Array) -> float:
        other, touch, weight = p
        return log_likelihood([approaches(grids, other, touch) for grids in summits], 0.0, 0.0, 1.0, weight)

    adopted_area = {
        "edge_size": EDGE_SIZE,
        "edge_size_spread": EDGE_SIZE_SPREAD,
        "scatter": AREA.scatter,
        "weight": AREA.weight,
        "singles": SINGLE_EXCESS,
    }
    adopted_rest = {"bulk": BULK.scatter, "unevenness": 1.0, "weight": BULK.weight}
    adopted_binormal = {"binormal": BINORMAL.scatter, "unevenness": 1.0, "weight": BINORMAL.weight}
    adopted_peak = {
        "summit": PEAK_BIAS,
        "summit_spread": PEAK_BIAS_SPREAD,
        "scatter": PEAK.scatter,
        "weight": PEAK.weight,
    }
    adopted_approach = {"other": OTHER.scatter, "touch": PEAK_ERROR, "weight": OTHER.weight}
    return {
        "study": "priors of the error bars, by likelihood on training scenes",
        "scenes": len(results),
        "area": fitted(of_area, adopted_area),
        "friction_without_tau": fitted(of_rest, adopted_rest),
        "binormal": fitted(of_binormal, adopted_binormal),
        "peak": fitted(of_peak, adopted_peak),
        "approach": fitted(of_approach, adopted_approach),
        "provenance": provenance(),
    }


def main(arguments: Sequence[str] | None = None) -> None:
    """Fit to a store that ``python -m verification.coverage --first 1000 --scenes 200`` has filled."""
    parser = argparse.ArgumentParser(prog="python -m verification.coverage.priors", description=__doc__)
    parser.add_argument("--store", type=Path, required=True, help="finished solves of training scenes")
    parser.add_argument("--json", type=Path, required=True, help="file to write")
    options = parser.parse_args(arguments)
    if not any(True for _ in rungs(options.store)):
        parser.error(f"{options.store} holds no scenes")
    write_result(document(options.store), options.json)


if __name__ == "__main__":
    main()
