"""Transforms of kernels that are even or odd around the circles of both axes, from a quarter of them.

Quarters hold the offsets from 0 to half a circle; spectra are half along the first axis, whole along the
second. Cosines and sines are real: no kernel is spread over its circles first.
"""

from __future__ import annotations

import numpy as np

from refimpl.grid import Array
from refimpl.operators.transforms import Complex, fourier


def even_hat(quarter: Array, workers: int) -> Array:
    """Return the real symbols of a kernel even along both axes. The quarter may be overwritten."""
    return _mirrored(fourier.even_plane(quarter, workers), 1.0)


def odd_hat(along_x: Array, along_y: Array | None, workers: int) -> Complex:
    """Return the symbols of kernels odd along the first axis and the second; zero opposite 0."""
    sines = _mirrored(fourier.odd_plane(along_x, workers), 1.0)
    if along_y is not None:
        sines += _mirrored(fourier.odd_plane(along_y.T, workers).T, -1.0)
    hat = np.zeros(sines.shape, dtype=np.complex128)
    np.negative(sines, out=hat.imag)
    return hat


def _mirrored(half: Array, sign: float) -> Array:
    """Continue around the second axis' circle, with that sign beyond its half."""
    return np.concatenate([half, sign * half[:, -2:0:-1]], axis=1)
