"""Full contact of a rough plane, exactly, in Fourier space, with Coulomb friction.

Transforms: f^(q) = integral of f exp(-i q x), so 1/rho -> 2 pi/|q| and s/rho^2 = d(ln rho)/ds -> -2 pi i
q_s/|q|^2 (ln rho -> -2 pi/|q|^2 for q != 0). Hence with u = a p + c (tau + beta p), q != 0,

    u^ = A(q) p^,   A = 2/(E* |q|) - 2 pi i c0 beta q_s/|q|^2 = (2/(E* |q|)) (1 - i d beta q_s/|q|),

d = pi c0 E*, and full contact of a gap h means u^ = -h^: p^ = -h^/A, with the mean pressure free. tau drops
out: it is uniform. Source of the normal part: Johnson 1985, section 13.2; the coupling is derived here. An
operator that takes A at a grid's own frequencies is exact for surfaces without higher waves.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from refimpl.errors import InputError
from refimpl.grid import Array

Complex = NDArray[np.complex128]

UNCERTAINTY = 1e-13
"""Relative error of `FullContact`: FFT rounding."""


@dataclass(frozen=True)
class FullContact:
    """Gap ``h`` (m), shape ``(M, M)`` over one square period of edge ``side`` (m), pressed flat by
    ``mean_pressure`` (Pa).

    ``coupling`` d = pi c0 E*, friction ``beta`` along ``direction`` (rad); exact when the gap has no wave at
    or beyond the grid's Nyquist frequency. Raises InputError where some pressure would be negative.
    """

    gap: Array
    side: float
    modulus: float
    mean_pressure: float
    coupling: float = 0.0
    beta: float = 0.0
    direction: float = 0.0

    @property
    def pressure(self) -> Array:
        """p (Pa), shape ``(M, M)``."""
        M = len(self.gap)
        q = 2 * np.pi * np.fft.fftfreq(M, self.side / M)
        symbol = symbol_at(q[:, None], q[None, :], self.modulus, self.coupling * self.beta, self.direction)
        symbol[0, 0] = 1.0
        spectrum = -np.fft.fft2(self.gap) / symbol
        spectrum[0, 0] = self.mean_pressure * M**2
        p = np.fft.ifft2(spectrum).real
        if p.min() < 0:
            raise InputError(
                "mean_pressure",
                self.mean_pressure,
                f"at least {self.mean_pressure - p.min()} Pa: full contact",
            )
        return p

    @property
    def approach(self) -> float:
        """Approach of the mean planes from first contact (m): mean gap minus least gap."""
        return float(np.mean(self.gap) - np.min(self.gap))


def symbol_at(
    qx: ArrayLike, qy: ArrayLike, modulus: float, slip: float = 0.0, direction: float = 0.0
) -> Complex:
    """Return A(q) (m/Pa) at wave vectors (1/m), broadcast; ``slip`` is d beta; 0 at q = 0, the mean."""
    qx, qy = np.asarray(qx, dtype=float), np.asarray(qy, dtype=float)
    q = np.hypot(qx, qy)
    along = np.cos(direction) * qx + np.sin(direction) * qy
    safe = np.where(q > 0, q, 1.0)
    return np.where(q > 0, 2 / (modulus * safe) * (1 - 1j * slip * along / safe), 0.0)
