"""The energy norm ``||e||^2 = e.a e`` on a grid: its least eigenvalue and its dual norm, both proven.

*Least eigenvalue, free half-space.* Between elements of edge h, ``a`` is ``compliance h g(i - j)`` with g the
integral of 1/rho over a unit square. As ``1/rho = 2/sqrt(pi) int_0^inf exp(-rho^2 t^2) dt``, it separates:

    e.a e = compliance h 2/sqrt(pi) int_0^inf dt mean over theta of S(theta_x, t) S(theta_y, t) |e^(theta)|^2,

with ``S(theta, t) = sum_j B_j(t) cos(j theta)`` and ``B_j(t)`` the integral of ``exp(-x^2 t^2)`` over element
j of a line. Claim: ``S(theta, t) >= S(pi, t) >= 0``. Hence ``a >= compliance h sum (-1)^(i+j) g(i, j)``, the
symbol at (pi, pi): `SMALLEST_SYMBOL`. A finite grid's ``a`` is a principal block of the lattice's, so the
bound holds for it too (and is approached from above: 1.8321 for M = 16, 1.8256 for M = 40).

For oblong elements each axis has its own ``B_j``, and the same claim holds for each: the bound is the
alternating sum of their own coefficients (`smallest_symbol`).

Proof of the claim. By Poisson's sum, with ``s = 1/(4 t^2)`` and ``k_n = theta + 2 pi n``,
``S = (sqrt(pi)/t) A``, ``A = sum_n (-1)^n 2 sin(theta/2) exp(-k_n^2 s) / k_n``, so that

    -dA/ds = 2 sin(z) sum_n (-1)^n k_n exp(-k_n^2 s) =: 2 h(z, s),   z = theta/2 in (0, pi/2],

and the sum is a positive multiple of ``-theta_2'(z)`` at the nome ``q = exp(-1/(4 s))``. Jacobi's product
shows ``theta_2`` to fall with z, so h >= 0, A falls with s, to its limit 0: A >= 0. The same products give

    h(z)/h(pi/2) = sin(z) * theta_2(z)/theta_1'(0) * (-theta_2'/theta_2)(z),
    theta_2(z)/theta_1'(0) = cos(z) prod (1 + 2 x (1 + cos 2z)/(1 - x)^2),
    -theta_2'/theta_2 = tan(z) + sum 4 x sin(2z)/(1 + 2 x cos 2z + x^2),         x = q^(2n), n = 1, 2, ...

each positive and rising with q. So ``d/ds [A(theta) - A(pi)] = 2 [h(pi/2) - h(z)]`` changes its sign at most
once, from + to -; and the difference is 0 at s = 0 and at infinity. Hence it is never negative.

*Least eigenvalue, periodic.* The symbol is ``2 pi compliance / q``, least in the corner of the band. The mean
pressure displaces nothing; under a load ``m K K'`` may be added to ``a`` (`refimpl.bounds.proven_bounds`).
"""

from __future__ import annotations

import math
from functools import cache

import numpy as np
import scipy

from refimpl.grid import Array, Grid, Mask
from refimpl.kernels import normal_integral
from refimpl.model.problem import Problem
from refimpl.operators.influence import window_influence
from refimpl.operators.preconditioner import SpectralPreconditioner

SMALLEST_SYMBOL = 1.8243012646
"""``sum (-1)^(i+j) g(i, j)`` over the lattice of squares, rounded down; a test encloses it."""

_ROUNDING = 2e-13
"""Relative error of a product in the 2-norm: 1e-13 of the coefficients (`refimpl.kernels`) and three
transforms of at most 2^26 points, each ``5 eps log2 n`` (Higham 2002, Theorem 24.2)."""
_ENOUGH = 0.01  # relative residual of CG; the rest is added as it is, so less saves nothing
_ITERATIONS = 200

_STEP = 1 / 8  # step of ln t in the integral for oblong elements: an error of exp(-(pi^2/2) / step) = 7e-18
_T: Array = np.exp(_STEP * np.arange(-18, 300))  # 0.105, below which S(pi, t) < 1e-96, to 2e16
_ODD = 2 * np.arange(64) + 1  # erfc(127 / 2 * 0.105) = 3e-21
_QUADRATURE = 1e-12  # relative error of the integral: sums of 300 positive numbers, each to a few eps


@cache
def smallest_symbol(aspect: float) -> float:
    """Return a lower bound of the symbol of elements ``1 x aspect`` at its corner, over their first edge.

    ``sum (-1)^(i+j) g(i, j)``, the symbol at (pi, pi). Square elements have `SMALLEST_SYMBOL`. For others it
    is ``2/sqrt(pi) int_0^inf S(pi, t) aspect S(pi, aspect t) dt``, with S of elements of edge 1, by the
    trapezoidal rule in ``ln t``. It rises with the aspect, to ``8 G / pi = 2.3325`` (Catalan's G).

    >>> round(smallest_symbol(1.0), 4), round(smallest_symbol(1e6), 4)
    (1.8243, 2.3325)
    """
    if aspect == 1.0:
        return SMALLEST_SYMBOL
    if aspect < 1:
        return aspect * smallest_symbol(1 / aspect)
    integrand = _alternating(_T) * aspect * _alternating(aspect * _T) * _T
    return float((1 - _QUADRATURE) * 2 / math.sqrt(math.pi) * _STEP * np.sum(integrand))


def _alternating(t: Array) -> Array:
    """Return ``S(pi, t) = sum_j (-1)^j B_j(t) = sqrt(pi)/t (1 - 2 sum_m (-1)^m erfc((m + 1/2) t))``."""
    signs = np.where(_ODD % 4 == 1, 1.0, -1.0)
    return np.asarray(math.sqrt(math.pi) / t * (1 - 2 * scipy.special.erfc(0.5 * np.outer(t, _ODD)) @ signs))


class EnergyNorm:
    """``a`` on the whole grid of a problem, plus ``lift K K'`` where the scene is periodic.

    ``floor`` is a lower bound of the smallest eigenvalue, ``diagonal`` the first diagonal entry (m/Pa): no
    ``a_ii`` is larger, as all are alike and the lift only adds to it.
    """

    def __init__(self, problem: Problem, K: Array) -> None:
        grid, self._K, self._elasticity = problem.grid, K, problem.elasticity
        self.operator = window_influence(grid, problem.direction)
        displaced = self.operator.displaces_mean
        self.lift = 0.0 if displaced else self._elasticity.mean_compliance(grid) / K.size
        # sums of |I| over all offsets are at most that of 1/rho over a rectangle of twice the lengths
        reach = normal_integral(np.zeros(1), np.zeros(1), 2 * grid.lengths[0], 2 * grid.lengths[1])
        self._reach = float(self._elasticity.symbol(reach)[0]) + self.lift * float(np.vdot(K, K))
        corner = np.array([smallest_symbol(grid.aspect) * grid.spacings[0]])
        self.floor = float(self._elasticity.symbol(corner)[0]) if displaced else self._periodic_floor(grid)
        self._precondition = SpectralPreconditioner(
            self.operator, self._elasticity.symbol(self.operator.symbol)
        )
        impulse = np.zeros(K.shape)
        impulse[0, 0] = 1.0
        self.diagonal = float(self.apply(impulse)[0, 0])

    def _periodic_floor(self, grid: Grid) -> float:
        """Return ``e = mean + rest``: ``(K.e)^2 >= (mean K.mean e)^2 / 2 - (K.rest)^2``."""
        mean, n = float(self._K.mean()), self._K.size
        dx, dy = grid.spacings
        band = float(self._elasticity.symbol(np.array([2 / math.hypot(1 / dx, 1 / dy)]))[0])
        rest = band - self.lift * float(np.sum((self._K - mean) ** 2))
        return min(rest, 0.5 * self.lift * mean**2 * n)

    def apply(self, e: Array) -> Array:
        """Return ``a e``, with the lift (m)."""
        result = self._elasticity.normal(self.operator, e)
        if self.lift:
            result += self.lift * float(np.vdot(self._K, e)) * self._K
        return result

    def rounding(self, *tractions: Array) -> float:
        """Bound on the 2-norm of the error that products with these tractions carry (m)."""
        return _ROUNDING * self._reach * sum(float(np.linalg.norm(t)) for t in tractions)

    def norm(self, e: Array) -> float:
        """Return ``||e||`` from above."""
        square = float(np.vdot(e, self.apply(e))) + float(np.linalg.norm(e)) * self.rounding(e)
        return math.sqrt(max(square, 0.0))

    def solve(self, right: Array, where: Mask) -> tuple[Array, Array]:
        """Return ``z``, zero off the marked elements, and ``a z``, about ``right`` on them (CG)."""
        z = np.zeros_like(right)
        residual = np.where(where, right, 0.0)
        direction, product = z, 0.0
        for _ in range(_ITERATIONS):
            energy = float(np.vdot(z, right - residual))
            left = float(np.vdot(residual, residual))
            if left <= _ENOUGH**2 * self.floor * energy:
                break
            step = np.where(where, self._precondition(residual), 0.0)
            last, product = product, float(np.vdot(residual, step))
            direction = step + (product / last if last else 0.0) * direction
            moved = self.apply(direction)
            length = product / float(np.vdot(direction, moved))
            z = z + length * direction
            residual = residual - length * np.where(where, moved, 0.0)
        return z, self.apply(z)

    def dual_norm(self, right: Array, where: Mask) -> float:
        """Return an upper bound of ``|right.e| / ||e||`` over all e that vanish off the marked elements.

        With ``right = a z + r`` there, its square is ``z.a z + 2 z.r + r.(a^-1) r``, and the last term is at
        most ``|r|^2`` over the smallest eigenvalue: true whatever z is.
        """
        if not np.any(right[where]):
            return 0.0
        if self.floor <= 0:
            return math.inf
        z, az = self.solve(right, where)
        r = np.where(where, right - az, 0.0)
        left = float(np.linalg.norm(r)) + self.rounding(z)
        square = float(np.vdot(z, az + 2 * r)) + float(np.linalg.norm(z)) * self.rounding(z)
        return math.sqrt(max(square, 0.0) + left**2 / self.floor)
