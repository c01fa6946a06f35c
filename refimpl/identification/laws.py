"""Nested friction laws compared by information criteria (AIC: Akaike 1974; BIC: Schwarz 1978).

``r = tau + beta f`` holds Coulomb's law (tau = 0) and constant shear (beta = 0), and is held by
``r = min(tau + beta f, r_max)``. The limited law is computed at the pressures of the fitted law, and all of
them at further parameters as fitted, which count as parameters of each. Each row states its uncertainty, so
``AIC = chi-square + 2 k`` needs no correction for few rows (that of Hurvich and Tsai 1989 is for a fitted
variance).
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares, nnls

from refimpl.grid import Array
from refimpl.identification.data_table import Row
from refimpl.identification.fit import Fit
from refimpl.identification.profile import BOUNDED

DECISIVE = 6.0  # difference of AIC from which the worse law has little support


@dataclass(frozen=True)
class Law:
    """A fitted law: parameters by name (Pa; beta 1), chi-square, AIC and BIC."""

    name: str
    parameters: Mapping[str, float]
    chi_square: float
    aic: float
    bic: float


def compare(rows: Sequence[Row], fitted: Fit) -> tuple[Law, ...]:
    """Return the laws, ordered by AIC."""
    measured = np.array([row.mu for row in rows])
    slopes = np.array([response.slopes[:BOUNDED] for response in fitted.responses])
    at_zero = fitted.predicted - slopes @ fitted.theta[:BOUNDED]
    further = len(fitted.theta) - BOUNDED
    root = fitted.root
    scale = np.max(np.abs(slopes), axis=0)
    wanted = root @ (measured - at_zero)

    linear = {"tau": fitted.theta[0], "beta": fitted.theta[1]}
    laws = [_law("tau + beta f", linear, fitted.chi_square, len(root), further)]
    for k, (name, parameter) in enumerate((("constant shear", "tau"), ("Coulomb", "beta"))):
        x, misfit = nnls((root @ slopes[:, [k]]) / scale[k], wanted)
        laws.append(_law(name, {parameter: float(x[0] / scale[k])}, misfit**2, len(root), further))
    if len(root) > 3:
        laws.append(_limited(fitted, measured))
    return tuple(sorted(laws, key=lambda law: law.aic))


def _limited(fitted: Fit, measured: Array) -> Law:
    """Return the law with a limit, from several starts: the least of them."""
    pressures = [np.array(response.pressures) for response in fitted.responses]
    weights = [np.array(response.weights) for response in fitted.responses]
    tau, beta = fitted.theta[:BOUNDED]
    peak = max(float(p.max()) for p in pressures)
    top = tau + beta * peak
    scales = np.array([max(tau, 1e-3 * top), max(beta, 1e-3 * top / peak), top])

    def friction(t: float, b: float, limit: float) -> Array:
        return np.array(
            [float(np.sum(w * np.minimum(t + b * p, limit))) for p, w in zip(pressures, weights, strict=True)]
        )

    base = friction(tau, beta, math.inf)

    def misfit(x: Array) -> Array:
        predicted = fitted.predicted + friction(*(x * scales)) - base
        return np.asarray(fitted.root @ (measured - predicted))

    starts = ([tau / scales[0], beta / scales[1], share] for share in (0.3, 0.6, 1.0))
    found = [least_squares(misfit, np.maximum(start, 1e-9), bounds=(0, np.inf)) for start in starts]
    best = min(found, key=lambda one: one.cost)
    chi_square = min(2 * float(best.cost), fitted.chi_square)
    x = best.x * scales if 2 * best.cost <= fitted.chi_square else np.array([tau, beta, top])
    return _law(
        "min(tau + beta f, r_max)",
        dict(zip(("tau", "beta", "r_max"), map(float, x), strict=True)),
        chi_square,
        len(fitted.root),
        len(fitted.theta) - BOUNDED,
    )


def _law(name: str, parameters: Mapping[str, float], chi_square: float, n: int, further: int) -> Law:
    k, chi_square = len(parameters) + further, float(chi_square)
    values = {key: float(value) for key, value in parameters.items()}
    return Law(name, values, chi_square, chi_square + 2 * k, chi_square + k * math.log(n))
