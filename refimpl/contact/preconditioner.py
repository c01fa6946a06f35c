"""Spectral preconditioner: the half-space's inverse on the window (periodic, unpadded)."""

from __future__ import annotations

import math

import numpy as np
import scipy.fft as sfft

from refimpl.grid import Array
from refimpl.operators.fft import Counter
from refimpl.operators.fourier import fourier, threads


class SpectralPreconditioner:
    """Approximates the inverse of ``compliance * I[1/rho]`` between elements.

    Its symbol is ``2 pi compliance / q``, the sinc of an element on it and frequencies folded at the
    spacing; ``band_limited`` is the bare symbol, which a periodic scene has. Restricted to a contact set on
    both sides it stays symmetric positive definite; the zero frequency, which a periodic symbol lacks,
    gets half of the smallest one.
    """

    def __init__(
        self,
        shape: tuple[int, ...],
        spacing: float,
        compliance: float,
        counter: Counter,
        *,
        band_limited: bool = False,
    ) -> None:
        self._shape = shape
        self._padded = _fast(shape[0]), _fast(shape[1])
        self._counter = counter
        q_x = 2 * np.pi * sfft.rfftfreq(self._padded[0], spacing)[:, None]
        q_y = 2 * np.pi * sfft.fftfreq(self._padded[1], spacing)[None, :]
        self._symbol = 1 / (
            2 * np.pi * compliance * _over_q(q_x, q_y, spacing, folds=0 if band_limited else 1)
        )

    def __call__(self, residual: Array) -> Array:
        """The preconditioned residual, same shape; the caller masks argument and result."""
        points = math.prod(self._padded)
        self._counter.add("preconditioner", points)
        workers = threads(points)
        spectrum = fourier.plane(residual, self._padded, workers)
        spectrum *= self._symbol
        n, m = self._shape
        return fourier.plane_back(spectrum, self._padded, workers)[:n, :m]


def _fast(n: int) -> int:
    return int(sfft.next_fast_len(n, real=True))


def _over_q(q_x: Array, q_y: Array, spacing: float, *, folds: int) -> Array:
    """``1/q`` as sampled at element centres: elements' sincs, with ``folds`` neighbouring bands folded in.

    One fold is within 8.1 % of the full sum in the corner of the band and 2.5 % in the mean (a test).
    Even in ``q_y``, so only half of its columns are summed.
    """
    K = q_y.size
    along_x = _bands(q_x * spacing, folds)  # so that no square overflows
    along_y = _bands(q_y[:, : K // 2 + 1] * spacing, folds)
    total = np.zeros((len(q_x), K // 2 + 1))
    for squared_x, sinc_x in along_x:
        for squared_y, sinc_y in along_y:
            q = np.sqrt(squared_x + squared_y)
            if q[0, 0] == 0:
                q[0, 0] = np.pi / max(K, 2 * (len(q_x) - 1))
            total += sinc_x * sinc_y / q
    return spacing * np.concatenate([total, total[:, (K - 1) // 2 : 0 : -1]], axis=1)


def _bands(q: Array, folds: int) -> list[tuple[Array, Array]]:
    """Squared frequencies of an axis and an element's sinc in its own band, which has none if it is alone."""
    turn = 2 * np.pi
    bands = [q + m * turn for m in range(-folds, folds + 1)]
    return [(p**2, np.sinc(p / turn) if folds else np.ones_like(p)) for p in bands]
