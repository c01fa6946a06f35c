"""The multilevel estimator: a mean on the finest grid from many coarse solves and few corrections.

``E[P_L] = E[P_0] + sum_l E[P_l - P_(l-1)]``: every term is estimated from its own realisations, and within a
term both grids sample the same surface, so that the corrections scatter little and few of them suffice.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.stats import t

Array = NDArray[np.float64]

CONFIDENCE = 0.95
_UNSEEN = 3.0  # rule of three: what N samples have not shown is rarer than 3 in N, with 95 % confidence
_FALL = 8.0  # largest ratio of variances from grid to grid: an area's count varies as h^3


@dataclass(frozen=True)
class Estimate:
    """A mean with its standard error and 95 % interval's half width, in the quantity's unit."""

    mean: float
    standard_error: float
    half_width: float
    freedom: float


def variances(levels: Sequence[Array], unseen: float) -> Array:
    """Variances of the samples of every term, each of shape ``(N_l,)`` with N_l of at least 2; ``(terms,)``.

    Areas are counts, and pairs of them may all agree. They are not known to: what N of them have not shown
    may come in a share of 3 in N, and be worth the root of ``unseen``. Nor does the variance of a correction
    fall faster than that of a count, which is more than few samples can tell.

    >>> variances([np.array([1.0, 3.0]), np.array([0.0, 0.0, 0.0, 0.0]), np.array([1.0, 1.1])], 8.0).round(3)
    array([2.  , 6.  , 0.75])
    """
    found: list[float] = []
    for term, samples in enumerate(levels):
        seen = float(np.var(samples, ddof=1)) if np.ptp(samples) > 0 else 0.0
        least = found[-1] / _FALL if term > 1 else 0.0
        found.append(max(seen, least) if seen else max(min(1.0, _UNSEEN / len(samples)) * unseen, least))
    return np.array(found)


def estimate(levels: Sequence[Array], unseen: float) -> Estimate:
    """From the samples of every term; see `variances`.

    The half width is Student's at the degrees of freedom of Welch (1947) and Satterthwaite (1946).
    """
    counts = np.array([len(samples) for samples in levels])
    parts = variances(levels, unseen) / counts
    total = float(parts.sum())
    freedom = total**2 / float((parts**2 / (counts - 1)).sum()) if total > 0 else np.inf
    error = float(np.sqrt(total))
    quantile = float(t.ppf(0.5 + CONFIDENCE / 2, freedom)) if np.isfinite(freedom) else 0.0
    mean = float(sum(np.mean(samples) for samples in levels))
    return Estimate(mean, error, quantile * error, float(freedom))


def demand(variances: Array, costs: Array, target: Array) -> Array:
    """Sample numbers ``(L,)``, not yet whole, that reach every quantity's target standard error cheapest.

    ``variances`` of the terms, ``(L, quantities)``; ``costs`` of one sample, ``(L,)``; ``target``,
    ``(quantities,)``. For one quantity ``N_l = sqrt(V_l / C_l) sum_k sqrt(V_k C_k) / target^2`` (Giles 2008);
    of several, the largest number; what does not scatter asks for none.
    """
    work = np.sqrt(variances * costs[:, None]).sum(axis=0)
    asks = work > 0
    numbers = np.sqrt(variances / costs[:, None])[:, asks] * work[asks] / target[asks] ** 2
    return np.asarray(numbers.max(axis=1, initial=0.0))


def allocation(variances: Array, costs: Array, target: Array) -> NDArray[np.int_]:
    """`demand` in whole samples."""
    found: NDArray[np.int_] = np.ceil(demand(variances, costs, target) - 1e-9).astype(np.int_)
    return found


def costs_by_start(scatter: Array, corrections: Array, alone: Array, pairs: Array, target: Array) -> Array:
    """Cost ``(L,)`` of reaching the target when the sum of terms starts on each of the grids; last: on the
    finest alone, which is plain sampling.

    The least ``sum N_l C_l`` at ``sum V_l / N_l = target^2`` has ``N_l`` proportional to ``sqrt(V_l / C_l)``,
    and is ``(sum sqrt(V_l C_l))^2 / target^2`` (Giles 2008; 2015, Acta Numerica 24, 259). Starting on grid s,
    the first term is a plain solve there, ``scatter`` its variance ``(quantities,)`` and ``alone[s]`` its
    cost, and the others remain: ``corrections`` their variances ``(L, quantities)``, ``pairs`` their costs
    ``(L,)``, the first of both unused. So a coarser grid pays where the square root of what its term costs
    is less than what a cheaper first term saves.
    """
    found = []
    for s in range(len(alone)):
        costs = np.append(alone[s], pairs[s + 1 :])
        found.append(demand(np.vstack([scatter, corrections[s + 1 :]]), costs, target) @ costs)
    return np.array(found)
