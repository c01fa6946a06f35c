"""Decimal digits that the kernels lose in float32, float64, long double and mpmath (30 digits).

Textbook forms and this code's forms are evaluated in each arithmetic on inputs that all of them hold exactly,
and compared with 80 digits. Digits lost: those that the arithmetic carries less those that the result keeps.
"""

from __future__ import annotations

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any, NamedTuple

import mpmath as mp
import numpy as np

from refimpl.kernels.cerruti import CERRUTI
from refimpl.kernels.love import LOVE
from verification.exact import kernel_reference

REFERENCE_DIGITS, MP_DIGITS = 80, 30
ORDER = 9  # Gauss-Legendre nodes over a strip, as in the kernels


class Arithmetic(NamedTuple):
    """A number type with ``carried`` decimal digits, and its elementary functions by numpy's names."""

    name: str
    carried: float
    number: Callable[[Any], Any]
    dtype: Any  # type of numpy, None for mpmath
    functions: Any


def arithmetics() -> tuple[Arithmetic, ...]:
    """Return the arithmetics of this machine: where long double is double, without additional digits."""
    floats = ((np.float32, "float32"), (np.float64, "float64"), (np.longdouble, "long double"))
    found = [Arithmetic(name, -np.log10(float(np.finfo(t).eps)), t, t, np) for t, name in floats]
    functions = SimpleNamespace(arcsinh=mp.asinh, arctan=mp.atan, log=mp.log)
    return (*found, Arithmetic(f"mpmath, {MP_DIGITS}", float(MP_DIGITS), mp.mpf, None, functions))


def _normal_corner(a: Arithmetic, X: Any, Y: Any) -> Any:
    return X * a.functions.arcsinh(Y / abs(X)) + Y * a.functions.arcsinh(X / abs(Y))


def _tangential_corner(a: Arithmetic, X: Any, Y: Any) -> Any:
    return Y * a.functions.log(X * X + Y * Y) / 2 + X * a.functions.arctan(Y / X)


NORMAL = ("normal kernel", _normal_corner, LOVE, kernel_reference.normal)
TANGENTIAL = ("tangential kernel", _tangential_corner, CERRUTI, kernel_reference.tangential)


def around(offset: float) -> list[tuple[float, float]]:
    """Return the points ``(x, y)`` in elements near an offset, exact in every arithmetic: one alone may be
    lucky."""
    shifts = [k / 16 for k in range(1, 8)] if offset >= 1 else [k * offset / 8 for k in range(1, 8)]
    return [(offset + shift, y) for shift in shifts for y in (0.25, 0.3125)]


def textbook_form(a: Arithmetic, corner: Callable[..., Any], offset: float) -> list[Any]:
    """Return the second difference of a kernel's corner terms at the points."""
    half = a.number(0.5)
    found = []
    for x0, y0 in around(offset):
        x, y = a.number(x0), a.number(y0)
        right = corner(a, x + half, y + half) - corner(a, x + half, y - half)
        left = corner(a, x - half, y + half) - corner(a, x - half, y - half)
        found.append(right - left)
    return found


def own_form(a: Arithmetic, kernel: Any, offset: float) -> list[Any] | None:
    """Return this code's form, of numpy types only: closed near the element, quadrature over strips away."""
    if a.dtype is None:
        return None
    x, y = (np.array(values, dtype=a.dtype) for values in zip(*around(offset), strict=True))
    one, half = a.dtype(1.0), a.dtype(0.5)
    if offset < 3:
        return list(kernel.closed_form(x, y, one, one))
    nodes, weights = (v.astype(a.dtype) for v in np.polynomial.legendre.leggauss(ORDER))
    if a.dtype is np.longdouble:  # double's nodes would cap what a long double can show
        nodes, weights = _nodes(ORDER)
    strips = (w * kernel.over_x(x + half * z, y, one) for z, w in zip(nodes, weights, strict=True))
    return list(half * sum(strips))


def _nodes(order: int) -> tuple[Any, Any]:
    """Return the Gauss-Legendre nodes and weights in long double, by Newton's method in 40 digits."""
    with mp.workdps(40):
        nodes = [
            mp.findroot(lambda z: mp.legendre(order, z), float(z0))
            for z0 in np.polynomial.legendre.leggauss(order)[0]
        ]
        weights = [2 * (1 - z * z) / (order * mp.legendre(order - 1, z)) ** 2 for z in nodes]
        texts = ([mp.nstr(v, 30) for v in values] for values in (nodes, weights))
    first, second = (np.array([np.longdouble(t) for t in series]) for series in texts)
    return first, second


def lost(arithmetic: Arithmetic, found: list[Any] | None, exact: list[Any]) -> float | None:
    """Return the digits lost by the worst value; None where the arithmetic has no such implementation."""
    if found is None:
        return None
    with mp.workdps(REFERENCE_DIGITS):
        worst = max(abs(_as_mpf(v) - mp.mpf(e)) / abs(mp.mpf(e)) for v, e in zip(found, exact, strict=True))
        kept = arithmetic.carried if worst == 0 else min(float(-mp.log10(worst)), arithmetic.carried)
    return arithmetic.carried - max(kept, 0.0)


def _as_mpf(value: Any) -> Any:
    """Convert exactly: a long double splits into two doubles."""
    if isinstance(value, mp.mpf):
        return value
    high = float(value)
    return mp.mpf(high) + mp.mpf(float(value - type(value)(high)))


CANCELS = "corner terms grow with distance while their second difference decays: n^2 eps"
ODD = "odd in x: even parts of the corner terms cancel"
PLACES = (
    *(
        (n, (NORMAL, TANGENTIAL), f"at {n:g} elements", CANCELS, "strips with log1p near, quadrature far")
        for n in (1.0, 64.0, 4096.0, 262144.0)
    ),
    (2.0**-30, (TANGENTIAL,), "at x = 1e-9", ODD, "differences of angles first"),
)
"""Offset, kernels, its name, why the textbook form loses digits, and what this code does instead."""


def table() -> dict[str, Any]:
    """Return the heat map: rows of digits lost, and for each quantity its cause and cure."""
    kinds = arithmetics()
    digits: dict[str, list[float | None]] = {}
    causes: dict[str, str] = {}
    cures: dict[str, str] = {}
    for offset, kernels, at, cause, cure in PLACES:
        for name, corner, own, reference in kernels:
            exact = [reference(x, y, 1.0, 1.0) for x, y in around(offset)]
            with mp.workdps(MP_DIGITS), np.errstate(all="ignore"):
                by_textbook = [textbook_form(a, corner, offset) for a in kinds]
                by_own_form = [own_form(a, own, offset) for a in kinds]
            for form, found, why, instead in (
                ("textbook", by_textbook, cause, cure),
                ("this code", by_own_form, "none", ""),
            ):
                row = f"{name}, {form}, {at}"
                digits[row] = [lost(a, values, exact) for a, values in zip(kinds, found, strict=True)]
                causes[row], cures[row] = why, instead
    return {
        "arithmetic": [kind.name for kind in kinds],
        "digits carried": [kind.carried for kind in kinds],
        "digits lost": digits,
        "cause": causes,
        "cure": cures,
    }
