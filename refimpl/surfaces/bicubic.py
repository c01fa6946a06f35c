"""Bicubic resampling: tensor products of cubic splines through the data (not-a-knot: exact for bicubics)."""

from __future__ import annotations

import numpy as np
import scipy

from refimpl.grid import Array

# A cubic spline's memory of a far data point fades by 2 - sqrt(3) = 0.268 a point; 0.268^32 = 5e-19.
MEMORY = 32


def resample(data: Array, x: Array, y: Array) -> Array:
    """Return the values at all pairs of ``x``, ``y``, ``(len(x), len(y))``.

    ``data[i, j]`` sits at ``(i, j)``, at least four points an axis; end pieces go on beyond the outermost.
    """
    rows, columns = _reach(x, data.shape[0]), _reach(y, data.shape[1])
    along_x = _spline(data[rows, columns], x - rows.start)
    return np.ascontiguousarray(_spline(along_x.T, y - columns.start).T)


def resample_periodic(data: Array, x: Array, y: Array) -> Array:
    """Return ``resample`` for data that repeat with the periods ``data.shape``."""
    nx, ny = data.shape
    wrapped = np.pad(data, MEMORY, mode="wrap")
    return resample(wrapped, np.mod(x, nx) + MEMORY, np.mod(y, ny) + MEMORY)


def _spline(values: Array, at: Array) -> Array:
    return np.asarray(scipy.interpolate.make_interp_spline(np.arange(len(values)), values, k=3)(at))


def _reach(at: Array, n: int) -> slice:
    low, high = int(np.floor(at.min())) - MEMORY, int(np.ceil(at.max())) + MEMORY + 1
    return slice(max(min(low, n - 4), 0), min(max(high, 4), n))
