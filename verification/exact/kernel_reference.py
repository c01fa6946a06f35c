"""Reference values of the two influence integrals, by three ways independent of production and each other.

- ``normal``, ``tangential``: the textbook corner sums, in as many digits as their cancellation asks for
  (mpmath);
- ``normal_by_transform``, ``tangential_by_transform``: no antiderivative at all. With
  ``1/rho = 2/sqrt(pi) int exp(-rho^2 u^2) du`` and ``1/rho^2 = int 2u exp(-rho^2 u^2) du`` the rectangle
  separates into error functions and exponentials, and the trapezoidal rule in log u is left to do;
- ``normal_enclosure``, ``tangential_enclosure``: balls that contain the exact value (Arb). The
  normal one integrates the distance to the boundary over the angle; the tangential one sums ``Im z log z``.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import mpmath as mp
import numpy as np

from verification.framework.case import Unavailable

Corner = Callable[[Any, Any], Any]

DIGITS = 50
CORNERS = ((1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1))
"""Sign of X's shift, of Y's shift, of the term."""


def normal(x: float, y: float, dx: float, dy: float) -> Any:
    """Return I[1/rho] to 50 digits (an mpf); arguments of ``refimpl.kernels.normal_integral``.

    >>> with mp.workdps(DIGITS):
    ...     mp.almosteq(normal(0.0, 0.0, 1.0, 1.0), 4 * mp.asinh(1))
    True
    """
    return _corner_sum(_love, x, y, dx, dy)


def tangential(x: float, y: float, dx: float, dy: float) -> Any:
    """Return I[s/rho^2] to 50 digits (an mpf); as ``refimpl.kernels.tangential_integral``."""
    return mp.mpf(0) if x == 0 else _corner_sum(_cerruti, x, y, dx, dy)


def _love(X: Any, Y: Any) -> Any:
    return (X * mp.asinh(Y / abs(X)) if X else 0) + (Y * mp.asinh(X / abs(Y)) if Y else 0)


def _cerruti(X: Any, Y: Any) -> Any:
    return (Y * mp.log(X * X + Y * Y) / 2 if Y else 0) + (X * mp.atan(Y / X) if X else 0)


def _corner_sum(corner: Corner, x: float, y: float, dx: float, dy: float) -> Any:
    """Sum over corners, precision doubled until ``DIGITS`` survive the cancellation; not for a zero sum."""
    digits = 2 * DIGITS
    while True:
        with mp.workdps(digits):
            X, Y, a, b = mp.mpf(x), mp.mpf(y), mp.mpf(dx) / 2, mp.mpf(dy) / 2
            terms = [sign * corner(X + i * a, Y + j * b) for i, j, sign in CORNERS]
            total = mp.fsum(terms)
            if abs(total) > max(map(abs, terms)) * mp.mpf(10) ** (DIGITS + 2 - digits):
                return total
        digits *= 2


def normal_by_transform(x: float, y: float, dx: float, dy: float, digits: int = 20) -> Any:
    """Return the integral of 1/rho from error functions alone, to about that many digits (an mpf)."""

    def integrand(u: Any) -> Any:
        return 2 / mp.sqrt(mp.pi) * _gauss_factor(u, x, dx) * _gauss_factor(u, y, dy)

    return _over_the_half_line(integrand, x, y, dx, dy, digits)


def tangential_by_transform(x: float, y: float, dx: float, dy: float, digits: int = 20) -> Any:
    """Return I[s/rho^2], ``x > 0``, by exponentials and an error function; 50 digits."""

    def integrand(u: Any) -> Any:
        near = mp.mpf(x) - mp.mpf(dx) / 2
        # 2u times the integral of s exp(-s^2 u^2) over s, whose ends differ by 2 x dx in their squares.
        odd = -mp.exp(-((u * near) ** 2)) * mp.expm1(-2 * u**2 * mp.mpf(x) * mp.mpf(dx)) / u
        return odd * _gauss_factor(u, y, dy)

    return _over_the_half_line(integrand, x, y, dx, dy, digits)


def _gauss_factor(u: Any, offset: float, edge: float) -> Any:
    """Return the integral of exp(-s^2 u^2) over one edge, seen from ``offset``."""
    near, far = abs(mp.mpf(offset)) - mp.mpf(edge) / 2, abs(mp.mpf(offset)) + mp.mpf(edge) / 2
    ends = mp.erf(u * far) - mp.erf(u * near) if near < 0 else mp.erfc(u * near) - mp.erfc(u * far)
    return mp.sqrt(mp.pi) / (2 * u) * ends


def _over_the_half_line(
    integrand: Callable[[Any], Any], x: float, y: float, dx: float, dy: float, digits: int
) -> Any:
    """Return the integral over u > 0 by the trapezoidal rule in log u.

    Analytic for ``|Im log u| < pi/4``, hence an error like exp(-pi^2 / 2h). The tails left out, below
    ``dx dy u`` and above ``pi / u``, are small against ``dx dy / extent`` and against the offset x.
    """
    extent = abs(x) + abs(y) + dx + dy
    guard = int(np.log10(extent / min(dx, dy))) + 10  # loss of digits in differences of erfc, narrow element
    with mp.workdps(2 * (digits + guard)):
        tail = mp.mpf(10) ** (-digits) * (abs(x) / extent if x else 1)
        low, high = mp.log(tail / extent), mp.log(4 * extent / (mp.mpf(dx) * dy * tail))
        steps = int(mp.ceil((high - low) * 2 * digits * mp.log(10) / mp.pi**2))
        h = (high - low) / steps
        return h * mp.fsum(integrand(u) * u for u in (mp.exp(low + k * h) for k in range(steps + 1)))


def normal_enclosure(x: float, y: float, dx: float, dy: float) -> Any:
    """Return an arb that contains the integral of 1/rho, with a relative radius below 1e-20.

    From each corner the signed rectangle to the field point is, in polar coordinates about the latter, the
    integral of the distance ``X sec(theta)`` to its sides. Raises ``Unavailable`` without python-flint.
    """
    flint = arb()

    def secant_integral(angle: Any) -> Any:
        return flint.acb.integral(lambda theta, _: 1 / theta.cos(), 0, flint.acb(angle)).real

    def corner(X: Any, Y: Any) -> Any:
        if X == 0 or Y == 0:
            return flint.arb(0)
        along, across = (
            abs(X) * secant_integral((abs(Y / X)).atan()),
            abs(Y) * secant_integral((abs(X / Y)).atan()),
        )
        return (along + across) * X.sgn() * Y.sgn()

    return _enclose(corner, x, y, dx, dy)


def tangential_enclosure(x: float, y: float, dx: float, dy: float) -> Any:
    """Return an arb that contains the integral of s/rho^2, for ``x > 0``, with a relative radius below 1e-20.

    ``s/rho^2 = Re 1/z`` with ``z = s + it``, whose antiderivative over s and t is ``-i z (log z - 1)``. The
    branch cut is kept away by moving an end at ``s < 0`` to ``-s``, between which the integrand is odd.
    """
    flint = arb()

    def corner(X: Any, Y: Any) -> Any:
        z = flint.acb(abs(X), Y)
        return flint.arb(0) if z == 0 else (z * z.log()).imag

    return _enclose(corner, x, y, dx, dy)


def _enclose(corner: Corner, x: float, y: float, dx: float, dy: float) -> Any:
    """Run ball arithmetic over the corners, in doubled precision until the ball is small."""
    flint = arb()
    bits = 128
    while True:
        with flint.ctx.workprec(bits):
            X, Y, a, b = flint.arb(x), flint.arb(y), flint.arb(dx) / 2, flint.arb(dy) / 2
            total = flint.arb(0)
            for i, j, sign in CORNERS:
                total += sign * corner(X + i * a, Y + j * b)
            if total.rel_accuracy_bits() > 66:
                return total
        bits *= 2


def relative_error(value: float, exact: Any) -> float:
    """Return ``|value - exact| / |exact|`` in the reference's precision; an exact 0 is met exactly."""
    if exact == 0:
        return 0.0 if value == 0 else np.inf
    with mp.workdps(DIGITS):
        return float(abs(mp.mpf(float(value)) - exact) / abs(exact))


def relative_distance(value: float, ball: Any) -> float:
    """Return the upper bound on the relative error of ``value`` over the points of the ball."""
    flint = arb()
    with flint.ctx.workprec(256):
        error = abs((flint.arb(value) - ball) / ball)
        return float(error.upper())


def arb() -> Any:
    """Return python-flint. Raises ``Unavailable`` where it is not installed."""
    try:
        import flint
    except ImportError as missing:
        raise Unavailable("python-flint is not installed (extra 'rigorous')") from missing
    return flint
