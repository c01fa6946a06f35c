"""Random fields as sums of waves on a torus: white noise per wave number, evaluated at any points.

A torus with the periods ``(P, Q)`` in the sheared coordinates ``X = x + s y, Y = y`` has the waves
``exp(2 pi i (k X / P + l Y / Q))`` with the wave vectors ``q = 2 pi (k / P, l / Q + s k / P)``. With
independent standard normal numbers w and an even amplitude ``a(q)``, the field

    z(x, y) = sum_kl a(q_kl) w_kl cas(2 pi (k X / P + l Y / Q)),    cas = cos + sin,

is Gaussian, and its covariance is ``sum a^2 cos(q (x - x'))`` exactly: the sine of ``q (x + x')`` cancels
between q and -q.

Evaluation, one axis after the other: ``f(X) = sum_k c_k exp(2 pi i k X / P)`` is interpolated from N points
of the period, N at least twice the number of waves, by the Kaiser-Bessel kernel phi of 16 points, with the
coefficients divided by its transform (Greengard and Lee 2004; Barnett, Magland and af Klinteberg 2019):
the interpolation error is about ``exp(-16 pi sqrt(1/2)) = 4e-16``. Heights depend on the point alone: the
interpolated points do not change with the grid. Cost: ``n log n`` for n waves or points. Memory: the noise is
drawn in strips, so that the largest arrays are those of waves along one axis by points along the other.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

from refimpl.grid import Array
from refimpl.surfaces.noise_lattice import white_noise

Spectrum = Callable[[Array, Array], Array]
"""Amplitude a (m) at wave vectors ``(qx, qy)`` (rad/m); even, and zero beyond the waves that are summed."""
Complex = NDArray[np.complex128]

MAX_WAVES = 8192  # wave numbers an axis, of both signs: 512 MiB of noise if drawn at once
ROUNDING = 1e-9  # relative: a wave this close to an end of a spectrum lies on it
STREAM = 0x7761766573206F66  # key of the noise, ASCII "waves of": other numbers than on a lattice of points
_STRIP = 64  # wave numbers or points handled at once: the tile of the noise
_WIDTH = 16  # points of the interpolation kernel
_SHAPE = 0.75 * math.pi * _WIDTH  # shape of the Kaiser-Bessel kernel at twofold oversampling


@dataclass(frozen=True)
class PeriodicLattice:
    """The waves of a torus.

    periods : P and Q (m)
    shear : s of ``X = x + s y``
    waves : K and L, the largest ``|k|`` and ``|l|`` that are summed
    """

    periods: tuple[float, float]
    waves: tuple[int, int]
    shear: float = 0.0

    @classmethod
    def holding(
        cls,
        periods: tuple[float, float],
        shortest: Iterable[float],
        refuse: Callable[[float, str], object],
        shear: float = 0.0,
    ) -> PeriodicLattice:
        """Return the torus of waves to the ``shortest`` (m); ``refuse(factor, limit)`` where too many."""
        K, L = (P / wave * (1.0 + ROUNDING) for P, wave in zip(periods, shortest, strict=True))
        most = max(2.0 * K + 1.0, 2.0 * L + 1.0)
        if most > MAX_WAVES:
            refuse(most / MAX_WAVES, f"{MAX_WAVES} waves an axis")
        return cls(periods, (math.floor(K), math.floor(L)), shear)

    def wave_vectors(self, k: Array, across: Array) -> tuple[Array, Array]:
        """Return ``qx`` and ``qy`` (rad/m), broadcast to ``(len(k), len(across))``."""
        qx = 2.0 * math.pi / self.periods[0] * k[:, None]
        return qx, self.shear * qx + 2.0 * math.pi / self.periods[1] * across[None, :]

    def mean_squares(self, spectrum: Spectrum) -> tuple[float, float]:
        """Return the ensemble's mean squares of the height (m^2) and of the gradient."""
        height = gradient = 0.0
        for k in self._strips():
            qx, qy = self.wave_vectors(k, self._across)
            power = spectrum(qx, qy) ** 2 * np.where(k > 0, 2.0, 1.0)[:, None]
            height += float(power.sum())
            gradient += float((power * (qx**2 + qy**2)).sum())
        return height, gradient

    def field(self, spectrum: Spectrum, seed: int, x: Array, y: Array) -> Array:
        """Return heights (m) at all pairs of ``x`` and ``y`` (m), ``(len(x), len(y))``."""
        K, L = self.waves
        N, interpolate_x = _interpolation(x / self.periods[0], K)
        half = np.zeros((N // 2 + 1, len(y)), dtype=np.complex128)  # the waves k >= 0 at the points y
        M, interpolate_y = _interpolation(y / self.periods[1], L)
        weight_y = _deconvolution(self._across, M)
        for k in self._strips():
            ahead, behind = self._noise(seed, k)
            amplitude = spectrum(*self.wave_vectors(k, self._across))
            # w cas(t) + w' cas(-t) = Re (w + w' - i (w - w')) exp(i t); for k = 0 both are waves of the strip
            behind *= (k > 0)[:, None]
            lines = np.zeros((len(k), M), dtype=np.complex128)
            lines[:, self._across.astype(int) % M] = (
                amplitude * weight_y * ((ahead + behind) - 1j * (ahead - behind))
            )
            along_y = interpolate_y @ scipy.fft.ifft(lines, axis=1, norm="forward").T
            turn = 2.0 * math.pi * self.shear / self.periods[0] * np.outer(k, y)
            half[k.astype(int)] = along_y.T * np.exp(1j * turn) * _deconvolution(k, N)[:, None]
        half[1:] *= 0.5  # `irfft` adds the waves -k
        z = np.empty((len(x), len(y)))
        for j in range(0, len(y), _STRIP):
            z[:, j : j + _STRIP] = interpolate_x @ scipy.fft.irfft(
                half[:, j : j + _STRIP], N, axis=0, norm="forward"
            )
        return z

    @property
    def _across(self) -> Array:
        return np.arange(-self.waves[1], self.waves[1] + 1.0)

    def _strips(self) -> Iterator[Array]:
        """Yield the wave numbers k from 0 up, a strip at a time."""
        for first in range(0, self.waves[0] + 1, _STRIP):
            yield np.arange(first, min(first + _STRIP, self.waves[0] + 1), dtype=float)

    def _noise(self, seed: int, k: Array) -> tuple[Array, Array]:
        """Return the noise of the waves ``(k, l)`` and ``(-k, -l)`` of a strip."""
        first, last, L = int(k[0]), int(k[-1]), self.waves[1]
        across = range(-L, L + 1)
        ahead = white_noise(seed, range(first, last + 1), across, STREAM)
        behind = white_noise(seed, range(-last, -first + 1), across, STREAM)
        return ahead, behind[::-1, ::-1].copy()


def rotated(qx: Array, qy: Array, lay: float) -> tuple[Array, Array]:
    """Return the components of wave vectors along a lay and across it."""
    cosine, sine = math.cos(lay), math.sin(lay)
    return qx * cosine + qy * sine, qy * cosine - qx * sine


def _interpolation(turns: Array, waves: int) -> tuple[int, scipy.sparse.csr_array]:
    """Return the points of the period, and the matrix that interpolates from them at positions in periods."""
    N = 2 * scipy.fft.next_fast_len(2 * waves + 1 + _WIDTH, real=True)
    position = (turns - np.floor(turns)) * N
    point = np.floor(position).astype(np.int64)[:, None] + np.arange(1 - _WIDTH // 2, 1 + _WIDTH // 2)
    root = np.sqrt(np.maximum(1.0 - ((position[:, None] - point) * (2.0 / _WIDTH)) ** 2, 0.0))
    weight = scipy.special.i0e(_SHAPE * root) * np.exp(_SHAPE * (root - 1.0))  # exp(-_SHAPE) I0
    entries = (weight.ravel(), (np.repeat(np.arange(len(turns)), _WIDTH), point.ravel() % N))
    return N, scipy.sparse.csr_array(entries, shape=(len(turns), N))


def _deconvolution(wave: Array, N: int) -> Array:
    """Return the inverse of the kernel's transform at wave numbers ``|k| < N / 4``."""
    root = np.sqrt(_SHAPE**2 - (math.pi * _WIDTH / N * wave) ** 2)
    return np.asarray(root / (-np.expm1(-2.0 * root)) * 2.0 * np.exp(_SHAPE - root) / _WIDTH)
