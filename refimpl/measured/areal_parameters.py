"""Areal roughness parameters of a measured map: heights, bearing curve, slopes, autocorrelation.

``z[i, j]`` (m) is a levelled map, missing points NaN; ``pixel`` its spacings (m). Everything is a mean over
the points, or the pairs of points, that were measured. Names as in ISO 25178-2.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

from refimpl.grid import Array, mean_square
from refimpl.surfaces.noise_lattice import DECAY
from refimpl.surfaces.statistics import kurtosis, rms_height, skewness

Pixel = tuple[float, float]
SLOPES = 1e-4, 10.0  # rms slopes of machined, polished and worn surfaces lie between; um for m is 1e6
ISOTROPIC = 1.1  # ratio of correlation lengths up to which a map counts as isotropic, or by chance:
BY_CHANCE = 3.0  # times the correlation length over the root of the area: two of the ratio's deviations
CLASSES = 10_000  # classes of height of the material ratio curve (bearing curve)
CORE = 0.4  # material ratio of the core's secant
DIRECTIONS = 180  # directions of the half-circle in which the autocorrelation is followed


def height_parameters(z: Array) -> dict[str, float]:
    """Return Sq, Sa, Sp, Sv, Sz (m), Ssk, Sku about the mean height."""
    d = z[np.isfinite(z)] - np.nanmean(z)
    sq = rms_height(d)
    third, fourth = (skewness(d), kurtosis(d)) if sq > 0 else (math.nan, math.nan)
    high, low = float(d.max()), float(-d.min())
    mean = float(np.abs(d).mean())
    return {"Sq": sq, "Sa": mean, "Sp": high, "Sv": low, "Sz": high + low, "Ssk": third, "Sku": fourth}


def developed_area(z: Array, pixel: Pixel) -> float:
    """Return Sdr: surface over projection, less one; the mean of both ways to cut cells in triangles."""
    along, across = np.diff(z, axis=0) / pixel[0], np.diff(z, axis=1) / pixel[1]
    ends = slice(1, None), slice(None, -1)
    corners = [np.hypot(along[:, j], across[i]) for i in ends for j in ends]
    cells = np.mean([np.sqrt(1.0 + slope**2) for slope in corners], axis=0)
    return float(np.nanmean(cells)) - 1.0 if np.isfinite(cells).any() else math.nan


def mean_square_slopes(z: Array, pixel: Pixel) -> Pixel:
    """Return the mean squares of dz/dx and dz/dy, by differences of neighbours."""
    x, y = (mean_square(np.diff(z, axis=k) / pixel[k]) for k in (0, 1))
    return x, y


def implausible_slope(z: Array, pixel: Pixel) -> tuple[tuple[float, float, str], ...]:
    """Return an rms slope that a wrong unit of heights or pixel would make, its bound, and a text."""
    slope = math.sqrt(sum(mean_square_slopes(z, pixel)))
    if slope == 0 or not math.isfinite(slope) or SLOPES[0] <= slope <= SLOPES[1]:
        return ()
    shown = "{:.4g} x {:.4g} m".format(*pixel)
    text = (
        f"rms slope {slope:.2g}, beyond {SLOPES[0]:g} to {SLOPES[1]:g}: is the pixel {shown}, is unit right?"
    )
    return ((slope, SLOPES[slope > SLOPES[1]], text),)


def material_ratio(z: Array, classes: int = CLASSES) -> tuple[Array, Array]:
    """Return material ratios 0 to 1, and the heights (m, from the mean) that those shares reach."""
    ratio = np.linspace(0.0, 1.0, classes + 1)
    return ratio, np.nanquantile(z, 1.0 - ratio) - np.nanmean(z)


def core_parameters(z: Array) -> dict[str, float]:
    """Return Sk, Spk, Svk (m) by the line over the flattest 40 % of the curve (ISO 25178-2)."""
    ratio, height = material_ratio(z)
    width = round(CORE * CLASSES)
    first = int(np.argmin(height[:-width] - height[width:]))
    core = slice(first, first + width + 1)
    fall, top = np.polyfit(ratio[core], height[core], 1)
    peaks, dales = height - top, top + fall - height
    return {"Sk": float(-fall), "Spk": _reduced(peaks), "Svk": _reduced(dales)}


def _reduced(beyond: Array) -> float:
    """Return the height of the triangle whose base and area are those beyond the core."""
    share = float(np.mean(beyond > 0))
    return 2.0 * float(np.maximum(beyond, 0.0).mean()) / share if share else 0.0


def nayak(z: Array, pixel: Pixel) -> float:
    """Return Nayak's ``m0 m4 / m2^2`` of profiles along x and y, averaged; second differences for m4."""
    m2 = sum(mean_square_slopes(z, pixel)) / 2.0
    m4 = sum(mean_square(np.diff(z, 2, axis=k) / pixel[k] ** 2) for k in (0, 1)) / 2.0
    return float(np.nanvar(z)) * m4 / m2**2 if m2 > 0 else math.nan


def squared(transform: NDArray[np.complex128]) -> Array:
    """Return the squares of the magnitudes; ``abs`` would take roots and another array."""
    power = transform.real**2
    power += transform.imag**2
    return power


@dataclass(frozen=True)
class Autocorrelation:
    """Mean product of the heights of two points over their mean square, by lag.

    ``values[a, b]`` is at lag ``((a - a0) dx, (b - b0) dy)``, (a0, b0) the middle; NaN where no pair is.
    Lags run to half the map.
    """

    values: Array
    pixel: Pixel

    @classmethod
    def of(cls, z: Array, pixel: Pixel) -> Autocorrelation:
        """Compute from all pairs of measured points (nothing wraps)."""
        known = np.isfinite(z)
        d = np.where(known, z - np.nanmean(z), 0.0)
        reach = tuple(n // 2 for n in z.shape)
        shape = tuple(scipy.fft.next_fast_len(n + m, real=True) for n, m in zip(z.shape, reach, strict=True))
        order = np.ix_(*(np.arange(-m, m + 1) for m in reach))
        products, pairs = (
            scipy.fft.irfft2(squared(scipy.fft.rfft2(values, s=shape)), s=shape)[order]
            for values in (d, known)
        )
        with np.errstate(invalid="ignore", divide="ignore"):
            mean = np.where(pairs > 0.5, products / pairs, np.nan)
        variance = mean[reach]
        return cls(mean / variance if variance > 0 else mean * np.nan, pixel)

    @property
    def lags(self) -> tuple[Array, Array]:
        """Lags (m) along x and along y."""
        x, y = ((np.arange(n) - n // 2) * edge for n, edge in zip(self.values.shape, self.pixel, strict=True))
        return x, y

    def distances(self, level: float) -> Array:
        """Return distances (m) of the first fall to ``level`` at k pi / DIRECTIONS to x; NaN for none."""
        angle = np.arange(DIRECTIONS) * math.pi / DIRECTIONS
        reach = min(n // 2 * edge for n, edge in zip(self.values.shape, self.pixel, strict=True))
        r = np.arange(0.0, reach, min(self.pixel) / 2.0)
        places = [
            self.values.shape[k] // 2 + np.outer(turn(angle), r) / self.pixel[k]
            for k, turn in enumerate((np.cos, np.sin))
        ]
        along = scipy.ndimage.map_coordinates(np.nan_to_num(self.values), places, order=1, mode="nearest")
        below = along <= level
        first = np.argmax(below, axis=1)
        k = np.arange(DIRECTIONS)
        before = np.maximum(first - 1, 0)
        drop = along[k, before] - along[k, first]
        share = (along[k, before] - level) / np.where(drop > 0, drop, 1.0)
        found = r[before] + share * (r[first] - r[before])
        known = np.isfinite(self.values).any()  # not of a flat map
        return np.where(below.any(axis=1) & known, found, np.nan)

    def ellipse(self, above: float = 0.4) -> tuple[float, float, float]:
        """Return half-axes (m) at which ``exp(-r^2)`` is 1/e, and the longer one's angle to x (rad).

        ``-ln`` of the values around zero ``above`` a level is fitted by a quadratic form, squares as weights.
        """
        from scipy.ndimage import label

        regions, _ = label(np.nan_to_num(self.values) > above)
        middle = tuple(n // 2 for n in self.values.shape)
        i, j = np.nonzero(regions == regions[middle])
        rho = self.values[i, j]
        x, y = self.lags[0][i], self.lags[1][j]
        inside = ((x != 0) | (y != 0)) & (regions[middle] > 0)
        x, y, rho = x[inside], y[inside], np.minimum(rho[inside], 1.0)
        if len(rho) < 3:  # white noise, nothing beyond one pixel, or a flat map
            edge = math.sqrt(math.prod(self.pixel))
            return edge, edge, 0.0
        scale = max(float(np.abs(x).max()), float(np.abs(y).max()))
        design = np.stack([x**2, 2 * x * y, y**2], axis=1) / scale**2
        a, b, c = np.linalg.lstsq(design * rho[:, None], -np.log(rho) * rho, rcond=None)[0]
        strength, axes = np.linalg.eigh(np.array([[a, b], [b, c]]))
        strength = np.maximum(strength, 1e-12 * max(float(strength[1]), 1e-300))
        angle = math.atan2(axes[1, 0], axes[0, 0]) % math.pi
        long, short = (scale / math.sqrt(s) for s in strength)
        return long, short, angle

    def lay(self) -> tuple[float, float, float]:
        """Return the `ellipse`; a circle where its ratio is below ISOTROPIC or chance."""
        long, short, angle = self.ellipse()
        mean = math.sqrt(long * short)
        area = math.prod((n - 1) * edge for n, edge in zip(self.values.shape, self.pixel, strict=True))
        chance = 1.0 + BY_CHANCE * mean * math.sqrt(DECAY / area)
        return (mean, mean, angle) if long / short < max(ISOTROPIC, chance) else (long, short, angle)
