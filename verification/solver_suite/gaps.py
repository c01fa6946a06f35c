"""Gaps that several checks press: random, with explicit seeds, and elementary shapes; all in units of 1 m."""

from __future__ import annotations

import numpy as np

from refimpl.grid import Array


def centres(side: float, M: int) -> tuple[Array, Array]:
    """Return the element centres from the middle of the square: x ``(M, 1)`` and y ``(1, M)`` (m)."""
    x = ((np.arange(M) + 0.5) / M - 0.5) * side
    return x[:, None], x[None, :]


def waves(M: int, seed: int, *, longest: int = 1, shortest: int, hurst: float = 0.8) -> Array:
    """Return random periodic heights ``(M, M)`` of unit rms: waves 1 ... ``shortest``, flat spectrum up to
    ``longest``, self-affine beyond; the same surface on every grid, ``M > 2 shortest``.

    >>> coarse, fine = waves(8, 0, shortest=3), waves(24, 0, shortest=3)
    >>> coarse.shape, round(float(np.sqrt(np.mean(fine**2))), 12)
    ((8, 8), 1.0)
    """
    random = np.random.default_rng(seed)
    k = np.arange(-shortest, shortest + 1)
    wave = np.hypot(k[:, None], k[None, :])
    envelope = np.where((wave > 0) & (wave <= shortest), np.maximum(wave, longest) ** (-1 - hurst), 0.0)
    amplitude = envelope * (random.standard_normal(wave.shape) + 1j * random.standard_normal(wave.shape))
    spectrum = np.zeros((M, M), dtype=complex)
    spectrum[k[:, None] % M, k[None, :] % M] = amplitude
    heights = np.fft.ifft2(spectrum).real
    return np.asarray(heights / np.sqrt(np.mean(heights**2)))


def rough_bump(M: int, seed: int) -> Array:
    """Return a lopsided paraboloid with random waves on it, ``(M, M)``, on a square of side 1.

    Curvatures 1 and 2 with a twist between them, centred off the middle: no symmetry that could hide a fault.
    """
    x, y = centres(1.0, M)
    x, y = x - 0.06, y + 0.03
    smooth = (x**2 + 2 * y**2 + 0.5 * x * y) / 2
    return np.asarray(smooth + 0.012 * waves(M, seed, shortest=5))
