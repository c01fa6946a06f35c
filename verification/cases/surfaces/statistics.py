"""Random fields: skewness, moments of the whitened field, Eq. (9) with two correlation lengths and a lay."""

from __future__ import annotations

import math

import numpy as np

from refimpl.grid import Array, Grid
from refimpl.surfaces import GaussianRoughness, statistics
from verification.cases import Measured, case


@case("surfaces/skewness", metric="relative", tolerance=1e-14)
def skewness() -> Measured:
    """Skewness of sharp crests over wide valleys.

    Claim: z = cos t + 1/2 cos 2t has the skewness 3/8 / (5/8)^(3/2), positive: its crests are sharp
    Source: moments of two harmonics: mean z^2 = 1/2 + 1/8, mean z^3 = 3/4 * 1/2
    Tolerance: equidistant points give these means exactly; 64 x 64 of them round by a few eps each
    """
    t = 2 * math.pi * np.arange(64) / 64
    z = np.add.outer(np.cos(t) + 0.5 * np.cos(2 * t), np.zeros(64))
    return Measured(statistics.skewness(z), 0.375 / 0.625**1.5)


def whitened(seed: int, lengths: int, points: int) -> Array:
    """Return independent numbers of unit variance from a periodic field of unit rms and correlation length.

    The field's modes up to two waves per length, each over the root of its power by Eq. (9); a Gaussian
    field's are independent normal numbers, and so is their Fourier sum on ``points`` per side.
    """
    grid = Grid.square(float(lengths), 6 * lengths, periodic=True)
    modes = np.fft.fft2(GaussianRoughness(1.0, 1.0, seed).heights(grid))
    k = np.fft.fftfreq(points, 1 / points)
    root = np.exp(-(math.pi**2) * (k[:, None] ** 2 + k**2) / (4.6 * lengths**2))
    inside = np.outer(abs(k) < points / 2, abs(k) < points / 2)
    rows = k.astype(int)  # negative ones count from the end, as in the finer transform
    white = np.fft.ifft2(modes[np.ix_(rows, rows)] / root * inside).real
    return np.asarray(white / np.sqrt(np.mean(white**2)))


@case("surfaces/white-moments", metric="at_most", tolerance=4.0)
def white_moments() -> Measured:
    """The random field is Gaussian, not only of Eq. (9)'s covariance.

    Claim: divided mode by mode by Eq. (9)'s spectrum the heights are independent normal numbers: their third
    moment is 0 and their fourth 3
    Source: paper section 6.1: Gaussian heights
    Tolerance: in standard errors, sqrt(6 / n) and sqrt(24 / n): a Gaussian field strays farther in 1e-4 of
    all seeds. A smoothed field hides its noise's law from its own moments; uniform noise is 10 off
    """
    z = whitened(seed=1, lengths=50, points=200)
    third, fourth = (float(np.mean(z**k)) for k in (3, 4))
    off = (third / math.sqrt(6 / z.size), (fourth - 3) / math.sqrt(24 / z.size))
    return Measured(max(map(abs, off)), note=f"third moment {third:+.4f}, fourth {fourth:.4f}")


SETTINGS = (((2.0, 1.0), 0.0), ((3.0, 1.0), 0.6), ((1.0, 2.5), -1.1), ((4.0, 1.0), math.pi / 2))
SEEDS, SIDE, POINTS = range(1, 31), 40.0, 160
"""Fixed beforehand; not selected."""


def equation_9(x: float, y: float, lengths: tuple[float, float], lay: float) -> float:
    """Return Eq. (9) at a lag (x, y) over rms^2."""
    along, across = x * math.cos(lay) + y * math.sin(lay), y * math.cos(lay) - x * math.sin(lay)
    return math.exp(-2.3 * ((along / lengths[0]) ** 2 + (across / lengths[1]) ** 2))


def mean_product(z: Array, i: int, j: int) -> float:
    """Return the mean product of heights that are (i, j) points apart, i >= 0."""
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
    h, worst = SIDE / POINTS, 0.0
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
    return Measured(worst)
