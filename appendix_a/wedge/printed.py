"""The paper's own integrals (A4)-(A9), evaluated as printed, so that what fails can be shown by numbers.

On the line z = i xi, with half the residue at z = 0, the kernels of ``reference`` turn into (A4)-(A9)
exactly, except

- (A5): its first term must be ``- pi cos(gamma) cos(theta) / (pi - 2 gamma + sin 2 gamma)``; the sign is
lost; - (A7)-(A9): ``cosh(pi/2 - gamma + theta) xi`` must read ``cosh{(pi/2 - gamma + theta) xi}``, ``sinh``
alike, in the
  denominators too. Read literally, xi cancels and the integrals diverge.
"""

from __future__ import annotations

from typing import Any

import mpmath as mp

PRINTED_SIGN, CORRECT_SIGN = 1, -1
"""Sign of the first term of (A5)."""


def kernels(xi: Any, theta: Any, gamma: Any) -> tuple[Any, Any, Any]:
    """P, Q, T of (A7)-(A9), xi inside the hyperbolic functions' arguments."""
    plus, minus = mp.pi / 2 - gamma + theta, mp.pi / 2 - gamma - theta
    below = xi * mp.sin(2 * gamma) + mp.sinh((mp.pi - 2 * gamma) * xi)
    p = mp.cos(gamma + theta) * mp.cosh(plus * xi) + mp.cos(gamma - theta) * mp.cosh(minus * xi)
    q = mp.sin(gamma + theta) * mp.sinh(plus * xi) + mp.sin(gamma - theta) * mp.sinh(minus * xi)
    t = mp.cos(gamma + theta) * mp.sinh(plus * xi) - mp.cos(gamma - theta) * mp.sinh(minus * xi)
    return p / below, q / below, t / below


def literal_p(xi: Any, theta: Any, gamma: Any) -> Any:
    """P of (A7) to the letter: every hyperbolic function multiplied by xi."""
    plus, minus = mp.pi / 2 - gamma + theta, mp.pi / 2 - gamma - theta
    above = mp.cos(gamma + theta) * mp.cosh(plus) * xi + mp.cos(gamma - theta) * mp.cosh(minus) * xi
    return above / (xi * mp.sin(2 * gamma) + mp.sinh(mp.pi - 2 * gamma) * xi)


def stresses(
    r: Any, theta: Any, gamma: Any, sign: int = PRINTED_SIGN, digits: int = 20
) -> tuple[tuple[Any, Any, Any], Any]:
    """((sigma_r, sigma_theta, tau), error estimate) by (A4)-(A6), a = 1, strictly between the faces.

    Panel quadrature (``mpmath.quad``) over 0 < xi < X, where the kernels have fallen to 10^-digits.
    """
    with mp.workdps(digits + 10):
        r, theta, gamma = mp.mpf(r), mp.mpf(theta), mp.mpf(gamma)
        phase = mp.log(1 / r)
        reach = mp.pi / 2 - gamma - abs(theta)
        width = 4 / (mp.pi / 2 - gamma + abs(phase))
        panels = mp.arange(0, digits * mp.log(10) / reach + width, width)
        radial = mp.pi * mp.cos(gamma) * mp.cos(theta) / (mp.pi - 2 * gamma + mp.sin(2 * gamma))

        def difference(xi: Any) -> Any:
            return -kernels(xi, theta, gamma)[0] * mp.sin(xi * phase)

        def total(xi: Any) -> Any:
            p, q, _ = kernels(xi, theta, gamma)
            return ((p - xi * q) * mp.sin(xi * phase) - (q + xi * p) * mp.cos(xi * phase)) / (1 + xi**2)

        def shear(xi: Any) -> Any:
            return kernels(xi, theta, gamma)[2] * mp.cos(xi * phase)

        (d, e1), (s, e2), (t, e3) = (mp.quad(f, panels, error=True) for f in (difference, total, shear))
        scale = 2 / (mp.pi * r)
        minus, plus = scale * (radial + d), scale * (sign * radial + s)
        return ((plus - minus) / 2, (plus + minus) / 2, scale * t / 2), scale * max(e1, e2, e3)
