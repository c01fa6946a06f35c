"""Results made up to have a known limit: a disc's, first order in area and friction, second in its peak."""

from __future__ import annotations

import math
from dataclasses import replace

from refimpl.accuracy.discretisation_error import EDGE_SHARE, EDGE_SIZE, PEAK_BIAS
from refimpl.accuracy.grid_features import GridFeatures
from refimpl.accuracy.peak import NO_PEAK, Peak
from refimpl.solution.solution import REPORTED

SIDE, RADIUS, SLIP = 1e-3, 2e-4, 4e4
AREA_LIMIT, BETA, PEAK = math.pi * RADIUS**2, 0.1, 1e9


def summit(h: float, height: float = PEAK, roughness: float = 0.0) -> Peak:
    """A parabola's through a disc's peak, too high by what the model says."""
    drop = 2 * (h / RADIUS) ** 2 * height
    return Peak(height + PEAK_BIAS * drop, drop, roughness)


def made_up(M: int, size: float = EDGE_SIZE, jitter: float = 0.0, unevenness: float = 0.0) -> GridFeatures:
    """A disc's numbers on a grid: first order in its area and through tau in mu, second order in its peak."""
    h = SIDE / M
    edge = EDGE_SHARE * 8 * RADIUS * h
    scatter = jitter * math.sqrt(8 * RADIUS / h) * h**2
    area = AREA_LIMIT + size * edge + scatter
    numbers = dict.fromkeys(REPORTED, 0.0)
    numbers |= {
        "contact_area": area,
        "contact_area_corrected": area - edge,
        "friction_coefficient": BETA + SLIP * area,
        "max_pressure": PEAK * (1 - 0.3 * (h / RADIUS) ** 2),
        "normal_force": 70.0,
        "approach": 1e-6,
    }
    return GridFeatures(
        M=M,
        spacing=h,
        numbers=numbers,
        edge=edge,
        symmetry_multiplicity=1.0,
        peak=summit(h),
        first_contact=NO_PEAK,
        slope_sampling_error=unevenness,
        dmu_dA=SLIP,
        parts={name: {"iteration": 0.0} for name in REPORTED},
    )


def told(mu: float, M: int, unevenness: float) -> GridFeatures:
    """A grid on which slopes made mu what it is."""
    result = made_up(M, slope_sampling_error=unevenness)
    return replace(result, numbers={**result.numbers, "friction_coefficient": mu}, dmu_dA=0.0)


def peaked(M: int, height: float, drop: float, roughness: float = 0.0) -> GridFeatures:
    """A grid with that summit of its pressure."""
    return replace(made_up(M), peak=Peak(height, drop, roughness))
