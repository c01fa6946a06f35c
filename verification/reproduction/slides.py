"""Figs 9 and 10 and steady sliding: forces over sliding distance and direction."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from refimpl.grid import Array
from verification.sweep.run import Row


@dataclass(frozen=True)
class Turning:
    """One roughness over the direction (rad): the elastic part of friction over friction, and friction over
    its mean over the directions less 1. Shapes ``(realisations, directions)``.
    """

    flat_rms: float
    direction: Array
    elastic: Array
    anisotropy: Array


def turning(found: Sequence[Row]) -> list[Turning]:
    """Return one entry per roughness."""
    directions = sorted({row["sliding_direction"] for row in found})
    result = []
    for flat in sorted({row["lower_rms"] for row in found}):
        chosen = [row for row in found if row["lower_rms"] == flat]
        shape = (len(chosen) // len(directions), len(directions))
        # a study's rows come realisation by realisation, with the directions in their order within
        friction = np.array([row["friction_force"] for row in chosen]).reshape(shape)
        elastic = np.array([row["elastic_friction"] for row in chosen]).reshape(shape)
        mean = friction.mean(axis=1, keepdims=True)
        result.append(Turning(flat, np.array(directions), elastic / friction, friction / mean - 1))
    return result


def beyond_mean_slope(direction: Array, values: Array) -> float:
    """Return the share of variance over directions (rad) beyond first harmonics; as in `Turning`."""
    mean_free = values - values.mean(axis=1, keepdims=True)
    harmonic = np.column_stack([np.cos(direction), np.sin(direction)])
    fitted = mean_free @ np.linalg.pinv(harmonic).T @ harmonic.T
    return float(np.sum((mean_free - fitted) ** 2) / np.sum(mean_free**2))


@dataclass(frozen=True)
class Trace:
    """A quantity over the sliding offset (m): its values, its mean, the scatter of one position, the standard
    error of the mean (from the series' own correlation) and the distance over which it decorrelates (m).
    """

    offset: Array
    values: Array
    mean: float
    scatter: float
    standard_error: float
    correlated: float


def trace(found: Sequence[Row], quantity: str) -> Trace:
    """Return a trace's statistics; ``correlated``: its autocorrelation's integral to the first zero."""
    offset = np.array([row["sliding_offset"] for row in found])
    values = np.array([row[quantity] for row in found])
    deviation = values - values.mean()
    products = np.correlate(deviation, deviation, "full")[len(values) - 1 :]
    correlation = products / products[0]
    ends = int(np.argmax(correlation <= 0)) or len(correlation)
    steps = 1 + 2 * float(correlation[1:ends].sum())
    scatter = float(values.std(ddof=1))
    error = scatter * float(np.sqrt(steps / len(values)))
    return Trace(
        offset, values, float(values.mean()), scatter, error, steps * float(offset[1] - offset[0]) / 2
    )
