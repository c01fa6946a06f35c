"""Maximum likelihood of errors whose mean and variance are linear in known sizes, with Student's tails."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import scipy

from refimpl.grid import Array


@dataclass(frozen=True)
class Fitted:
    """Maximum of the likelihood: ``mean``, ``scale`` and their standard errors, log-likelihood, freedom."""

    mean: Array
    mean_error: Array
    scale: Array
    scale_error: Array
    freedom: float
    likelihood: float
    samples: int


def fit(
    errors: Array,
    means: Array,
    squares: Array,
    *,
    freedoms: Sequence[float],
    prior: Array | None = None,
    known: Array | float = 0.0,
    start: float = 1.0,
) -> Fitted:
    """Return the likeliest ``mean`` and ``scale`` of ``errors = means @ mean + sqrt(squares @ scale^2) t``.

    Parameters
    ----------
    errors : array (n,)
    means : array (n, k), sizes of the parts of the mean; k may be zero
    squares : array (n, m), squared sizes of the parts of the scatter
    freedoms : degrees of freedom of Student's t to choose from
    prior : array (k, k), precision of a normal prior of ``mean`` about zero
    known : array (n,), squares of scatter that is known beside ``squares @ scale^2``
    start : scale from which the search begins
    """
    found = (_fit(errors, means, squares, freedom, prior, known, start) for freedom in freedoms)
    return max(found, key=lambda one: one.likelihood)


def _fit(
    errors: Array,
    means: Array,
    squares: Array,
    freedom: float,
    prior: Array | None,
    known: Array | float,
    start: float,
) -> Fitted:
    k, m = means.shape[1], squares.shape[1]
    precision = np.zeros((k, k)) if prior is None else prior
    constant = scipy.special.gammaln((freedom + 1) / 2) - scipy.special.gammaln(freedom / 2)
    constant -= 0.5 * np.log(freedom * np.pi)

    def loss(x: Array) -> tuple[float, Array]:
        mean, variances = x[:k], np.exp(2 * x[k:])
        variance = known + squares @ variances + np.finfo(float).tiny
        rest = errors - means @ mean
        ratio = rest**2 / variance
        weight = (freedom + 1) / (freedom + ratio)
        logs = -constant + 0.5 * np.log(variance) + 0.5 * (freedom + 1) * np.log1p(ratio / freedom)
        by_variance = 0.5 * (1 - weight * ratio) / variance
        by_mean = precision @ mean - means.T @ (weight * rest / variance)
        slope = np.concatenate([by_mean, 2 * variances * (squares.T @ by_variance)])
        return float(logs.sum() + 0.5 * mean @ precision @ mean), slope

    first = np.concatenate([np.zeros(k), np.full(m, np.log(start))])
    bounds = [(None, None)] * k + [(np.log(start) - 12, np.log(start) + 8)] * m
    options = {"maxiter": 5000, "maxfun": 20000, "ftol": 1e-12}
    best = scipy.optimize.minimize(loss, first, jac=True, method="L-BFGS-B", bounds=bounds, options=options)
    deviation = np.sqrt(np.maximum(np.diag(np.linalg.pinv(_hessian(loss, best.x))), 0))
    scale, top = np.exp(best.x[k:]), -float(best.fun)
    return Fitted(best.x[:k], deviation[:k], scale, deviation[k:] * scale, freedom, top, len(errors))


def _hessian(loss: Callable[[Array], tuple[float, Array]], x: Array) -> Array:
    step = 1e-4
    rows = np.array([(loss(x + step * e)[1] - loss(x - step * e)[1]) / (2 * step) for e in np.eye(len(x))])
    symmetric: Array = 0.5 * (rows + rows.T)
    return symmetric
