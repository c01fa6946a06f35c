"""Fig. 4: the generated surfaces and their measured statistics, and the slopes that section 6.1 quotes."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

import refimpl as rf
from refimpl.grid import Array
from refimpl.surfaces import statistics
from verification.reproduction.ensemble import Estimate, estimate
from verification.reproduction.printed import CORRELATION_LENGTH, SIDE
from verification.reproduction.table1 import FIRST_SEED


@dataclass(frozen=True)
class Statistics:
    """Estimates over realisations of unit-rms surfaces: moments, correlation radius (m), slopes per unit rms
    (1/m): component rms, mean magnitude of the gradient, and largest magnitude; and the least of these.
    """

    skewness: Estimate
    kurtosis: Estimate
    radius: Estimate
    component_slope: Estimate
    mean_gradient: Estimate
    largest_gradient: Estimate
    least_steep: float


def surface(realisation: int, grid: int, *, ball: bool = False) -> Array:
    """Return the normalised heights (unit rms) of the flat's roughness, or the ball's."""
    seed = FIRST_SEED + 2 * realisation + (not ball)
    roughness = rf.GaussianRoughness(1.0e-6, CORRELATION_LENGTH, seed, normalise=True)
    return roughness.heights(rf.Grid.square(SIDE, grid)) * 1e6


def measured(realisations: int, grid: int) -> Statistics:
    """Return the statistics of the flats' roughness."""
    h = SIDE / grid
    found = []
    for k in range(realisations):
        z = surface(k, grid)
        radius = statistics.correlation_length(z, h)
        gradient = np.hypot(*statistics.slopes(z, h))
        rms = math.sqrt(float(np.mean(gradient**2)) / 2)
        moments = statistics.skewness(z), statistics.kurtosis(z), math.nan if radius is None else radius
        found.append((*moments, rms, float(gradient.mean()), float(gradient.max())))
    *others, steepest = zip(*found, strict=True)
    skewness, kurtosis, length, slope, mean_gradient = (estimate(values) for values in others)
    return Statistics(skewness, kurtosis, length, slope, mean_gradient, estimate(steepest), min(steepest))


def degrees(slope_per_rms: float, rms: float) -> float:
    """Return the slope angle (degrees) of a surface of the given rms (m)."""
    return math.degrees(math.atan(slope_per_rms * rms))
