"""Wedge stresses as sums of residues: a series in powers of r for r < 1, and one in 1/r for r > 1.

The poles are z = -1 (uniform pressure), z = 0 (the radial field of the resultant) and the zeros of ``D =
sin(2 alpha z) + z sin(2 alpha)``, that is ``+-w / (2 alpha)`` with ``sin w = -k w``, ``k = sin(2 alpha)/(2
alpha)``: one pair in each interval ((2n-1) pi, 2n pi), real for small k and complex otherwise (Williams
1952).
"""

from __future__ import annotations

from typing import Any

import mpmath as mp

from appendix_a.wedge.reference import GUARD


def wedge_zeros(gamma: Any, n: int) -> list[Any]:
    """Return the n-th pair of roots w of sin w = -k w; of a complex pair the one above the real axis."""
    alpha = mp.pi / 2 - mp.mpf(gamma)
    k = mp.sin(2 * alpha) / (2 * alpha)
    low, high = (2 * n - 1) * mp.pi, 2 * n * mp.pi

    def equation(w: Any) -> Any:
        return mp.sin(w) + k * w

    middle = high - mp.pi / 2
    steepest = mp.findroot(lambda w: mp.sin(w) - w * mp.cos(w), middle - 1 / middle)
    if k * steepest + mp.sin(steepest) < 0:
        brackets = (low, steepest), (steepest, high)
        return [mp.findroot(equation, bracket, solver="anderson") for bracket in brackets]
    guess = steepest + 1j * mp.acosh(max(-k * steepest / mp.sin(steepest), mp.mpf("1.001")))
    return [mp.findroot(equation, guess)]


def stresses(r: Any, theta: Any, gamma: Any, digits: int = 30, pairs: int = 400) -> tuple[Any, Any, Any]:
    """Return (sigma_r, sigma_theta, tau) of unit pressure on 0 < r < 1 of both faces, gamma > 0, r != 1.

    Ends when a pair adds less than 10^-digits; raises ArithmeticError when ``pairs`` do not suffice.
    """
    with mp.workdps(digits + GUARD):
        r, theta, gamma = mp.mpf(r), mp.mpf(theta), mp.mpf(gamma)
        alpha = mp.pi / 2 - gamma
        inside = r < 1
        if inside:
            total = [mp.mpf(-1), mp.mpf(-1), mp.mpf(0)]
        else:
            radial = -4 * mp.sin(alpha) * mp.cos(theta) / ((2 * alpha + mp.sin(2 * alpha)) * r)
            total = [radial, mp.mpf(0), mp.mpf(0)]
        for n in range(1, pairs + 1):
            added = mp.mpf(0)
            for w in wedge_zeros(gamma, n):
                terms = _residues((-w if inside else w) / (2 * alpha), r, theta, alpha)
                weight = (1 if inside else -1) * (1 if mp.im(w) == 0 else 2)
                total = [t + weight * mp.re(f) for t, f in zip(total, terms, strict=True)]
                added = max(added, *(abs(f) for f in terms))
            if added < mp.mpf(10) ** -digits:
                return total[0], total[1], total[2]
    raise ArithmeticError(f"residue series at r = {r}: {pairs} pairs leave {mp.nstr(added, 3)}")


def _residues(z: Any, r: Any, theta: Any, alpha: Any) -> list[Any]:
    """Return the residues of the three integrands at a simple zero z of D: numerators over dD/dz."""
    slope = 2 * alpha * mp.cos(2 * alpha * z) + mp.sin(2 * alpha)
    plus, minus = mp.sin((1 + z) * alpha), mp.sin((1 - z) * alpha)
    even, odd = mp.cos((1 - z) * theta), mp.cos((1 + z) * theta)
    weight = r ** (-1 - z) / slope
    return [
        weight * (plus * even + (3 + z) / (1 + z) * minus * odd),
        -weight * (plus * even - (1 - z) / (1 + z) * minus * odd),
        weight * (minus * mp.sin((1 + z) * theta) - plus * mp.sin((1 - z) * theta)),
    ]
