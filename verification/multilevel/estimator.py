"""The multilevel estimator: a mean on the finest grid from many coarse solves and few corrections.

``E[P_L] = E[P_0] + sum_l E[P_l - P_(l-1)]``: every term is estimated from its own realisations, and within a
term both grids see the same surface, so that the corrections scatter little and few of them suffice.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.stats import t

Array = NDArray[np.float64]

CONFIDENCE = 0.95


@dataclass(frozen=True)
class Estimate:
    """A mean with its standard error and 95 % interval's half width, in the quantity's unit."""

    mean: float
    standard_error: float
    half_width: float
    freedom: float


def estimate(levels: Sequence[Array]) -> Estimate:
    """From the samples of every term, each of shape ``(N_l,)`` with N_l of at least 2.

    The half width is Student's at the degrees of freedom of Welch (1947) and Satterthwaite (1946).
    """
    parts = np.array([np.var(samples, ddof=1) / len(samples) for samples in levels])
    counts = np.array([len(samples) for samples in levels])
    variance = float(parts.sum())
    freedom = variance**2 / float((parts**2 / (counts - 1)).sum()) if variance > 0 else np.inf
    error = float(np.sqrt(variance))
    quantile = float(t.ppf(0.5 + CONFIDENCE / 2, freedom)) if np.isfinite(freedom) else 0.0
    mean = float(sum(np.mean(samples) for samples in levels))
    return Estimate(mean, error, quantile * error, float(freedom))


def allocation(variances: Array, costs: Array, target: Array) -> NDArray[np.int_]:
    """Sample numbers ``(L,)`` that reach every quantity's target standard error at the least cost.

    ``variances`` of the terms, ``(L, quantities)``; ``costs`` of one sample, ``(L,)``; ``target``,
    ``(quantities,)``. For one quantity ``N_l = sqrt(V_l / C_l) sum_k sqrt(V_k C_k) / target^2`` (Giles 2008);
    of several, the largest number.
    """
    work = np.sqrt(variances * costs[:, None]).sum(axis=0)
    numbers = np.sqrt(variances / costs[:, None]) * work / target**2
    found: NDArray[np.int_] = np.ceil(numbers.max(axis=1) - 1e-9).astype(np.int_)
    return found
