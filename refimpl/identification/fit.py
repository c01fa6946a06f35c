"""Weighted nonlinear least squares for tau, beta and further parameters, with parts of the covariance.

At a fixed contact ``mu = F / P`` is linear in ``(tau, beta)``, and the contact depends on friction weakly.
So the model of all rows is solved and linearised, fitted within its bounds, and linearised again at the fit
(Gauss and Newton), until the linear model predicts what the next solves give. Further parameters are fitted
by their logarithms, in steps of half of their value at most.

A row that is off by `BLUNDER` standard uncertainties is dropped if the others agree without it: then the
row is wrong. Otherwise nothing is dropped, as the model may be wrong.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from scipy.optimize import lsq_linear
from scipy.stats import chi2

from refimpl.errors import NotConverged
from refimpl.grid import Array
from refimpl.identification.data_table import Row
from refimpl.identification.ensemble import Scatter, draws, mean_response, scatter, working_variances
from refimpl.identification.forward import COVERAGE, Forward, Response
from refimpl.identification.profile import BOUNDED, Indices, Likelihood, Profile, VaryingProfile
from refimpl.scene.scene import Scene

MAX_PASSES, MAX_FURTHER_PASSES = 6, 8  # without further parameters, and with them
_AGREED = 0.02  # standard uncertainties by which prediction and solve may differ at the end
_FURTHER_AGREED = 0.1  # with further parameters, likewise: elements that yield or not change mu by steps
_FULL_STEPS = 4  # passes with further parameters after which steps are halved: such steps can alternate
_LONGEST = math.log(1.5)  # step of a further parameter's logarithm in one pass
REALISATIONS = "realisations"  # the part of the covariance by the choice of a realisation
BLUNDER = 4.0  # standard uncertainties: of noise one row in 16,000
UNLIKELY = 0.01  # probability of a chi-square as large, below which the model or the data are doubted
_ALONE = 1e-6  # share of a row's weight that the other rows leave to judge it, at least
_RIDGE = 1e-10  # relative, added to the normal matrix: rows at one A/P leave it singular


@dataclass(frozen=True, eq=False)
class Fit:
    """A fit: ``theta`` (tau in Pa, beta, logarithms) within the bounds, ``free`` without them.

    responses : of the rows, linear about the last solves; passes : of solves over all rows
    between : (rows,), variances of friction by the choice of a realisation, as they weigh rows
    scatter : of the draws about their mean
    gain : (parameters, rows), change of ``free`` by a change of the measured mu
    root : (kept rows, rows), inverse root of the covariance of measured less predicted mu
    residuals : measured less predicted mu over the standard uncertainty with bars
    deleted : measured mu less that of the fit to the other rows, over its standard uncertainty
    nonlinearity : largest difference of prediction and solve, in standard uncertainties
    limited : whether a further parameter went its longest step in the last pass
    dropped : index of the row that the fit does not use
    """

    theta: Array
    free: Array
    responses: tuple[Response, ...]
    between: Array
    scatter: Scatter
    gain: Array
    root: Array
    predicted: Array
    residuals: Array
    deleted: Array
    chi_square: float
    nonlinearity: float
    passes: int
    limited: bool = False
    dropped: int | None = None

    @property
    def degrees(self) -> int:
        """Degrees of freedom of chi-square."""
        return max(len(self.root) - len(self.theta), 0)


def fit_rows(rows: Sequence[Row], scenes: Sequence[Scene], forward: Forward, start: Array) -> Fit:
    """Fit all parameters to the mean over realisations. Raises errors as the solves do."""
    theta, predicted, passes = start, None, 0
    most, agreed = (MAX_FURTHER_PASSES, _FURTHER_AGREED) if forward.further else (MAX_PASSES, _AGREED)
    while True:
        passes += 1
        drawn = [draws(forward, scene, theta) for scene in scenes]
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
    for j, name in enumerate(further, start=BOUNDED):
        if not any(response.slopes[j] for response in responses):
            said = f"mu depends on {name} at no measured load, near {math.exp(theta[j]):.4g}"
            why = "the data do not determine it, or the scene's value is a bad first guess"
            raise NotConverged(f"{said}: {why}")


def data_covariance(rows: Sequence[Row], responses: Sequence[Response], between: Array) -> Array:
    """Return the covariance of measured less modelled mu: measurement, bars, contact edges, realisations."""
    own = np.array([row.u_mu**2 for row in rows]) + between
    return np.asarray(np.diag(own) + sum(_bars(responses).values()))


def _bars(responses: Sequence[Response]) -> dict[str, Array]:
    """Return the model's covariances: rows share the factor of the mean excess alone."""
    bars, shared, edge = (
        np.array([getattr(r, name) for r in responses]) / COVERAGE
        for name in ("numerical", "shared", "contact_edge")
    )
    own = np.maximum(bars**2 - shared**2, 0.0)
    return {"numerical": np.outer(shared, shared) + np.diag(own), "contact edge": np.diag(edge**2)}


def linear_fit(
    rows: Sequence[Row],
    responses: Sequence[Response],
    between: Array,
    scattered: Scatter,
    away: float,
    passes: int,
) -> Fit:
    """Fit the linear models of all rows within the bounds and without; one row may be dropped."""
    every = np.arange(len(rows))
    found = _linear_fit(rows, responses, between, scattered, every)
    wrong = int(np.argmax(np.abs(found.deleted)))
    if abs(found.deleted[wrong]) >= BLUNDER and found.degrees > 1:
        rest = _linear_fit(rows, responses, between, scattered, np.delete(every, wrong))
        if chi2.sf(rest.chi_square, rest.degrees) >= UNLIKELY:
            deleted = np.where(every == wrong, found.deleted, rest.deleted)
            found = replace(rest, deleted=deleted, dropped=wrong)
    return replace(found, nonlinearity=away, passes=passes)


def _linear_fit(
    rows: Sequence[Row], responses: Sequence[Response], between: Array, scattered: Scatter, kept: Indices
) -> Fit:
    """Fit to the rows with the indices ``kept``."""
    measured = np.array([row.mu for row in rows])
    slopes = np.array([response.slopes for response in responses])
    origin = np.array([0.0] * BOUNDED + list(responses[0].at[BOUNDED:]))
    at_origin = np.array([response.predict(origin) for response in responses])
    scale = max(float(np.max(np.abs(measured))), 1e-12) / np.max(np.abs(slopes), axis=0)
    covariance = data_covariance(rows, responses, between)
    root = np.zeros((len(kept), len(rows)))
    root[:, kept] = np.linalg.inv(np.linalg.cholesky(covariance[np.ix_(kept, kept)]))
    design, wanted = root @ slopes * scale, root @ (measured - at_origin)
    normal = design.T @ design
    normal += _RIDGE * np.trace(normal) * np.eye(len(scale))
    gain = scale[:, None] * np.linalg.solve(normal, design.T @ root)
    step = gain @ (measured - at_origin)
    moved = _bounded(design, wanted, step / scale, scale) * scale
    predicted = at_origin + slopes @ moved
    misfit = root @ (measured - predicted)
    return Fit(
        theta=origin + moved,
        free=origin + step,
        responses=tuple(responses),
        between=between,
        scatter=scattered,
        gain=gain,
        root=root,
        predicted=predicted,
        residuals=(measured - predicted) / np.sqrt(np.diag(covariance)),
        deleted=_deleted(root.T @ root, slopes @ gain, measured - at_origin - slopes @ step),
        chi_square=float(misfit @ misfit),
        nonlinearity=math.inf,
        passes=0,
        limited=bool(np.any(np.abs(moved[BOUNDED:]) > _LONGEST * (1 - 1e-6))),
    )


def _deleted(weights: Array, hat: Array, misfit: Array) -> Array:
    """Return each row's residual from the fit to the others, over its deviation (Cook, Weisberg 1982).

    That is ``(W e)_i / sqrt((W - W X G)_ii)``; 0 for a row that a parameter rests on.
    """
    own = np.diag(weights - weights @ hat)
    alone = own <= _ALONE * np.diag(weights)
    return np.where(alone, 0.0, weights @ misfit / np.sqrt(np.where(alone, 1.0, own)))


def _bounded(design: Array, wanted: Array, free: Array, scale: Array) -> Array:
    """Return the least squares within the bounds, in units of ``scale``; ``free`` is without them."""
    low = np.concatenate([np.zeros(BOUNDED), -_LONGEST / scale[BOUNDED:]])
    high = np.concatenate([np.full(BOUNDED, np.inf), _LONGEST / scale[BOUNDED:]])
    if np.all((free >= low) & (free <= high)):
        return free
    return np.asarray(lsq_linear(design, wanted, (low, high), method="bvls", tol=1e-12).x)


def shares(rows: Sequence[Row], fitted: Fit, inputs: Sequence[Mapping[str, float]]) -> dict[str, Array]:
    """Return the covariance's parts: measurement, bars, realisations, and each input, which rows share."""
    parts = {"measurement": np.diag([row.u_mu**2 for row in rows]), **_bars(fitted.responses)}
    for name in inputs[0] if inputs else ():
        change = np.array([row[name] for row in inputs]) / COVERAGE
        parts[f"input {name}"] = np.outer(change, change)
    found = {name: fitted.gain @ part @ fitted.gain.T for name, part in parts.items()}
    if math.isfinite(fitted.scatter.degrees):
        found[REALISATIONS] = fitted.scatter.variance(fitted.gain, fitted.theta)
    scale = np.max(np.abs(fitted.gain), axis=1)
    mean = np.mean([row.u_mu**2 for row in rows])
    found["measurement"] = found["measurement"] + 1e-12 * np.diag(scale**2) * mean
    return found


def profile_of(fitted: Fit, parts: Mapping[str, Array]) -> Likelihood:
    """Return the likelihood of a fit with the whole covariance, of which realisations give a part."""
    fixed = np.asarray(sum(part for name, part in parts.items() if name != REALISATIONS))
    if REALISATIONS not in parts:
        return Profile(fitted.free, fixed)
    estimated = partial(fitted.scatter.variance, fitted.gain)
    return VaryingProfile(fitted.free, fixed, estimated, fitted.scatter.degrees, fitted.theta)
