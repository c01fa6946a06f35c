"""Power spectrum of a measured map: averaged over rings, its slope, its break-off, its direction."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

from refimpl.grid import Array
from refimpl.measured.areal_parameters import Pixel, squared
from refimpl.measured.missing_points import fill

_FANS = 360  # directions of the half-circle
_OVERLAP = 35 / 18  # variance of a sum over rings under Hann's window, over that of independent rings
_RING = 30  # points of a ring, whose mean then has a deviation of 20 %
NORMALISATION = "<h^2> = (2 pi)^-2 int C d^2q over all q of the plane, C averaged over directions"


def periodogram(z: Array, pixel: Pixel) -> tuple[Array, Array, Array]:
    """Return the spectrum (m^4) under Hann's window, missing points at the mean, and q_x, q_y (rad/m)."""
    windows = [np.sin(np.pi * (np.arange(n) + 0.5) / n) ** 2 for n in z.shape]
    known = np.isfinite(z)
    weighted = np.where(known, z - np.nanmean(z), 0.0)
    weighted *= windows[0][:, None]
    weighted *= windows[1]
    power = squared(scipy.fft.fft2(weighted))
    power *= pixel[0] * pixel[1] / float(windows[0] ** 2 @ known @ windows[1] ** 2)
    qx, qy = (2 * np.pi * scipy.fft.fftfreq(n, edge) for n, edge in zip(z.shape, pixel, strict=True))
    return power, qx, qy


@dataclass(frozen=True)
class Spectrum:
    """Two-dimensional power spectral density, ``<h^2> = (2 pi)^-2 int C d^2q``, averaged over rings of q.

    q      rad/m, of the elliptic norm ``sqrt(g^2 q_along^2 + q_across^2)``, g = 1: circles
    C      m^4; ``count``: how many points of the transform each ring averages
    """

    q: Array
    C: Array
    count: NDArray[np.intp]

    @classmethod
    def of(cls, z: Array, pixel: Pixel, anisotropy: float = 1.0, lay: float = 0.0) -> Spectrum:
        """Average the `periodogram`."""
        power, qx, qy = periodogram(z, pixel)
        cos, sin = math.cos(lay), math.sin(lay)
        along = anisotropy * (cos * qx[:, None] + sin * qy[None, :])
        norm = np.hypot(along, cos * qy[None, :] - sin * qx[:, None], out=along)
        step = 2 * np.pi * max(1.0 / (n * edge) for n, edge in zip(z.shape, pixel, strict=True))
        last = math.pi / max(pixel)  # beyond, rings are cut by the square of the transform
        ring = np.minimum(np.rint(norm / step), last / step + 1).astype(np.intp)
        count = np.bincount(ring.ravel())
        totals = [np.bincount(ring.ravel(), values.ravel(), len(count)) for values in (power, norm)]
        use = np.flatnonzero(
            (count > 0) & (np.arange(len(count)) >= 1) & (np.arange(len(count)) * step <= last)
        )
        return cls(totals[1][use] / count[use], totals[0][use] / count[use], count[use])

    def slope(self, longest: float) -> tuple[float, float]:
        """Return d ln C / d ln q from a wavelength (m) to four pixels, its deviation; NaN below six rings."""
        shortest = max(4.0 * math.pi / self.q[-1], 1.2 * (self.short_cut() or 0.0)) if len(self.q) else 0.0
        use = (self.q > 2 * np.pi / longest) & (self.q * shortest < 2 * np.pi) & (self.C > 0)
        if np.count_nonzero(use) < 6:
            return math.nan, math.nan
        q, C = np.log(self.q[use]), np.log(self.C[use])
        line, covariance = np.polyfit(q, C, 1, w=np.sqrt(self.count[use]), cov=True)
        return float(line[0]), math.sqrt(_OVERLAP * max(float(covariance[0, 0]), 0.0))

    def short_cut(self) -> float | None:
        """Return the wavelength (m) at which C falls to a tenth within a fifth of q, or None."""
        further = np.interp(1.2 * self.q, self.q, self.C)
        sure = (self.count >= _RING) & (1.2 * self.q <= self.q[-1])
        falls = np.flatnonzero((further < 0.1 * self.C) & sure)
        return 2 * math.pi / (1.1 * float(self.q[falls[0]])) if len(falls) else None


def texture_direction(z: Array, pixel: Pixel) -> float:
    """Return Std (rad): the fan of 6 degrees with most power, from x, anticlockwise."""
    power, qx, qy = periodogram(z, pixel)
    inside = np.hypot(qx[:, None], qy) < math.pi / max(pixel)
    turn = np.arctan2(qy, qx[:, None])[inside] % math.pi
    bins = np.minimum((turn * _FANS / math.pi).astype(np.intp), _FANS - 1)
    fan = np.ones(13) / 13
    total, count = (
        scipy.ndimage.convolve1d(np.bincount(bins, values, _FANS), fan, mode="wrap")
        for values in (power[inside], np.ones(len(bins)))
    )
    return float(np.argmax(total / np.maximum(count, 1e-9)) + 0.5) * math.pi / _FANS


def fill_error(filled: Array, missing: NDArray[np.bool_], pixel: Pixel) -> Array:
    """Return the error (m) of filling holes of this pattern half a map away, where the truth is known."""
    half = tuple(n // 2 for n in filled.shape)
    holes = np.roll(missing, half, (0, 1))
    error = fill(np.where(holes, np.nan, filled), pixel) - filled
    return np.roll(error, tuple(-n for n in half), (0, 1))
