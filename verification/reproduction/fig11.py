"""Fig. 11: distributions of heights and slopes of the flat, undeformed and in contact."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.stats import jarque_bera, kstat, kurtosis, skew, ttest_1samp

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

    Points of one surface are correlated, so a test that takes them as independent rejects too much: that
    naive test's statistic is kept (``jarque_bera``, of one realisation) beside the sound ones, p values of
    Student's t over realisations that the mean skewness is 0 and the mean kurtosis 3.
    """

    name: str
    centres: Array
    density: Array
    skewness: Estimate
    kurtosis: Estimate
    p_skewness: float
    p_kurtosis: float
    jarque_bera: float


def samples(realisation: int, grid: int) -> tuple[Array, Array, Array, Array]:
    """The four samples of one realisation at P = 70 N: heights in um, slopes (along sliding) in degrees.

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
        found.surface_lower[found.contact] * 1e6,
        np.degrees(found.theta_x[found.contact]),
    )


def panels(realisations: int, grid: int) -> list[Panel]:
    """The four distributions over realisations."""
    found = [samples(k, grid) for k in range(realisations)]
    return list(_panels(found))


def _panels(found: list[tuple[Array, Array, Array, Array]]) -> Iterator[Panel]:
    for name, parts in zip(PANELS, zip(*found, strict=True), strict=True):
        pooled = np.concatenate([part - part.mean() for part in parts])
        density, edges = np.histogram(pooled, BINS, density=True)
        skews = [float(skew(part)) for part in parts]
        tails = [float(kurtosis(part, fisher=False)) for part in parts]
        yield Panel(
            name=name,
            centres=(edges[1:] + edges[:-1]) / 2,
            density=density,
            skewness=estimate(skews),
            kurtosis=estimate(tails),
            p_skewness=float(ttest_1samp(skews, 0.0).pvalue),
            p_kurtosis=float(ttest_1samp(tails, 3.0).pvalue),
            jarque_bera=float(jarque_bera(parts[0]).statistic),
        )


def pooled_skewness(found: list[Array]) -> float:
    """Skewness of all realisations' points together, each about its own mean, by k statistics."""
    pooled = np.concatenate([part - part.mean() for part in found])
    return float(kstat(pooled, 3) / kstat(pooled, 2) ** 1.5)
