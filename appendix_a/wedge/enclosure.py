"""Rigorous enclosures of the wedge stresses by ball arithmetic (python-flint; Johansson 2018).

On the line z = -1/2 + i xi the kernels are integrated from 0 to X by ``acb.integral``, which encloses the
integral. Beyond X, where ``|z| sin(2 alpha) <= sinh(2 alpha xi) / 2``, ``|D| >= sinh(2 alpha xi) / 2``;
with ``|sin((1 +- z) alpha)| <= exp(alpha xi)`` and alike for the cosines, and ``|3 + z| <= 4 |1 + z|``,
every kernel is below ``5 x 2 x 2.1 exp(-(alpha - |theta|) xi)``, and the tail is added as a ball. Interior
points only.
"""

from __future__ import annotations

import math
from typing import Any

TAIL = 32.0
"""The factor 21 of the tail's bound, rounded up."""
TAIL_EXPONENT = 50.0
"""exp(-50) = 2e-22 sets the radius of the enclosures."""


def stresses(r: float, theta: float, gamma: float, bits: int = 96) -> tuple[Any, Any, Any]:
    """Return enclosures (``arb``) of (sigma_r, sigma_theta, tau), unit pressure on 0 < r < 1.

    The doubles r, theta, gamma are taken as exact. Raises ImportError without python-flint.
    """
    import flint

    precision, flint.ctx.prec = flint.ctx.prec, bits
    try:
        return _enclose(flint, flint.arb(r), flint.arb(theta), flint.arb(gamma))
    finally:
        flint.ctx.prec = precision


def _enclose(flint: Any, r: Any, theta: Any, gamma: Any) -> tuple[Any, Any, Any]:
    arb, acb = flint.arb, flint.acb
    alpha, log_r = arb.pi() / 2 - gamma, r.log()
    end = _tail_start(arb, alpha, theta)

    def integrand(component: int, xi: Any) -> Any:
        z = acb(0, 1) * xi - acb(0.5)
        d = (2 * alpha * z).sin() + z * (2 * alpha).sin()
        plus, minus = ((1 + z) * alpha).sin(), ((1 - z) * alpha).sin()
        a, b = (1 + z) * plus * ((1 - z) * theta).cos(), minus * ((1 + z) * theta).cos()
        shear = minus * ((1 + z) * theta).sin() - plus * ((1 - z) * theta).sin()
        kernel = ((a + (3 + z) * b) / (1 + z), ((1 - z) * b - a) / (1 + z), shear)[component]
        return kernel / d * (-(1 + z) * log_r).exp()

    reach = alpha - abs(theta)
    radius = TAIL * (-reach * end).exp() / reach / r.sqrt() / arb.pi()
    ball = arb(0, radius.upper())
    parts = []
    for component in range(3):
        whole = acb.integral(lambda xi, _, c=component: integrand(c, xi), acb(0), acb(end))
        parts.append(whole.real / arb.pi() + ball)
    return parts[0], parts[1], parts[2]


def _tail_start(arb: Any, alpha: Any, theta: Any) -> Any:
    """Return an X beyond which the tail's bound holds (checked) and is below exp(-TAIL_EXPONENT)."""
    reach = float(alpha - abs(theta))
    end = arb(math.ceil(TAIL_EXPONENT / reach))
    # |z| <= xi + 1/2, and sinh(2 alpha xi)/(xi + 1/2) grows with xi, so the condition at X holds beyond it
    if not (end + 0.5) * (2 * alpha).sin() <= (2 * alpha * end).sinh() / 2:
        raise ArithmeticError(f"tail bound does not hold from xi = {end}")
    return end
