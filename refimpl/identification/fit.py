"""Weighted nonlinear least squares for tau and beta, with parts of the covariance.

At a fixed contact ``mu = F / P`` is linear in ``(tau, beta)``, and the contact depends on friction weakly.
So the model of all rows is solved and linearised, fitted within its bounds, and linearised again at the fit
(Gauss and Newton), until the linear model predicts what the next solves give.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares

from refimpl.grid import Array
from refimpl.identification.data_table import Row
from refimpl.identification.forward import COVERAGE, Forward, Response
from refimpl.identification.profile import Profile
from refimpl.scene.scene import Scene

MAX_PASSES = 6
_AGREED = 0.02  # standard uncertainties by which prediction and solve may differ at the end
_CORRELATED = 0.5  # share of the bars' variance that all rows have in common: one grid, one surface
_RIDGE = 1e-10  # relative, added to the normal matrix: rows at one A/P leave it singular


@dataclass(frozen=True, eq=False)
class Fit:
    """A fit: ``theta`` (tau in Pa, beta) within the bounds, ``free`` without them.

    responses : of the rows, linear about the last solves; passes : of solves over all rows
    gain : (2, rows), change of ``free`` by a change of the measured mu
    residuals : measured less predicted mu over ``scale``, the standard uncertainty with bars
    nonlinearity : largest difference of prediction and solve, in standard uncertainties
    """

    theta: Array
    free: Array
    responses: tuple[Response, ...]
    gain: Array
    weights: Array
    predicted: Array
    residuals: Array
    chi_square: float
    nonlinearity: float
    passes: int


def fit(rows: Sequence[Row], scenes: Sequence[Scene], forward: Forward, start: Array) -> Fit:
    """Fit both parameters. Raises `InputError` and `ArithmeticError` as the solves do."""
    theta, predicted, passes = start, None, 0
    while True:
        passes += 1
        responses = tuple(forward.respond(scene, theta) for scene in scenes)
        solved = np.array([response.predict(theta) for response in responses])
        scale = np.sqrt(np.diag(data_covariance(rows, responses)))
        away = np.inf if predicted is None else float(np.max(np.abs(solved - predicted) / scale))
        found = linear_fit(rows, responses, away, passes)
        if away < _AGREED or passes == MAX_PASSES:
            return found
        theta, predicted = found.theta, found.predicted


def data_covariance(rows: Sequence[Row], responses: Sequence[Response]) -> Array:
    """Return the covariance of measured less modelled mu: measurement, bars and contact edges."""
    return np.asarray(np.diag([row.u_mu**2 for row in rows]) + sum(_bars(responses).values()))


def _bars(responses: Sequence[Response]) -> dict[str, Array]:
    parts = {
        "numerical": np.array([r.numerical for r in responses]) / COVERAGE,
        "contact edge": np.array([r.contact_edge for r in responses]) / COVERAGE,
    }
    return {
        name: _CORRELATED * np.outer(u, u) + (1 - _CORRELATED) * np.diag(u**2) for name, u in parts.items()
    }


def linear_fit(rows: Sequence[Row], responses: Sequence[Response], away: float, passes: int) -> Fit:
    """Fit the linear models of all rows by generalised least squares, within the bounds and without."""
    measured = np.array([row.mu for row in rows])
    slopes = np.array([response.slopes for response in responses])
    at_zero = np.array([response.predict(np.zeros(2)) for response in responses])
    scale = max(float(np.max(np.abs(measured))), 1e-12) / np.max(np.abs(slopes), axis=0)
    root = np.linalg.inv(np.linalg.cholesky(data_covariance(rows, responses)))
    design, wanted = root @ slopes * scale, root @ (measured - at_zero)
    normal = design.T @ design
    normal += _RIDGE * np.trace(normal) * np.eye(2)
    gain = scale[:, None] * np.linalg.solve(normal, design.T @ root)
    free = gain @ (measured - at_zero)
    inside = np.maximum(free / scale, 1e-12)
    bounded = least_squares(
        lambda x: design @ x - wanted, inside, jac=lambda x: design, bounds=(0, np.inf), xtol=1e-12
    )
    theta = np.where(bounded.active_mask < 0, 0.0, bounded.x) * scale
    if np.all(free >= 0):
        theta = free
    predicted = at_zero + slopes @ theta
    misfit = root @ (measured - predicted)
    spread = np.sqrt(np.diag(data_covariance(rows, responses)))
    return Fit(
        theta=theta,
        free=free,
        responses=tuple(responses),
        gain=gain,
        weights=root.T @ root,
        predicted=predicted,
        residuals=(measured - predicted) / spread,
        chi_square=float(misfit @ misfit),
        nonlinearity=away,
        passes=passes,
    )


def shares(rows: Sequence[Row], fitted: Fit, inputs: Sequence[Mapping[str, float]]) -> dict[str, Array]:
    """Return the parts of the covariance (2, 2) of both parameters by source.

    measurement, numerical, contact edge, and each toleranced input, which all rows share.
    """
    parts = {"measurement": np.diag([row.u_mu**2 for row in rows]), **_bars(fitted.responses)}
    for name in inputs[0] if inputs else ():
        change = np.array([row[name] for row in inputs]) / COVERAGE
        parts[f"input {name}"] = np.outer(change, change)
    found = {name: fitted.gain @ part @ fitted.gain.T for name, part in parts.items()}
    scale = np.max(np.abs(fitted.gain), axis=1)
    found["measurement"] = found["measurement"] + 1e-12 * np.diag(scale**2) * np.mean(
        [row.u_mu**2 for row in rows]
    )
    return found


def profile_of(fitted: Fit, covariance: Array) -> Profile:
    """Return the likelihood of a fit with the whole covariance."""
    return Profile(fitted.free, covariance)
