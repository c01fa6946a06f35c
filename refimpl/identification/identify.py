"""From measured friction to tau and beta: fit, uncertainty in parts, identifiability."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np
from scipy.stats import chi2

from refimpl.errors import InputError, require_number
from refimpl.grid import Array
from refimpl.identification.data_table import Row, check_rows
from refimpl.identification.design import Proposal, propose, trial_responses
from refimpl.identification.ensemble import MIN_REALISATIONS, draws, is_random, mean_response
from refimpl.identification.fit import Fit, fit_rows, profile_of, shares
from refimpl.identification.forward import (
    NAMES,
    Forward,
    Key,
    Memory,
    Response,
    further_parameters,
    least_parameters,
)
from refimpl.identification.laws import compare
from refimpl.identification.profile import Likelihood, quantile
from refimpl.identification.result import WIDE, Identification, Interval, Prediction, notes
from refimpl.model.friction import Friction
from refimpl.scene.parameters import check_tolerances, parameters
from refimpl.scene.scene import Scene

_LARGEST = math.log(1e300)
_ONE_DRAW = (
    "the surface is one random draw, taken as the specimen itself: another may fit as well with another tau; "
    "take a measured map, or realisations"
)


def identify(
    scene: Scene,
    rows: Sequence[Row],
    grid: int | tuple[int, int] | None = None,
    *,
    loads: Sequence[float] = (),
    fit: Sequence[str] = (),
    tolerances: Mapping[str, float] | None = None,
    realisations: int = 1,
    design: bool = True,
    memory: Memory | None = None,
    key: Key | None = None,
    report: Callable[[str], None] | None = None,
) -> Identification:
    """Find tau and beta, and further parameters, from measured friction, with 95 % intervals.

    Parameters
    ----------
    scene : surfaces, materials and frame; its friction is the first guess, its load is not used
    rows : measurements (`read_rows`), of at least two loads
    grid : as in `refimpl.solve`, its default by the maps of each row
    loads : further loads (N) at which mu is predicted
    fit : parameters that are fitted as well, from the scene's values: "hardness", or the whole name
        "lower.material.hardness". It takes two more solves a row
    tolerances : relative half-widths (95 %) of inputs, as in `refimpl.budget`; friction is none of them
    realisations : fit the mean over that many draws of random surfaces (their seeds moved), where no map is
        measured; their scatter adds to the uncertainty of each row
    design : propose further loads where tau is not determined
    memory, key : keep solves by a key of scene and settings, so that a stopped fit goes on
    report : called with a line of text before each solve

    Raises
    ------
    InputError
        input out of range
    NotConverged
        a solve that does not converge
    """
    rows, tolerances = check_rows(rows), dict(tolerances or {})
    further = _check(scene, loads, tolerances, realisations, fit)
    check_rows(rows, len(NAMES) + len(further))
    forward = Forward(grid, memory, key, report, further, int(realisations))
    fitted, parts = _fitted(scene, rows, forward, tolerances)
    profile = profile_of(fitted, parts)
    result = _result(rows, fitted, parts, profile, further)
    new = [mean_response(draws(forward, replace(scene, load=load), fitted.theta)) for load in loads]
    responses, at = (*fitted.responses, *new), (*(row.load for row in rows), *loads)
    predictions = (_prediction(P, one, fitted.theta, profile) for P, one in zip(at, responses, strict=True))
    result = replace(result, predictions=tuple(predictions))
    if design and result.values["tau"].relative > WIDE:
        result = replace(result, proposal=_proposal(scene, forward, result, parts))
    result = replace(result, solves=forward.solves)
    drawn = (_ONE_DRAW,) if is_random(scene) and realisations == 1 else ()
    return replace(result, warnings=(*notes(result), *drawn))


def _result(
    rows: tuple[Row, ...],
    fitted: Fit,
    parts: Mapping[str, Array],
    profile: Likelihood,
    further: Sequence[str],
) -> Identification:
    covariance = np.asarray(sum(parts.values()))
    values = _values(fitted, profile, further)
    units = np.array([1.0, 1.0, *(values[name].value for name in further)])
    factor = _best_factor(covariance, np.mean([one.slopes for one in fitted.responses], axis=0))
    gradient = np.array([factor, 1.0] + [0.0] * len(further))
    return Identification(
        rows=rows,
        values=values,
        covariance=covariance * np.outer(units, units),
        shares={name: tuple(map(float, np.sqrt(np.diag(part)) * units)) for name, part in parts.items()},
        method="profile likelihood" if profile.is_bounded else "ellipse",
        factor=factor,
        combination=Interval(float(gradient @ fitted.theta), *profile.interval(gradient)),
        residuals=tuple(map(float, fitted.residuals)),
        deleted=tuple(map(float, fitted.deleted)),
        chi_square=fitted.chi_square,
        degrees=fitted.degrees,
        probability=float(chi2.sf(fitted.chi_square, fitted.degrees)) if fitted.degrees else 1.0,
        laws=compare(rows, fitted),
        passes=fitted.passes,
        fitted=fitted,
    )


def _fitted(
    scene: Scene, rows: Sequence[Row], forward: Forward, tolerances: Mapping[str, float]
) -> tuple[Fit, dict[str, Array]]:
    logarithms = [math.log(parameters(scene)[name]) for name in forward.further]
    start, scenes = np.concatenate([_start(scene, rows), logarithms]), [row.of(scene) for row in rows]
    try:
        fitted = fit_rows(rows, scenes, forward, start)
    except InputError as refused:
        raise _of_row(refused, rows) from refused
    inputs = []
    if tolerances:
        toleranced = (draws(forward, one, fitted.theta, tolerances) for one in scenes)
        inputs = [mean_response(drawn).inputs for drawn in toleranced]
    return fitted, shares(rows, fitted, inputs)


def _of_row(refused: InputError, rows: Sequence[Row]) -> InputError:
    """Return the refusal of a load, which names the row; any other unchanged."""
    found = [k for k, row in enumerate(rows, 1) if row.load == refused.value]
    if refused.field != "load" or not found:
        return refused
    return InputError(f"data: load of row {found[0]}", refused.value, f"N (mN, kN mixed?), {refused.allowed}")


def _proposal(
    scene: Scene, forward: Forward, result: Identification, parts: Mapping[str, Array]
) -> Proposal | None:
    rows, theta = result.rows, result.fitted.theta
    trials = trial_responses(scene, rows, forward, theta)
    relative = float(np.median([row.u_mu / max(row.mu, row.u_mu) for row in rows]))
    return propose(theta, np.asarray(sum(parts.values())), trials, relative)


def _values(fitted: Fit, profile: Likelihood, further: Sequence[str]) -> dict[str, Interval]:
    found = {}
    for j, name in enumerate(("tau", "beta", *further)):
        ends = float(fitted.theta[j]), *profile.interval(np.eye(len(fitted.theta))[j])
        found[name] = Interval(*(ends if j < len(NAMES) else map(_power, ends)))
    return found


def _power(logarithm: float) -> float:
    """Return ``exp``, infinite where an interval is too wide for floating point."""
    return math.exp(logarithm) if logarithm < _LARGEST else math.inf


def _check(
    scene: Scene,
    loads: Sequence[float],
    tolerances: Mapping[str, float],
    realisations: int,
    fit: Sequence[str],
) -> tuple[str, ...]:
    """Return the names of the further parameters."""
    if not isinstance(scene, Scene):
        raise InputError("scene", scene, "a Scene")
    if not isinstance(scene.friction, Friction):
        raise InputError("friction", scene.friction, "a Friction, whose tau and beta are found")
    for load in loads:
        require_number("loads", load, "positive loads in N", above=0)
    further = further_parameters(scene, fit)
    for name, tolerance in tolerances.items():
        if name in NAMES:
            raise InputError(f"tolerances.{name!r}", tolerance, "no friction: it is what is identified")
        if name in further:
            raise InputError(f"tolerances.{name!r}", tolerance, "no tolerance of a parameter that is fitted")
    check_tolerances(scene, tolerances)
    allowed = f"1, or from {MIN_REALISATIONS} to 100"
    require_number("realisations", realisations, allowed, at_least=1, at_most=100)
    if int(realisations) != realisations or 1 < realisations < MIN_REALISATIONS:
        raise InputError("realisations", realisations, allowed)
    if realisations > 1 and not is_random(scene):
        raise InputError("realisations", realisations, "1: no surface of the scene is random")
    return further


def _start(scene: Scene, rows: Sequence[Row]) -> Array:
    """Return the first guess: the scene's friction, or the least mu as beta and hardly any tau.

    A tau above the pressures of the smallest load would neither converge nor give slopes.
    """
    found = np.array([parameters(scene)[name] for name in NAMES])
    if found.all():
        return found
    return np.maximum([0.0, min(row.mu for row in rows)], least_parameters(scene))


def _best_factor(covariance: Array, mean: Array) -> float:
    """Return ``k`` (1/Pa) of the combination ``k tau + beta`` with the least variance; never below zero."""
    best = -float(covariance[0, 1] / covariance[0, 0])
    return best if best > 0 else float(mean[0] / mean[1])


def _prediction(load: float, response: Response, theta: Array, profile: Likelihood) -> Prediction:
    """Return the interval of mu: parameters by their likelihood, bars and scatter added in squares."""
    mu = response.predict(theta)
    slopes = np.array(response.slopes)
    slopes[: len(NAMES)] = np.maximum(slopes[: len(NAMES)], 0.0)
    middle = float(slopes @ theta)
    low, high = profile.interval(slopes)
    bar = math.hypot(response.numerical, response.contact_edge, quantile(profile.degrees) * response.scatter)
    below, above = math.hypot(middle - low, bar), math.hypot(high - middle, bar)
    return Prediction(load, Interval(mu, mu - below, mu + above))
