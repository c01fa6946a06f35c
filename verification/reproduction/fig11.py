"""Fig. 11: distributions of heights and slopes of the flat, undeformed and in contact."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.stats import kurtosis, skew, ttest_1samp

import refimpl as rf
from refimpl.grid import Array
from verification.reproduction.ensemble import Estimate, estimate
from verification.reproduction.table1 import hertz, rough

FLAT_RMS, BALL_RMS = 1.680e-6, 0.084e-6
PANELS = ("undeformed height", "undeformed slope", "deformed height in contact", "deformed slope in contact")
BINS = 40


@dataclass(frozen=True)
class Panel:
    """One distribution: pooled histogram, and moments estimated with each realisation as one observation.

    Points of one surface are correlated, so a test that takes them as independent rejects too much: the p
    values are of Student's t over realisations, that the mean skewness is 0 and the mean kurtosis 3.
    """

    name: str
    centres: Array
    density: Array
    skewness: Estimate
    kurtosis: Estimate
    p_skewness: float
    p_kurtosis: float

    @property
    def rms(self) -> float:
        """Rms of the pooled values from their means."""
        return float(np.sqrt(np.sum(self.density * self.centres**2) / np.sum(self.density)))


def samples(realisation: int, grid: int) -> tuple[Array, Array, Array, Array]:
    """Return a realisation's four samples at 70 N: heights in um, slopes along sliding in degrees.

    Undeformed: the flat within the nominal contact, the Hertz circle. In contact: the deformed flat's heights
    and the slopes of the common surface on the true contact.
    """
    scene = rough(FLAT_RMS, BALL_RMS, realisation)
    found = rf.solve(scene, grid)
    lower, _ = scene.heights(found.grid)
    x = found.grid.x - scene.lengths[0] / 2
    nominal = np.hypot(x[:, None], x[None, :]) <= hertz().contact_radius
    slope = np.degrees(np.arctan(np.gradient(lower, found.grid.spacings[0], axis=0)))
    return (
        lower[nominal] * 1e6,
        slope[nominal],
        found.surfaces[0][found.contact] * 1e6,
        np.degrees(found.slopes.theta_x[found.contact]),
    )


def panels(realisations: int, grid: int) -> list[Panel]:
    """Return the four distributions over realisations."""
    found, result = [samples(k, grid) for k in range(realisations)], []
    for name, parts in zip(PANELS, zip(*found, strict=True), strict=True):
        pooled = np.concatenate([part - part.mean() for part in parts])
        density, edges = np.histogram(pooled, BINS, density=True)
        skews = [float(skew(part)) for part in parts]
        tails = [float(kurtosis(part, fisher=False)) for part in parts]
        p_values = (float(ttest_1samp(v, mean).pvalue) for v, mean in ((skews, 0.0), (tails, 3.0)))
        middle = (edges[1:] + edges[:-1]) / 2
        result.append(Panel(name, middle, density, estimate(skews), estimate(tails), *p_values))
    return result
