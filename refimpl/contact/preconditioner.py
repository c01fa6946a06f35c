"""Spectral preconditioner: the half-space's inverse, |q|, on the window (periodic, unpadded)."""

from __future__ import annotations

import math

import numpy as np
import scipy.fft as sfft

from refimpl.grid import Array
from refimpl.operators.fft import Counter


class SpectralPreconditioner:
    """Approximates the inverse of ``compliance * I[1/rho]``, whose symbol is ``2 pi compliance / q``.

    Restricted to a contact set on both sides it stays symmetric positive definite; the zero
    frequency, which a periodic symbol lacks, gets half of the smallest one.
    """

    def __init__(self, shape: tuple[int, ...], spacing: float, compliance: float, counter: Counter) -> None:
        self._shape = shape
        self._padded = tuple(sfft.next_fast_len(n, real=True) for n in shape)
        self._counter = counter
        q_x = 2 * np.pi * sfft.fftfreq(self._padded[0], spacing)[:, None]
        q_y = 2 * np.pi * sfft.rfftfreq(self._padded[1], spacing)[None, :]
        q = np.hypot(q_x, q_y)
        q[0, 0] = np.pi / (max(self._padded) * spacing)
        self._symbol = q / (2 * np.pi * compliance)

    def __call__(self, residual: Array) -> Array:
        """The preconditioned residual, same shape; the caller masks argument and result."""
        self._counter.add("preconditioner", math.prod(self._padded))
        spectrum = sfft.rfft2(residual, s=self._padded)
        spectrum *= self._symbol
        n, m = self._shape
        result: Array = sfft.irfft2(spectrum, s=self._padded, overwrite_x=True)[:n, :m]
        return result
