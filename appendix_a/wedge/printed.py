"""The paper's own integrals (A4)-(A9), evaluated as printed, so that what fails can be shown by numbers.

On the line z = i xi, with half the residue at z = 0, the kernels of ``reference`` turn into (A4)-(A9)
exactly, except

- (A5): its first term must be ``- pi cos(gamma) cos(theta) / (pi - 2 gamma + sin 2 gamma)``; the sign is
lost; - (A7)-(A9): ``cosh(pi/2 - gamma + theta) xi`` must read ``cosh{(pi/2 - gamma + theta) xi}``, ``sinh``
alike, in the
  denominators too. Read literally, xi cancels and the integrals diverge.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Real = NDArray[np.float64]

PRINTED_SIGN, CORRECT_SIGN = 1, -1
"""Sign of the first term of (A5)."""
NEGLIGIBLE = 45.0
"""The integrals end where the kernels have fallen to exp(-45) = 3e-20."""
GAUSS = np.polynomial.legendre.leggauss(20)


@dataclass(frozen=True)
class Printed:
    """Stresses by (A4)-(A6) in units of the pressure, and their change on halving the panels."""

    sigma_r: float
    sigma_theta: float
    tau: float
    error: float


def kernels(xi: Real, theta: float, gamma: float) -> tuple[Real, Real, Real]:
    """Return P, Q, T of (A7)-(A9), xi > 0 inside the hyperbolic functions' arguments.

    Numerators and denominator are scaled by ``2 exp(-(pi - 2 gamma) xi)``, which keeps them finite.
    """
    plus, minus, all_ = np.pi / 2 - gamma + theta, np.pi / 2 - gamma - theta, np.pi - 2 * gamma
    fall_plus, fall_minus = np.exp(-minus * xi), np.exp(-plus * xi)
    back_plus, back_minus = np.exp(-(all_ + plus) * xi), np.exp(-(all_ + minus) * xi)
    below = 2 * xi * np.sin(2 * gamma) * np.exp(-all_ * xi) - np.expm1(-2 * all_ * xi)
    cos_plus, cos_minus = np.cos(gamma + theta), np.cos(gamma - theta)
    sin_plus, sin_minus = np.sin(gamma + theta), np.sin(gamma - theta)
    p = cos_plus * (fall_plus + back_plus) + cos_minus * (fall_minus + back_minus)
    q = sin_plus * (fall_plus - back_plus) + sin_minus * (fall_minus - back_minus)
    t = cos_plus * (fall_plus - back_plus) - cos_minus * (fall_minus - back_minus)
    return p / below, q / below, t / below


def literal_p(xi: float, theta: float, gamma: float) -> float:
    """Return P of (A7) to the letter: every hyperbolic function multiplied by xi."""
    plus, minus = np.pi / 2 - gamma + theta, np.pi / 2 - gamma - theta
    above = np.cos(gamma + theta) * np.cosh(plus) * xi + np.cos(gamma - theta) * np.cosh(minus) * xi
    return float(above / (xi * np.sin(2 * gamma) + np.sinh(np.pi - 2 * gamma) * xi))


def stresses(r: float, theta: float, gamma: float, sign: int = PRINTED_SIGN) -> Printed:
    """Return (A4)-(A6) with a = 1, strictly between the faces; ``sign`` is that of the first term of (A5)."""
    coarse, fine = (_integrals(r, theta, gamma, width) for width in (1.0, 0.5))
    difference, total, shear = fine
    radial = np.pi * np.cos(gamma) * np.cos(theta) / (np.pi - 2 * gamma + np.sin(2 * gamma))
    scale = 2 / (np.pi * r)
    minus, plus = scale * (radial + difference), scale * (sign * radial + total)
    error = scale * float(np.max(np.abs(np.subtract(fine, coarse))))
    return Printed((plus - minus) / 2, (plus + minus) / 2, scale * shear / 2, error)


def _integrals(r: float, theta: float, gamma: float, width: float) -> tuple[float, float, float]:
    """Return the integrals of (A4), (A5), (A6); panels of ``width`` times the shortest scale."""
    phase, alpha = np.log(1 / r), np.pi / 2 - gamma
    end = NEGLIGIBLE / (alpha - abs(theta))
    panels = int(np.ceil(end * (1 + alpha + abs(phase)) / (4 * width)))
    edges = np.linspace(0, end, panels + 1)
    middle, half = (edges[1:] + edges[:-1])[:, None] / 2, np.diff(edges)[:, None] / 2
    xi, weights = middle + half * GAUSS[0], half * GAUSS[1]
    p, q, t = kernels(xi, theta, gamma)
    sin, cos = np.sin(xi * phase), np.cos(xi * phase)
    total = ((p - xi * q) * sin - (q + xi * p) * cos) / (1 + xi**2)
    return float(-np.sum(weights * p * sin)), float(np.sum(weights * total)), float(np.sum(weights * t * cos))
