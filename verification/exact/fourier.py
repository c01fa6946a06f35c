"""Full contact of a rough plane, exactly, in Fourier space; with Coulomb friction and the symbols of both
discretisations.

Transforms: f^(q) = integral of f exp(-i q x), so 1/rho -> 2 pi/|q| and s/rho^2 = d(ln rho)/ds -> -2 pi i
q_s/|q|^2 (ln rho -> -2 pi/|q|^2 for q != 0). Hence with u = a p + c (tau + beta p), q != 0,

    u^ = A(q) p^,   A = 2/(E* |q|) - 2 pi i c0 beta q_s/|q|^2 = (2/(E* |q|)) (1 - i d beta q_s/|q|),

d = pi c0 E*, and full contact of a gap h means u^ = -h^: p^ = -h^/A, with the mean pressure free. tau drops
out: it is uniform. Source of the normal part: Johnson 1985, section 13.2; the coupling is derived here.

On a grid of square elements of edge h in a period of M of them, an operator may take A at the grid's own
frequencies (band-limited: exact for surfaces without higher waves) or integrate the kernel over elements
(piecewise constant): its symbol is then the sum over aliases of A(q) sinc(q_x h/2) sinc(q_y h/2),
`piecewise_symbol`.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from refimpl.errors import InputError

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

UNCERTAINTY = 1e-13
"""Relative error of `FullContact`: FFT rounding."""
SYMBOL_UNCERTAINTY = 1e-10
"""Relative error of the alias sums after averaging (change between 24 and 40 aliases, measured in the tests).
"""


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
    """A(q) (m/Pa) at wave vectors (1/m), broadcast; ``slip`` is d beta; the mean, q = 0, is given 0 (no rigid
    motion).
    """
    qx, qy = np.asarray(qx, dtype=float), np.asarray(qy, dtype=float)
    q = np.hypot(qx, qy)
    along = np.cos(direction) * qx + np.sin(direction) * qy
    safe = np.where(q > 0, q, 1.0)
    return np.where(q > 0, 2 / (modulus * safe) * (1 - 1j * slip * along / safe), 0.0)


def single_wave(amplitude: float, wavelength: float, modulus: float, slip: float) -> tuple[float, float]:
    """Pressure amplitude (Pa) and phase lag (rad) under the gap -amplitude cos(2 pi x/wavelength), sliding
    along x.

    tan(phi) = d beta; the amplitude is pi E* Delta/lambda times cos(phi), and the pressure's crests lie at
    x = -phi lambda/(2 pi), on the trailing side of the wave's.

    >>> single_wave(1.0, np.pi, 1.0, slip=0.0)
    (1.0, 0.0)
    """
    phi = float(np.arctan(slip))
    return float(np.pi * modulus * amplitude / wavelength * np.cos(phi)), phi


def piecewise_symbol(
    m: int, n: int, M: int, side: float, modulus: float, slip: float = 0.0, *, aliases: int = 40
) -> complex:
    """Eigenvalue (m/Pa) of the element-integrated periodic operator at frequency ``(m, n)`` of an ``M``-grid.

    Poisson sum over aliases (m + M i, n + M j); terms alternate in sign, so repeated averaging of the square
    partial sums along each axis (Euler's transformation) makes it converge geometrically.
    """
    h = side / M
    i = np.arange(-aliases, aliases + 1)
    qx, qy = 2 * np.pi / side * (m + M * i), 2 * np.pi / side * (n + M * i)
    terms = symbol_at(qx[:, None], qy[None, :], modulus, slip)
    terms = terms * np.sinc(qx * h / (2 * np.pi))[:, None] * np.sinc(qy * h / (2 * np.pi))[None, :]
    return complex(_euler(_euler(terms.T).T))


def _euler(terms: Complex) -> Complex:
    """Sum along the last axis, symmetric and alternating in its outer half, by repeated averaging of partial
    sums.
    """
    half = terms.shape[-1] // 2
    outward = terms[..., half + 1 :] + terms[..., half - 1 :: -1]
    partial = terms[..., half, None] + np.cumsum(outward, axis=-1)
    while partial.shape[-1] > half // 2:
        partial = (partial[..., 1:] + partial[..., :-1]) / 2
    return np.asarray(partial[..., -1])


def lattice_symbol(
    m: int, n: int, M: int, side: float, modulus: float, slip: float = 0.0, *, rings: int = 96
) -> complex:
    """`piecewise_symbol` again, from real space: element integrals over the infinite lattice, damped by a
    Gaussian window.

    The window exp(-rho^2/2 w^2) convolves the symbol, whose error has even powers of 1/w: two widths,
    extrapolated once.
    """
    h = side / M
    span = np.arange(-rings, rings + 1)
    x, y = np.meshgrid(h * span.astype(float), h * span.astype(float), indexing="ij")
    waves = np.exp(-2j * np.pi * (m * span[:, None] + n * span[None, :]) / M)
    element = (_normal_element(x, y, h) + slip * _shear_element(x, y, h)) / (np.pi * modulus)
    values = []
    for width in (rings * h / 6, rings * h / 6 / np.sqrt(2)):
        values.append(np.sum(element * waves * np.exp(-(x**2 + y**2) / (2 * width**2))))
    return complex(2 * values[0] - values[1])


def _normal_element(x: Array, y: Array, h: float) -> Array:
    """Integral of 1/rho over a square element of edge ``h`` (m), by its antiderivative at the corners."""
    total = np.zeros(np.broadcast(x, y).shape)
    for i, j in itertools.product((-1, 1), repeat=2):
        u, v = x + i * h / 2, y + j * h / 2
        total += i * j * (u * np.arcsinh(v / np.abs(u)) + v * np.arcsinh(u / np.abs(v)))
    return total


def _shear_element(x: Array, y: Array, h: float) -> Array:
    """Integral of x/rho^2 over the element: antiderivative v ln(rho) + u atan(v/u)."""
    total = np.zeros(np.broadcast(x, y).shape)
    for i, j in itertools.product((-1, 1), repeat=2):
        u, v = x + i * h / 2, y + j * h / 2
        total += i * j * (v * np.log(u**2 + v**2) / 2 + u * np.arctan(v / u))
    return total
