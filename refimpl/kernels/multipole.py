"""Both integrals over a square element seen from afar: multipole expansions with exact moments.

From the centre of a unit square, at ``z = r exp(i phi)``,

    1/|z - zeta| = sum_n |zeta|^n P_n(cos gamma) / r^(n+1),      s/rho^2 = Re sum_n zeta^n / z^(n+1).

Means of ``|zeta|^n cos(m theta)`` over a square vanish unless n is even and m a multiple of 4. So Love's
kernel is a series in ``u = 1/r^2`` with polynomials of ``c = cos(4 phi)``, and Cerruti's one in ``u^2`` with
polynomials of ``p = cos^2(phi)``, times ``x u``. Moments fall at least by ``a^2 = 1/2``, the half diagonal
squared, from n to n + 2, and ``|P_n| <= 1``, ``|cos((4j+1) phi)| <= (4j+1) |cos(phi)|``: what a number of
terms lacks of the first one is less than a geometric series, and so is what that one lacks of the whole.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from functools import cache
from math import comb
from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from refimpl.kernels.quadrature import TRUNCATION

Array = NDArray[np.float64]
Coefficients = Sequence[float]
"""Of a polynomial, from its constant on."""

FAR = 8  # elements from which `MOST` terms suffice for both
MOST = 7


class Expansion(NamedTuple):
    """A kernel's series in unit elements, ``(x, y, terms)`` to values; ``lacking`` by ``(terms, u)``."""

    sum: Callable[[Array, Array, int], Array]
    lacking: Callable[[int, float], float]

    def remainder(self, terms: int, distance: float) -> float:
        """Bound of the relative error of a number of terms, ``distance`` elements away and farther."""
        u = distance**-2.0
        return self.lacking(terms, u) / (1 - self.lacking(1, u))

    def across(self, x: Array, y: Array, edge: float, distance: float) -> Array:
        """The integral over squares of that edge, from ``x, y >= 0`` in elements, one ``>= distance``."""
        return edge * self.sum(x, y, terms_from(self, distance))


@cache
def terms_from(expansion: Expansion, distance: float) -> int:
    """Fewest terms that suffice from ``distance >= FAR`` elements on."""
    return next(n for n in range(1, MOST + 1) if expansion.remainder(n, distance) <= TRUNCATION)


@cache
def moment(n: int, m: int = 0) -> Fraction:
    """Mean of ``|zeta|^n cos(m theta)`` over the unit square, ``n - m`` even: exact.

    >>> moment(2), moment(4, 4)
    (Fraction(1, 6), Fraction(-1, 60))
    """
    total = Fraction(0)
    for k in range((n - m) // 2 + 1):  # of (xi^2 + eta^2)^((n-m)/2) Re (xi + i eta)^m
        for j in range(0, m + 1, 2):
            share = comb((n - m) // 2, k) * comb(m, j) * (-1) ** (j // 2)
            total += share * _power(n - 2 * k - j) * _power(2 * k + j)
    return total


def _power(n: int) -> Fraction:
    """Mean of ``xi^n`` over the unit element, n even."""
    return Fraction(1, (n + 1) * 2**n)


@cache
def _of_love(k: int) -> Coefficients:
    """The polynomial of ``c`` at ``u^k``: ``P_2k(cos gamma)`` in cosines, each times its moment."""
    n = 2 * k
    cosines = [
        (2 if m else 1) * _central((n - m) // 2) * _central((n + m) // 2) * moment(n, m)
        for m in range(0, n + 1, 4)
    ]
    return tuple(float(value) for value in chebyshev.cheb2poly([float(share) for share in cosines]))


def _central(k: int) -> Fraction:
    """``(2k over k) / 4^k``: ``P_n(cos gamma)`` sums ``_central(k) _central(n-k) cos((n-2k) gamma)``."""
    return Fraction(comb(2 * k, k), 4**k)


@cache
def _of_cerruti(j: int) -> Coefficients:
    """The polynomial of ``p`` at ``u^(2j)``: the moment times ``cos((4j+1) phi) / cos(phi)``."""
    powers = chebyshev.cheb2poly([0] * (4 * j + 1) + [1])
    return tuple(float(moment(4 * j, 4 * j)) * float(value) for value in powers[1::2])


def _love(x: Array, y: Array, terms: int) -> Array:
    along, across = x * x, y * y
    u = 1 / (along + across)
    c = along * across
    c *= u
    c *= u
    c *= -8
    c += 1
    values = _nested(u, c, [_of_love(k) for k in range(terms)])
    values *= np.sqrt(u)
    return values


def _cerruti(x: Array, y: Array, terms: int) -> Array:
    along = x * x
    u = 1 / (along + y * y)
    values = _nested(u * u, along * u, [_of_cerruti(j) for j in range(terms)])
    values *= u
    values *= x
    return values


def _nested(u: Array, c: Array, polynomials: Sequence[Coefficients]) -> Array:
    """``sum_k u^k polynomials[k](c)``, the innermost first."""
    values = _polynomial(polynomials[-1], c)
    for coefficients in polynomials[-2::-1]:
        values *= u
        values += coefficients[0] if len(coefficients) == 1 else _polynomial(coefficients, c)
    return values


def _polynomial(coefficients: Coefficients, c: Array) -> Array:
    values = np.full_like(c, coefficients[-1])
    for coefficient in coefficients[-2::-1]:
        values *= c
        values += coefficient
    return values


def _love_lacks(terms: int, u: float) -> float:
    return float(moment(2 * terms)) * u**terms / (1 - u / 2)


def _cerruti_lacks(terms: int, u: float) -> float:
    return (4 * terms + 1) * float(moment(4 * terms)) * u ** (2 * terms) / (1 - 9 / 5 * (u / 2) ** 2)


LOVE = Expansion(_love, _love_lacks)
CERRUTI = Expansion(_cerruti, _cerruti_lacks)
