"""Digits lost in float32, float64, long double and mpmath (30 digits), with cause and cure.

Each quantity is one formula evaluated in each arithmetic on inputs that all of them hold exactly, against the
same formula, or a better one, in 80 digits. Lost is what the arithmetic carries less what the result keeps.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import mpmath as mp
import numpy as np
import scipy.fft as sfft

from refimpl.kernels.cerruti import CERRUTI
from refimpl.kernels.love import LOVE
from verification.exact import kernel_reference
from verification.extremes.oracle import eliminated

REFERENCE_DIGITS, MP_DIGITS = 80, 30


@dataclass(frozen=True)
class Arithmetic:
    """A number type with its elementary functions; ``carried`` decimal digits."""

    name: str
    carried: float
    number: Callable[[Any], Any]
    dtype: Any  # type of numpy, None for mpmath

    def __getattr__(self, name: str) -> Any:
        """An elementary function by numpy's name, of this arithmetic."""
        if name.startswith("__"):
            raise AttributeError(name)
        return (
            getattr(np, name)
            if self.dtype is not None
            else getattr(mp, {"arctan": "atan", "arcsinh": "asinh"}.get(name, name))
        )


def arithmetics() -> tuple[Arithmetic, ...]:
    """Arithmetics of this machine: where long double is double, without additional digits."""
    floats = ((np.float32, "float32"), (np.float64, "float64"), (np.longdouble, "long double"))
    found = [Arithmetic(name, -np.log10(float(np.finfo(t).eps)), t, t) for t, name in floats]
    return (*found, Arithmetic(f"mpmath, {MP_DIGITS}", float(MP_DIGITS), mp.mpf, None))


@dataclass(frozen=True)
class Quantity:
    """A formula: ``value(arithmetic)`` and ``exact()`` give series of numbers; errors relative to the largest
    (``each``: to their own size). ``cure`` names what this code does instead, "" where it does that."""

    name: str
    value: Callable[[Arithmetic], Any]
    exact: Callable[[], Any]
    cause: str
    cure: str
    each: bool = True


def _textbook_normal(offset: float) -> Callable[[Arithmetic], Any]:
    def value(a: Arithmetic) -> Any:
        def corner(X: Any, Y: Any) -> Any:
            return X * a.arcsinh(Y / abs(X)) + Y * a.arcsinh(X / abs(Y))

        return [_corners(a, corner, x, y) for x, y in around(offset)]

    return value


def _textbook_tangential(offset: float) -> Callable[[Arithmetic], Any]:
    def value(a: Arithmetic) -> Any:
        def corner(X: Any, Y: Any) -> Any:
            return Y * a.log(X * X + Y * Y) / 2 + X * a.arctan(Y / X)

        return [_corners(a, corner, x, y) for x, y in around(offset)]

    return value


def around(offset: float) -> list[tuple[float, float]]:
    """Points ``(x, y)`` in elements near an offset, exact in every arithmetic: one alone may be lucky."""
    shifts = [k / 16 for k in range(1, 8)] if offset >= 1 else [k * offset / 8 for k in range(1, 8)]
    return [(offset + shift, y) for shift in shifts for y in (0.25, 0.3125)]


def _corners(a: Arithmetic, corner: Callable[[Any, Any], Any], x0: float, y0: float) -> Any:
    x, y, half = a.number(x0), a.number(y0), a.number(0.5)
    return (corner(x + half, y + half) - corner(x + half, y - half)) - (
        corner(x - half, y + half) - corner(x - half, y - half)
    )


def _own_form(kernel: Any, offset: float) -> Callable[[Arithmetic], Any]:
    """This code's form in a numpy type: closed near the element, quadrature over strips (9 points) away."""

    def value(a: Arithmetic) -> Any:
        if a.dtype is None:
            return None
        x, y = (np.array(values, dtype=a.dtype) for values in zip(*around(offset), strict=True))
        one = a.dtype(1.0)
        if offset < 3:
            return list(kernel.closed_form(x, y, one, one))
        nodes, weights = (v.astype(a.dtype) for v in np.polynomial.legendre.leggauss(9))
        if a.dtype is np.longdouble:  # double's nodes would cap what a long double can show
            nodes, weights = _nodes(9)
        half = a.dtype(0.5)
        return list(
            half * sum(w * kernel.over_x(x + half * z, y, one) for z, w in zip(nodes, weights, strict=True))
        )

    return value


def _nodes(order: int) -> tuple[Any, Any]:
    """Gauss-Legendre nodes and weights in long double, by Newton's method in 40 digits."""
    with mp.workdps(40):
        nodes = [
            mp.findroot(lambda z: mp.legendre(order, z), float(z0))
            for z0 in np.polynomial.legendre.leggauss(order)[0]
        ]
        weights = [2 * (1 - z * z) / (order * mp.legendre(order - 1, z)) ** 2 for z in nodes]
        texts = ([mp.nstr(v, 30) for v in values] for values in (nodes, weights))
    first, second = (np.array([np.longdouble(t) for t in series]) for series in texts)
    return first, second


def _kernel_exact(exact: Callable[..., Any], offset: float) -> Callable[[], Any]:
    return lambda: [exact(x, y, 1.0, 1.0) for x, y in around(offset)]


HEIGHTS = [float(np.float32(v)) for v in np.random.default_rng(6).standard_normal(8)]
FAR = float(2**20)
MANY = [float(np.float32(v)) for v in np.random.default_rng(8).random(4096)]
CLOSE = [float(np.float32(v)) for v in np.random.default_rng(9).standard_normal(64)]


def _offset_gap(a: Arithmetic) -> Any:
    far = [a.number(h) + a.number(FAR) for h in HEIGHTS]
    return [f - min(far) for f in far]


def _far_slope(a: Arithmetic) -> Any:
    far = [a.number(h) + a.number(FAR) for h in HEIGHTS]
    return [(far[k + 1] - far[k - 1]) / a.number(2) for k in range(1, len(far) - 1)]


def _running_sum(a: Arithmetic) -> Any:
    total = a.number(0)
    for value in MANY:
        total = total + a.number(value)
    return [total]


def _pairwise_sum(a: Arithmetic) -> Any:
    return None if a.dtype is None else [np.sum(np.array(MANY, dtype=a.dtype))]


def _cosine_less_one(a: Arithmetic) -> Any:
    t = a.number(2.0**-10)
    return [1 - 1 / a.sqrt(1 + t * t)]


def _vanishing_gap(a: Arithmetic) -> Any:
    """``v - min v`` where displacement and gap nearly cancel: u = 1 + tiny."""
    u = [a.number(1) + a.number(h) * a.number(2.0**-20) for h in HEIGHTS]
    return [value - min(u) for value in u]


def _convolution(a: Arithmetic) -> Any:
    if a.dtype is None:
        return None
    source, kernel = (
        np.array(CLOSE, dtype=a.dtype),
        (1 / (1 + np.arange(64))).astype(np.float32).astype(a.dtype),
    )
    return list(sfft.irfft(sfft.rfft(source, 128) * sfft.rfft(kernel, 128), 128)[:64])


def _convolution_exact() -> Any:
    kernel = [float(np.float32(1 / (1 + k))) for k in range(64)]
    return [mp.fsum(mp.mpf(CLOSE[k]) * kernel[n - k] for k in range(n + 1)) for n in range(64)]


def _linear_solve(a: Arithmetic) -> Any:
    n = 24
    matrix = np.array(
        [[a.number(float(np.float32(1 / (1 + abs(i - j))))) for j in range(n)] for i in range(n)],
        dtype=object,
    )
    return list(eliminated(matrix, np.array([a.number(v) for v in CLOSE[:n]], dtype=object)))


def _in_many_digits(value: Callable[[Arithmetic], Any]) -> Callable[[], Any]:
    return lambda: value(Arithmetic("exact", REFERENCE_DIGITS, mp.mpf, None))


def quantities() -> tuple[Quantity, ...]:
    """All that the heat map shows, in the order of a solve."""
    cancels = "corner terms grow with distance while their second difference decays: n^2 eps"
    strips = "strips with log1p near, quadrature far"
    found = []
    for offset in (1.0, 64.0, 4096.0, 262144.0):
        at = f"at {offset:g} elements"
        for name, textbook, own, exact in (
            ("normal kernel", _textbook_normal, LOVE, kernel_reference.normal),
            ("tangential kernel", _textbook_tangential, CERRUTI, kernel_reference.tangential),
        ):
            known = _kernel_exact(exact, offset)
            found.append(Quantity(f"{name}, textbook, {at}", textbook(offset), known, cancels, strips))
            found.append(Quantity(f"{name}, this code, {at}", _own_form(own, offset), known, "none", ""))
    close = 2.0**-30
    known = _kernel_exact(kernel_reference.tangential, close)
    found += [
        Quantity("tangential kernel, textbook, at x = 1e-9", _textbook_tangential(close), known,
                 "odd in x: even parts of the corner terms cancel", "differences of angles first"),
        Quantity("tangential kernel, this code, at x = 1e-9", _own_form(CERRUTI, close), known, "none", ""),
        Quantity("gap of heights 1e6 ranges away", _offset_gap, _in_many_digits(_offset_gap),
                 "the data's own digits: the offset takes 20 bits", "none possible", False),
        Quantity("slope of heights 1e6 ranges away", _far_slope, _in_many_digits(_far_slope),
                 "the data's own digits", "as above", False),
        Quantity("convolution by FFT, largest error", _convolution, _convolution_exact,
                 "log2 n butterflies: relative to the largest", "none needed", False),
        Quantity("convolution by FFT, each value", _convolution, _convolution_exact,
                 "small values carry the rounding of the largest", "dense solver where that matters"),
        Quantity("linear solve, 24 unknowns", _linear_solve, _in_many_digits(_linear_solve),
                 "condition number of the flexibility", "CG works on the residual", False),
        Quantity("sum of 4096 pressures, one by one", _running_sum, lambda: [mp.fsum(MANY)],
                 "n eps", "numpy sums pairwise"),
        Quantity("sum of 4096 pressures, pairwise", _pairwise_sum, lambda: [mp.fsum(MANY)], "none", ""),
        Quantity("1 - cos(theta) at slope 1e-3", _cosine_less_one, _in_many_digits(_cosine_less_one),
                 "second order in the slope, below eps at 1e-8", "forces use the cosine itself"),
        Quantity("v - min v where u differs by 1e-6", _vanishing_gap, _in_many_digits(_vanishing_gap),
                 "contact is where v is constant", "none: the certificate's floor", False),
    ]  # fmt: skip
    return tuple(found)


def lost(quantity: Quantity, arithmetic: Arithmetic) -> float | None:
    """Digits lost; None where the arithmetic has no such implementation."""
    with mp.workdps(MP_DIGITS), np.errstate(all="ignore"):
        found = quantity.value(arithmetic)
    if found is None:
        return None
    with mp.workdps(REFERENCE_DIGITS):
        exact = [mp.mpf(v) for v in quantity.exact()]
        values = [_as_mpf(v) for v in found]
        scale = max(abs(e) for e in exact)
        errors = [
            abs(v - e) / (abs(e) if quantity.each and e else scale)
            for v, e in zip(values, exact, strict=True)
        ]
        worst = max(errors)
        kept = arithmetic.carried if worst == 0 else min(float(-mp.log10(worst)), arithmetic.carried)
    return arithmetic.carried - max(kept, 0.0)


def _as_mpf(value: Any) -> Any:
    """Exactly: a long double splits into two doubles."""
    if isinstance(value, mp.mpf):
        return value
    high = float(value)
    return mp.mpf(high) + mp.mpf(float(value - type(value)(high)))


def table() -> dict[str, object]:
    """The heat map: rows of digits lost, and for each quantity its cause and cure."""
    kinds = arithmetics()
    rows = {q.name: [lost(q, kind) for kind in kinds] for q in quantities()}
    return {
        "arithmetic": [kind.name for kind in kinds],
        "digits carried": [kind.carried for kind in kinds],
        "digits lost": rows,
        "cause": {q.name: q.cause for q in quantities()},
        "cure": {q.name: q.cure for q in quantities()},
    }
