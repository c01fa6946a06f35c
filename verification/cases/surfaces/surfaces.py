"""The random field of Eq. (9), judged by its exact covariance and its spectrum."""

from __future__ import annotations

import math

import mpmath as mp
import numpy as np

from refimpl.grid import Grid
from refimpl.surfaces import GaussianRoughness
from verification.cases import Measured, case

SOURCE = "paper Eq. (9)"
RMS, LENGTH = 0.084e-6, 104e-6  # m, section 6.1: sigma and correlation radius of the ball's roughness
SIGMAS = 4.0  # a correct Gaussian estimate strays farther in 6e-5 of all ensembles


@case("surfaces/covariance", metric="at_most", tolerance=2e-15, source=SOURCE)
def covariance() -> Measured:
    """Exact covariance of the random field against Eq. (9).

    Claim: two points of the field have the covariance rms^2 exp(-2.3 r^2 / l^2), wherever they lie
    Tolerance: Poisson's sum leaves 1.7e-17 and the cut-off 1e-16; the rest is rounding: the 35 terms of S S^T
    are each wrong by a few eps, through positions and exponentials, and add up to at most 1
    """
    # x covers two lattice cells at steps that are no fraction of l / 6, so every position in a cell occurs
    x = np.linspace(0.0, 3.0, 98)
    _, smooth = GaussianRoughness(1.0, 1.0, seed=0).smoothing(x)
    ours = (smooth @ smooth.T).toarray()
    with mp.workdps(30):
        exact = np.array([[float(mp.exp(mp.mpf("-2.3") * (mp.mpf(a) - b) ** 2)) for b in x] for a in x])
    return Measured(value=float(np.abs(ours - exact).max()), note="per axis, relative to rms^2")


@case("surfaces/spectrum", metric="at_most", tolerance=SIGMAS, source=SOURCE)
def spectrum() -> Measured:
    """Spectrum of the periodic field over twelve decades.

    Claim: mode by mode, the power of the periodic field is the Fourier transform of Eq. (9)
    Tolerance: in standard errors: |Z|^2 of one Gaussian mode scatters by its mean, n by 1 / sqrt(n)
    """
    grid, seeds = Grid.square(12.0, 96, periodic=True), range(1, 41)
    M, side = grid.shape[0], grid.lengths[0]
    power = np.mean(
        [np.abs(np.fft.rfft2(GaussianRoughness(1.0, 1.0, s).heights(grid))) ** 2 for s in seeds], axis=0
    )
    # Fourier series of the periodic sum of exp(-2.3 r^2): L^-2 pi / 2.3 exp(-pi^2 k^2 / (2.3 L^2)); images
    # add exp(-2.3 * 144) to the variance. Only columns 1 ... M/2 - 1: each of their modes is met once.
    k = np.hypot(np.fft.fftfreq(M, 1.0 / M)[:, None], np.fft.rfftfreq(M, 1.0 / M)[None, :])
    eq9 = math.pi / 2.3 / side**2 * np.exp(-(math.pi**2) * k**2 / 2.3 / side**2)
    inside = (eq9 > 1e-12 * eq9[0, 0]) & (np.arange(k.shape[1]) > 0)
    ratio, ring = (power / M**4 / eq9)[inside], np.rint(k[inside]).astype(int)
    modes = np.bincount(ring)[1:]
    mean = np.bincount(ring, ratio)[1:] / modes
    sigma = 1.0 / np.sqrt(modes * len(seeds))
    data = {
        "k l": 2.0 * math.pi * np.arange(1, len(mean) + 1) / side,
        "power / eq9": mean,
        "standard error": sigma,
    }
    return Measured(value=float(np.max(np.abs(mean - 1.0) / sigma)), data=data, note=f"{len(seeds)} seeds")


@case("surfaces/one-surface-per-seed", metric="at_most", tolerance=1e-13, source=SOURCE)
def same_surface() -> Measured:
    """One surface on every grid, at every offset.

    Claim: nested grids and shifted windows see the same heights at the same points
    Tolerance: coordinates round by eps side = 16 eps l, heights by 2.14 rms / l * 5 sigma of that, 4e-14 rms;
    sums of 35 x 35 terms add a few eps
    """
    side, M = 1.61e-3, 96
    roughness = GaussianRoughness(1.0, LENGTH, seed=1)
    coarse = roughness.heights(Grid.square(side, M))
    nested = {n: roughness.heights(Grid.square(side, n * M))[n // 2 :: n, n // 2 :: n] for n in (3, 5, 9)}
    shift = 41 * side / M
    shifted = roughness.heights(Grid.square(side, M), (shift, -shift))
    errors = {f"{n} M": float(np.abs(z - coarse).max()) for n, z in nested.items()}
    errors["shifted window"] = float(np.abs(shifted[:-41, 41:] - coarse[41:, :-41]).max())
    return Measured(value=max(errors.values()), data={"largest difference / rms": errors})


@case("surfaces/normalised-rms", metric="relative", tolerance=1e-9)
def normalised_rms() -> Measured:
    """A normalised realisation has the requested rms.

    Claim: normalise=True gives the continuous surface, not some grid, that rms over the square
    Source: paper section 6.1
    Tolerance: variances of midpoint sums, whose error is even in h: Romberg's table over 64 ... 512 points an
    axis, the last two columns of which differ by 3e-10 (in the data)
    """
    roughness = GaussianRoughness(RMS, LENGTH, seed=3, normalise=True)
    table = [np.array([np.var(roughness.heights(Grid.square(1.61e-3, M))) for M in (64, 128, 256, 512)])]
    for order in (4.0, 16.0, 64.0):
        table.append((order * table[-1][1:] - table[-1][:-1]) / (order - 1.0))
    data = {"extrapolated rms / rms - 1, by column": [math.sqrt(column[-1]) / RMS - 1.0 for column in table]}
    return Measured(value=math.sqrt(table[-1][0]), reference=RMS, unit="m", data=data)
