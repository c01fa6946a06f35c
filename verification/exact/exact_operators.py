"""Influence matrices of the unit grid in many digits, from the textbook formulas alone (mpmath).

Nothing is taken from `refimpl`: half-space coefficients are the corner sums of `exact.kernel_reference`,
periodic ones the sum of the Fourier modes; slopes are central differences, one-sided at the border.
"""

from __future__ import annotations

from functools import cache
from itertools import product
from typing import Any

import mpmath as mp
import numpy as np

from verification.exact import kernel_reference

DIGITS = 34
"""Carried by the oracle: twice those of a double, so that a state's own digits stand out."""

Exact = Any
"""numpy object array of mpf, or one mpf; untyped in mpmath."""


@cache
def normal(M: int, periodic: bool) -> Exact:
    """Return ``I[1/rho]`` between all pairs of unit elements, ``(M^2, M^2)``; periodic: without mean."""
    if periodic:
        return _from_modes(M, "normal")
    return _pairs(M, lambda i, j: kernel_reference.normal(i, j, 1.0, 1.0))


@cache
def tangential(M: int, periodic: bool) -> tuple[Exact, Exact]:
    """Return ``I[x/rho^2]`` and ``I[y/rho^2]`` between all pairs of unit elements."""
    if periodic:
        return _from_modes(M, "x"), _from_modes(M, "y")
    return (
        _pairs(M, lambda i, j: kernel_reference.tangential(i, j, 1.0, 1.0)),
        _pairs(M, lambda i, j: kernel_reference.tangential(j, i, 1.0, 1.0)),
    )


def _pairs(M: int, value: Any) -> Exact:
    """Return the matrix over (field, source) of a function of their offset in elements."""
    table = {(i, j): value(float(i), float(j)) for i in range(1 - M, M) for j in range(1 - M, M)}
    matrix = np.empty((M * M, M * M), dtype=object)
    for n, m in np.ndindex(matrix.shape):
        matrix[n, m] = table[n // M - m // M, n % M - m % M]
    return matrix


def _from_modes(M: int, what: str) -> Exact:
    """Sum over modes of ``2 pi/q`` (normal) or ``2 pi q_s/q^2 sin`` (x, y), without mean and odd Nyquist."""
    with mp.workdps(DIGITS + 10):
        turn = [(mp.cospi(mp.mpf(2 * k) / M), mp.sinpi(mp.mpf(2 * k) / M)) for k in range(M)]
        modes = [(p, r) for p, r in product(range(-(M // 2), (M + 1) // 2), repeat=2) if p or r]
        table = {
            (i, j): mp.fsum(_mode(p, r, turn[(p * i + r * j) % M], M, what) for p, r in modes) / mp.mpf(M * M)
            for i, j in np.ndindex(M, M)
        }
    return _pairs(M, lambda i, j: table[int(i) % M, int(j) % M])


def _mode(p: int, r: int, turn: tuple[Exact, Exact], M: int, what: str) -> Exact:
    """Return one mode's share at one offset; a real field has no sine at the Nyquist frequency."""
    squared = p * p + r * r
    if what == "normal":
        return M / mp.sqrt(squared) * turn[0]
    odd = p if what == "x" else r
    return mp.mpf(0) if 2 * odd == -M else mp.mpf(M * odd) / squared * turn[1]


def difference(M: int, axis: int, periodic: bool) -> Exact:
    """Return the matrix of central differences per element, one-sided at the border or wrapped."""
    matrix = np.full((M * M, M * M), mp.mpf(0), dtype=object)
    for i, j in np.ndindex(M, M):
        k = (i, j)[axis]
        low, high = (k - 1, k + 1) if periodic else (max(k - 1, 0), min(k + 1, M - 1))
        if M == 1:
            continue
        steps = mp.mpf(2 if periodic else high - low)
        for end, sign in ((high % M, 1), (low % M, -1)):
            other = (end, j) if axis == 0 else (i, end)
            matrix[i * M + j, other[0] * M + other[1]] += sign / steps
    return matrix
