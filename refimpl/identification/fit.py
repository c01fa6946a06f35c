"""Weighted nonlinear least squares for tau, beta and further parameters, with parts of the covariance.

At a fixed contact ``mu = F / P`` is linear in ``(tau, beta)``, and the contact depends on friction weakly.
So the model of all rows is solved and linearised, fitted within its bounds, and linearised again at the fit
(Gauss and Newton), until the linear model predicts what the next solves give. Further parameters are fitted
by their logarithms, in steps of half of their value at most.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares

from refimpl.grid import Array
from refimpl.identification.data_table import Row
from refimpl.identification.ensemble import Scatter, draws, mean_response, scatter, working_variances
from refimpl.identification.forward import COVERAGE, Forward, Response
from refimpl.identification.profile import BOUNDED, Profile
from refimpl.identification.varying_profile import VaryingProfile
from refimpl.scene.scene import Scene

MAX_PASSES, MAX_FURTHER_PASSES = 6, 8  # without further parameters, and with them
_AGREED = 0.02  # standard uncertainties by which prediction and solve may differ at the end
_FURTHER_AGREED = 0.1  # with further parameters, likewise: elements that yield or not change mu by steps
_FULL_STEPS = 4  # passes with further parameters after which steps are halved: such steps can alternate
_CORRELATED = 0.5  # share of the bars' variance that all rows have in common: one grid, one surface
_LONGEST = math.log(1.5)  # step of a further parameter's logarithm in one pass
REALISATIONS = "realisations"  # the part of the covariance by the choice of a realisation
_ALONE = 1e-6  # share of a row's weight that the other rows leave to judge it, at least
_RIDGE = 1e-10  # relative, added to the normal matrix: rows at one A/P leave it singular


@dataclass(frozen=True, eq=False)
class Fit:
    """A fit: ``theta`` (tau in Pa, beta, logarithms) within the bounds, ``free`` without them.

    responses : of the rows, linear about the last solves; passes : of solves over all rows
    between : (rows,), variances of friction by the choice of a realisation, as they weigh rows
    scatter : of the draws about their mean
    gain : (parameters, rows), change of ``free`` by a change of the measured mu
    residuals : measured less predicted mu over the standard uncertainty with bars
    deleted : measured mu less that of the fit to the other rows, over its standard uncertainty
    nonlinearity : largest difference of prediction and solve, in standard uncertainties
    limited : whether a further parameter went its longest step in the last pass
    """

    theta: Array
    free: Array
    responses: tuple[Response, ...]
    between: Array
    scatter: Scatter
    gain: Array
    weights: Array
    predicted: Array
    residuals: Array
    deleted: Array
    chi_square: float
    nonlinearity: float
    passes: int
    limited: bool = False


def fit_rows(
    rows: Sequence[Row], scenes: Sequence[Scene], forward: Forward, start: Array, realisations: int = 1
) -> Fit:
    """Fit all parameters to the mean over realisations. Raises errors as the solves do."""
    theta, predicted, passes = start, None, 0
    most, agreed = (MAX_FURTHER_PASSES, _FURTHER_AGREED) if forward.further else (MAX_PASSES, _AGREED)
    while True:
        passes += 1
        drawn = [draws(forward, scene, theta, realisations) for scene in scenes]
        between = working_variances(drawn, np.array([scene.load for scene in scenes]))
        responses = tuple(mean_response(row) for row in drawn)
        _check_slopes(responses, forward.further, theta)
        solved = np.array([response.predict(theta) for response in responses])
        scale = np.sqrt(np.diag(data_covariance(rows, responses, between)))
        away = np.inf if predicted is None else float(np.max(np.abs(solved - predicted) / scale))
        found = linear_fit(rows, responses, between, scatter(drawn), away, passes)
        if (away < agreed and not found.limited) or passes == most:
            return found
        share = 0.5 if forward.further and passes >= _FULL_STEPS else 1.0
        theta, predicted = theta + share * (found.theta - theta), solved + share * (found.predicted - solved)


def _check_slopes(responses: Sequence[Response], further: Sequence[str], theta: Array) -> None:
    """Raise `ArithmeticError` where mu does not depend on a further parameter at any load."""
    for j, name in enumerate(further, start=BOUNDED):
        if not any(response.slopes[j] for response in responses):
            value = math.exp(theta[j])
            raise ArithmeticError(
                f"mu depends on {name} at no measured load, near {value:.4g}: the data do not determine it, "
                "or the scene's value is a bad first guess"
            )


def data_covariance(rows: Sequence[Row], responses: Sequence[Response], between: Array) -> Array:
    """Return the covariance of measured less modelled mu: measurement, bars, contact edges, realisations."""
    own = np.array([row.u_mu**2 for row in rows]) + between
    return np.asarray(np.diag(own) + sum(_bars(responses).values()))


def _bars(responses: Sequence[Response]) -> dict[str, Array]:
    parts = {
        "numerical": np.array([r.numerical for r in responses]) / COVERAGE,
        "contact edge": np.array([r.contact_edge for r in responses]) / COVERAGE,
    }
    return {
        name: _CORRELATED * np.outer(u, u) + (1 - _CORRELATED) * np.diag(u**2) for name, u in parts.items()
    }


def linear_fit(
    rows: Sequence[Row],
    responses: Sequence[Response],
    between: Array,
    scattered: Scatter,
    away: float,
    passes: int,
) -> Fit:
    """Fit the linear models of all rows by generalised least squares, within the bounds and without."""
    measured = np.array([row.mu for row in rows])
    slopes = np.array([response.slopes for response in responses])
    origin = np.array([0.0] * BOUNDED + list(responses[0].at[BOUNDED:]))
    at_origin = np.array([response.predict(origin) for response in responses])
    scale = max(float(np.max(np.abs(measured))), 1e-12) / np.max(np.abs(slopes), axis=0)
    covariance = data_covariance(rows, responses, between)
    root = np.linalg.inv(np.linalg.cholesky(covariance))
    design, wanted = root @ slopes * scale, root @ (measured - at_origin)
    normal = design.T @ design
    normal += _RIDGE * np.trace(normal) * np.eye(len(scale))
    gain = scale[:, None] * np.linalg.solve(normal, design.T @ root)
    step = gain @ (measured - at_origin)
    moved = _bounded(design, wanted, step / scale, scale) * scale
    predicted = at_origin + slopes @ moved
    misfit, weights = root @ (measured - predicted), root.T @ root
    return Fit(
        theta=origin + moved,
        free=origin + step,
        responses=tuple(responses),
        between=between,
        scatter=scattered,
        gain=gain,
        weights=weights,
        predicted=predicted,
        residuals=(measured - predicted) / np.sqrt(np.diag(covariance)),
        deleted=_deleted(weights, slopes @ gain, measured - predicted),
        chi_square=float(misfit @ misfit),
        nonlinearity=away,
        passes=passes,
        limited=bool(np.any(np.abs(moved[BOUNDED:]) > _LONGEST * (1 - 1e-6))),
    )


def _deleted(weights: Array, hat: Array, misfit: Array) -> Array:
    """Residual of each row from the fit to the others, in standard uncertainties (Cook and Weisberg 1982).

    Rows are correlated, so it is ``(W e)_i / sqrt((W - W X G)_ii)``; 0 for a row that a parameter rests on.
    """
    own = np.diag(weights - weights @ hat)
    alone = own < _ALONE * np.diag(weights)
    return np.where(alone, 0.0, weights @ misfit / np.sqrt(np.where(alone, 1.0, own)))


def _bounded(design: Array, wanted: Array, free: Array, scale: Array) -> Array:
    """Least squares with tau and beta not negative and with the longest step of further parameters.

    All in units of ``scale``; ``free`` is the minimum without bounds.
    """
    low = np.concatenate([np.zeros(BOUNDED), -_LONGEST / scale[BOUNDED:]])
    high = np.concatenate([np.full(BOUNDED, np.inf), _LONGEST / scale[BOUNDED:]])
    if np.all((free >= low) & (free <= high)):
        return free
    start = np.clip(free, low + 1e-12, high - 1e-12)
    found = least_squares(
        lambda x: design @ x - wanted, start, jac=lambda x: design, bounds=(low, high), xtol=1e-12
    )
    return np.select([found.active_mask < 0, found.active_mask > 0], [low, high], found.x)


def shares(rows: Sequence[Row], fitted: Fit, inputs: Sequence[Mapping[str, float]]) -> dict[str, Array]:
    """Return the parts of the covariance of all parameters by source.

    measurement, numerical, contact edge, realisations where there are several, and each toleranced input,
    which all rows share.
    """
    parts = {"measurement": np.diag([row.u_mu**2 for row in rows]), **_bars(fitted.responses)}
    for name in inputs[0] if inputs else ():
        change = np.array([row[name] for row in inputs]) / COVERAGE
        parts[f"input {name}"] = np.outer(change, change)
    found = {name: fitted.gain @ part @ fitted.gain.T for name, part in parts.items()}
    if math.isfinite(fitted.scatter.degrees):
        found[REALISATIONS] = fitted.scatter.variance(fitted.gain, fitted.theta)
    scale = np.max(np.abs(fitted.gain), axis=1)
    found["measurement"] = found["measurement"] + 1e-12 * np.diag(scale**2) * np.mean(
        [row.u_mu**2 for row in rows]
    )
    return found


def profile_of(fitted: Fit, parts: Mapping[str, Array]) -> Profile | VaryingProfile:
    """Return the likelihood of a fit with the whole covariance, of which realisations give a part."""
    fixed = np.asarray(sum(part for name, part in parts.items() if name != REALISATIONS))
    if REALISATIONS not in parts:
        return Profile(fitted.free, fixed)

    def estimated(theta: Array) -> Array:
        return fitted.scatter.variance(fitted.gain, theta)

    return VaryingProfile(fitted.free, fixed, estimated, fitted.scatter.degrees, fitted.theta)
