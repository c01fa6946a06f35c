"""Statistics of heights on equidistant points: pure functions of ``z[i, j]`` (m) and the spacings (m).

Moments are about the mean of the points given. Slopes are central differences, one-sided at the border.
One spacing stands for both axes.
"""

from __future__ import annotations

import numpy as np

from refimpl.grid import Array


def rms_height(z: Array) -> float:
    """Return the root of the mean square deviation from the mean height (m)."""
    return float(np.std(z))


def skewness(z: Array) -> float:
    """Return the third central moment over ``rms^3``; 0 for Gaussian heights."""
    return _moment(z, 3)


def kurtosis(z: Array) -> float:
    """Return the fourth central moment over ``rms^4``; 3 for Gaussian heights."""
    return _moment(z, 4)


def slopes(z: Array, spacing: float | tuple[float, float]) -> tuple[Array, Array]:
    """Return ``dz/dx, dz/dy`` at every point, each of z's shape."""
    dx, dy = spacing if isinstance(spacing, tuple) else (spacing, spacing)
    return np.asarray(np.gradient(z, dx, axis=0)), np.asarray(np.gradient(z, dy, axis=1))


def rms_slopes(z: Array, spacing: float | tuple[float, float]) -> tuple[float, float]:
    """Return the root mean squares of ``dz/dx`` and ``dz/dy`` (about 0: a tilt counts)."""
    along_x, along_y = slopes(z, spacing)
    return float(np.sqrt(np.mean(along_x**2))), float(np.sqrt(np.mean(along_y**2)))


def autocorrelation(z: Array, axis: int) -> Array:
    """Return mean products at lags 0, 1, ... along an axis, over the variance: shape ``(z.shape[axis],)``.

    A lag averages the pairs there are: nothing wraps. Heights without variance give NaN.
    """
    deviations = np.moveaxis(z - np.mean(z), axis, -1)
    n = deviations.shape[-1]
    spectrum = np.fft.rfft(deviations, 2 * n)
    products = np.fft.irfft(np.mean(np.abs(spectrum) ** 2, axis=0), 2 * n)[:n]
    variance = float(np.var(z))
    return np.asarray(products / (n - np.arange(n)) / (variance if variance > 0 else np.nan))


def correlation_length(z: Array, spacing: float, level: float = 0.1) -> float | None:
    """Return the lag (m) where the mean autocorrelation of square z first falls to ``level``, or None."""
    mean = (autocorrelation(z, 0) + autocorrelation(z, 1)) / 2.0
    below = np.flatnonzero(mean <= level)
    if len(below) == 0:
        return None
    k = int(below[0])
    return float(spacing * (k - (level - mean[k]) / (mean[k - 1] - mean[k])))


def _moment(z: Array, order: int) -> float:
    deviations = z - np.mean(z)
    return float(np.mean(deviations**order) / np.mean(deviations**2) ** (order / 2.0))
