"""Eq. (9) with two correlation lengths and a lay, against its formula."""

from __future__ import annotations

import math

import numpy as np

from refimpl.grid import Array, Grid
from refimpl.surfaces import GaussianRoughness
from verification.framework.case import Measured
from verification.framework.registry import case

SETTINGS = (((2.0, 1.0), 0.0), ((3.0, 1.0), 0.6), ((1.0, 2.5), -1.1), ((4.0, 1.0), math.pi / 2))
SEEDS, SIDE, POINTS = range(1, 31), 40.0, 160
"""Fixed beforehand; not selected."""


def equation_9(x: float, y: float, lengths: tuple[float, float], lay: float) -> float:
    """Eq. (9) at a lag (x, y) over rms^2."""
    along, across = x * math.cos(lay) + y * math.sin(lay), y * math.cos(lay) - x * math.sin(lay)
    return math.exp(-2.3 * ((along / lengths[0]) ** 2 + (across / lengths[1]) ** 2))


def mean_product(z: Array, i: int, j: int) -> float:
    """Mean product of heights that are (i, j) points apart, i >= 0."""
    n = len(z)
    ahead = z[i:, max(j, 0) : n + min(j, 0)]
    return float(np.mean(ahead * z[: n - i, max(-j, 0) : n - max(j, 0)]))


@case("surfaces/lay-covariance", metric="at_most", tolerance=4.5)
def covariance() -> Measured:
    """Two correlation lengths and a lay: the ensemble's covariance.

    Claim: heights of any lay have the covariance rms^2 exp(-2.3 (x'^2 / lx^2 + y'^2 / ly^2)), free and
    periodic
    Source: paper Eq. (9)
    Tolerance: in standard errors of a mean product, whose variance is int R(s)^2 + R(s + d) R(s - d) ds over
    the area, pi lx ly / 4.6 (1 + R(d)^2) / area; of 48 normal numbers one is larger in 3e-4 of all ensembles
    """
    h, worst, rows = SIDE / POINTS, 0.0, {}
    for lengths, lay in SETTINGS:
        for periodic in (False, True):
            grid = Grid.square(SIDE, POINTS, periodic=periodic)
            fields = [GaussianRoughness(1.0, lengths, seed, lay=lay).sample(grid) for seed in SEEDS]
            for i, j in ((0, 0), (3, 0), (0, 3), (2, 2), (2, -2), (5, 2)):
                found = float(np.mean([mean_product(z, i, j) for z in fields]))
                exact = equation_9(i * h, j * h, lengths, lay)
                area = len(SEEDS) * SIDE**2 * (1 - i / POINTS) * (1 - abs(j) / POINTS)
                error = math.sqrt(math.pi * math.prod(lengths) / 4.6 * (1 + exact**2) / area)
                worst = max(worst, abs(found - exact) / error)
                if i == j == 2:
                    kind = "periodic" if periodic else "free"
                    rows[f"{lengths}, lay {math.degrees(lay):.0f} degrees, {kind}"] = [found, exact, error]
    return Measured(worst, data={"covariance at (2, 2) points, Eq. (9), standard error": rows})
