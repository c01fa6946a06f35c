"""Results made up to have a known limit: a disc's, first order in area and friction, second in its peak."""

from __future__ import annotations

import math
from dataclasses import replace

from refimpl.accuracy.contact_edge import NO_FACES
from refimpl.accuracy.discretisation_error import PEAK_BIAS
from refimpl.accuracy.grid_features import EXCESS, GridFeatures
from refimpl.accuracy.peak import NO_PEAK, Peak
from refimpl.grid import Grid
from refimpl.model.forces import EDGE_SHARE
from refimpl.solution.quantities import REPORTED

SIDE, RADIUS, DMU_DA = 1e-3, 2e-4, 4e4
AREA_LIMIT, BETA, PEAK = math.pi * RADIUS**2, 0.1, 1e9

KIND = 8  # index of the table's row for every face: the ratios at the edge of a ball
EDGE_SIZE = float(EXCESS[KIND]) / EDGE_SHARE  # mean excess over the edge


def disc_peak(h: float) -> Peak:
    """The parabola through a disc's peak on elements of edge h, too high by the bias of the model."""
    drop = 2 * (h / RADIUS) ** 2 * PEAK
    return Peak(PEAK + PEAK_BIAS * drop, drop, 0.0)


def made_up(
    M: int, size: float = EDGE_SIZE, jitter: float = 0.0, slope_sampling_error: float = 0.0
) -> GridFeatures:
    """A disc's numbers on a grid: first order in its area and through tau in mu, second order in its peak."""
    h = SIDE / M
    edge = EDGE_SHARE * 8 * RADIUS * h
    scatter = jitter * math.sqrt(8 * RADIUS / h) * h**2
    area = AREA_LIMIT + size * edge + scatter
    numbers = dict.fromkeys(REPORTED, 0.0)
    numbers |= {
        "contact_area": area,
        "contact_area_corrected": area - edge,
        "friction_coefficient": BETA + DMU_DA * area,
        "max_pressure": PEAK * (1 - 0.3 * (h / RADIUS) ** 2),
        "normal_force": 70.0,
        "approach": 1e-6,
    }
    return GridFeatures(
        grid=Grid.square(SIDE, M),
        numbers=numbers,
        edge=edge,
        symmetry_multiplicity=1.0,
        peak=disc_peak(h),
        first_contact=NO_PEAK,
        slope_sampling_error=slope_sampling_error,
        faces=tuple(8 * RADIUS / h if k == KIND else 0.0 for k in range(len(NO_FACES))),
        dmu_dA=DMU_DA,
        parts={name: {"iteration": 0.0} for name in REPORTED},
    )


def sloped(mu: float, M: int, slope_sampling_error: float) -> GridFeatures:
    """A grid on which slopes alone make mu."""
    result = made_up(M, slope_sampling_error=slope_sampling_error)
    return replace(result, numbers={**result.numbers, "friction_coefficient": mu}, dmu_dA=0.0)


def peaked(M: int, height: float, drop: float, non_parabolicity: float = 0.0) -> GridFeatures:
    return replace(made_up(M), peak=Peak(height, drop, non_parabolicity))
