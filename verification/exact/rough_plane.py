"""Random rough planes: true area at light pressure, A/A0 = kappa p/(E* h'), h' the rms of |grad h|.

- Bush, Gibson and Thomas 1975 (Wear 35, 87): kappa = sqrt(2 pi) = 2.507, the limit of vanishing area.
- Persson 2001 (J. Chem. Phys. 115, 3840): A/A0 = erf(sqrt(2) p/(E* h')), so kappa = sqrt(8/pi) = 1.596.
- Simulations (Hyun, Pei, Molinari and Robbins 2004; Campana and Mueser 2007; Putignano, Afferrante, Carbone
  and Demelio 2012; Prodanov, Dapp and Mueser 2014; Yastrebov, Anciaux and Molinari 2017): 2.0 to 2.6.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq
from scipy.special import erf

from refimpl.grid import Array
from verification.exact.greenwood_tripp import overlap_integral

KAPPA_BUSH_GIBSON_THOMAS = float(np.sqrt(2 * np.pi))
KAPPA_PERSSON = float(np.sqrt(8 / np.pi))
KAPPA_PUBLISHED = (2.0, 2.6)
"""The range discussed for simulations at light load."""


def persson_area(reduced_pressure: ArrayLike) -> Array:
    """Return A/A0 of Persson's theory at ``reduced_pressure`` p/(E* h'), any shape.

    >>> bool(np.isclose(persson_area(1e-6) / 1e-6, KAPPA_PERSSON))
    True
    """
    return np.asarray(erf(np.sqrt(2) * np.asarray(reduced_pressure, dtype=float)))


def persson_pressure_density(pressure: ArrayLike, mean: float) -> Array:
    """Return the density P of Persson's contact pressure; pressures over E* h', any shape.

    Full contact has the variance 1/4; a mirror image at negative pressures makes P vanish at 0.

    >>> p = np.linspace(0, 5, 5001)
    >>> bool(np.isclose(np.trapezoid(persson_pressure_density(p, 0.3), p), persson_area(0.3), atol=1e-8))
    True
    """
    p = np.asarray(pressure, dtype=float)
    return np.asarray((np.exp(-2 * (p - mean) ** 2) - np.exp(-2 * (p + mean) ** 2)) * np.sqrt(2 / np.pi))


def persson_rms_pressure(mean: ArrayLike) -> Array:
    """Return the rms of Persson's pressure over the whole plane; both over E* h', any shape.

    >>> p = np.linspace(0, 5, 5001)
    >>> square = np.trapezoid(p**2 * persson_pressure_density(p, 0.3), p)
    >>> bool(np.isclose(persson_rms_pressure(0.3), np.sqrt(square), atol=1e-8))
    True
    """
    m = np.asarray(mean, dtype=float)
    square = (0.25 + m**2) * persson_area(m) + m * np.exp(-2 * m**2) / np.sqrt(2 * np.pi)
    return np.asarray(np.sqrt(square))


def greenwood_williamson_area(pressure: ArrayLike, rms: float, density: float, radius: float) -> Array:
    """Return A/A0 of summits that do not interact, at ``pressure`` over E*, any shape.

    ``p/E* = (4/3) eta R^(1/2) sigma^(3/2) F_3/2(d/sigma)``, ``A/A0 = pi eta R sigma F_1(d/sigma)``, with the
    rms height sigma (m), density eta (1/m^2) and tip radius R (m) of the summits (`gaussian_summits`).
    Greenwood and Williamson 1966.
    """
    stiff = 4 / 3 * density * radius**0.5 * rms**1.5

    def area(p: float) -> float:
        z = brentq(lambda z: float(stiff * overlap_integral(np.array(z), 1.5)) / p - 1, -10, 12, xtol=1e-12)
        share = overlap_integral(np.array(z), 1.0)
        return float(np.pi * density * radius * rms * share)

    areas: Array = np.vectorize(area, otypes=[float])(np.asarray(pressure, dtype=float))
    return areas


def kappa(area_fraction: ArrayLike, pressure: ArrayLike, modulus: float, rms_gradient: float) -> Array:
    """Return the secant slope A/A0 E* h'/p, shapes broadcast; ``pressure`` and ``modulus`` in Pa."""
    fraction, p = np.asarray(area_fraction, dtype=float), np.asarray(pressure, dtype=float)
    return np.asarray(fraction * modulus * rms_gradient / p)


def spectral_rms_gradient(heights: Array, side: float) -> float:
    """Return the rms gradient (m/m) of periodic ``(M, M)`` heights over a ``side`` (m), by Parseval.

    >>> x = np.arange(8) / 8
    >>> wave = np.cos(2 * np.pi * x)[:, None] * np.ones(8)
    >>> bool(np.isclose(spectral_rms_gradient(wave, 1.0), np.sqrt(2) * np.pi))
    True
    """
    M = len(heights)
    q = 2 * np.pi * np.fft.fftfreq(M, side / M)
    spectrum = np.abs(np.fft.fft2(heights) / M**2) ** 2
    return float(np.sqrt(np.sum((q[:, None] ** 2 + q[None, :] ** 2) * spectrum)))
