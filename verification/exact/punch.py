"""Rigid flat-ended punches: circle (closed form) and square (published constant and our own computation).

Circle: Boussinesq 1885; Johnson 1985, section 3.8. Square: the punch is the electrified plate. With the
potential of p equal to pi E* delta on the plate, P = pi C E* (side) delta, where C is the capacitance of the
unit square over 4 pi eps0. Published: 0.3667874 (Read 1997, J. Comput. Phys. 133, 1; as quoted by Hwang and
Mascagni 2004, J. Appl. Phys. 95, 3798), so P = 1.1523 E* side delta. Our graded meshes extrapolate to
0.3667880 with gradings 3 and 4 alike (0.36678805, 0.36678802); a lower bound by Thomson's principle reached
0.3667875 at n = 48, which the published last digit misses.

Orders to expect from square elements of edge h. Square punch: p ~ d^(-1/2) at an edge, so a row of elements
along it misplaces a share h of the load: order 1 in the stiffness; the corner, p ~ r^(-0.7034) (Morrison and
Lewis 1976), adds h^(1.59), which spoils a fit but not the order. Circular punch: the staircase outline moves
the edge by a fraction of h: order 1 as well, with scatter from grid to grid. The pressure beside the edge
does not converge at all.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from appendix_a.fem3d.patch import normal_integral

Array = NDArray[np.float64]

UNIT_SQUARE_CAPACITANCE = 0.3667880
"""Over 4 pi eps0 and per unit side: our own value (n = 16, 32, 64 of `square_capacitance`, extrapolated)."""
PUBLISHED_CAPACITANCE = 0.3667874
UNCERTAINTY_SQUARE = 2e-6
"""Relative: covers the published value (1.6e-6 lower) and the spread of our extrapolations (2e-7)."""


@dataclass(frozen=True)
class CircularPunch:
    """Flat end of ``radius`` a (m) under ``load`` (N), reduced ``modulus`` E* (Pa)."""

    load: float
    radius: float
    modulus: float

    @property
    def approach(self) -> float:
        """delta = P/(2 a E*) (m), Johnson (3.36)."""
        return self.load / (2 * self.radius * self.modulus)

    def pressure(self, r: ArrayLike) -> Array:
        """Return p (Pa) at ``r`` (m): P/(2 pi a^2) (1 - r^2/a^2)^(-1/2) inside, 0 outside, infinite at a."""
        inside = 1 - (np.asarray(r, dtype=float) / self.radius) ** 2
        safe = np.where(inside > 0, inside, 1.0)
        peak = self.load / (2 * np.pi * self.radius**2)
        return np.where(inside > 0, peak / np.sqrt(safe), np.where(inside == 0, np.inf, 0.0))

    def displacement(self, r: ArrayLike) -> Array:
        """Return the normal displacement (m): delta, outside (2 delta/pi) arcsin(a/r), Johnson (3.38)."""
        outer = np.maximum(1.0, np.asarray(r, dtype=float) / self.radius)
        return 2 * self.approach / np.pi * np.arcsin(1 / outer)


def square_stiffness(side: float, modulus: float) -> float:
    """Return P/delta (N/m) of a square punch of edge ``side`` (m), ``modulus`` E* (Pa).

    >>> f"{square_stiffness(2.0, 1.0) / 2:.4f} E* 2a delta"
    '1.1523 E* 2a delta'
    """
    return np.pi * UNIT_SQUARE_CAPACITANCE * modulus * side


def square_capacitance(n: int) -> float:
    """Return our own C: piecewise-constant collocation on ``n`` graded elements per half side.

    Quarter plate 0 < x, y < 1, nodes ``1 - (1 - i/n)^4``, symmetric about both axes and the diagonal.
    """
    plate = _Plate.graded(n)
    density = np.linalg.solve(plate.potential(plate.x, plate.y), np.ones(len(plate.x)))
    return float(np.sum(density * plate.area) / 2)  # the plate's side is 2


@dataclass(frozen=True)
class _Plate:
    """An eighth of the plate |x|, |y| < 1: centres, half-sizes, and ``area`` with mirror images."""

    x: Array
    y: Array
    half_x: Array
    half_y: Array
    area: Array

    @classmethod
    def graded(cls, n: int) -> _Plate:
        nodes = 1 - (1 - np.arange(n + 1) / n) ** 4
        middle, half = (nodes[1:] + nodes[:-1]) / 2, np.diff(nodes) / 2
        i, j = np.tril_indices(n)
        images = np.where(i == j, 4, 8)
        return cls(middle[i], middle[j], half[i], half[j], 4 * half[i] * half[j] * images)

    def potential(self, x: Array, y: Array) -> Array:
        """Return I[1/rho] of elements with their images (columns), seen from points ``x, y`` (rows)."""
        x, y = x[:, None], y[:, None]
        off_diagonal = self.x != self.y
        total = np.zeros((len(x), len(self.x)))
        for sx in (-1, 1):
            for sy in (-1, 1):
                total += _rectangle(x - sx * self.x, y - sy * self.y, self.half_x, self.half_y)
                mirrored = _rectangle(x - sx * self.y, y - sy * self.x, self.half_y, self.half_x)
                total += np.where(off_diagonal, mirrored, 0.0)
        return total


def _rectangle(x: Array, y: Array, a: Array, b: Array) -> Array:
    """Return I[1/rho] of a 2a by 2b rectangle about the origin, seen from (x, y); broadcast.

    From afar the corner sum cancels (thin elements lose all digits), so there the multipole series takes
    over: relative error (size/distance)^4 * 7/640 < 2e-8 beyond 30 half-sizes, on entries that are themselves
    small.
    """
    distance2 = x**2 + y**2
    x, y, a, b, distance2 = np.broadcast_arrays(x, y, a, b, distance2)
    far = distance2 > 900 * np.maximum(a, b) ** 2
    result = np.empty(distance2.shape)
    xf, yf, af, bf, df = x[far], y[far], a[far], b[far], distance2[far]
    quadrupole = (af**2 * (3 * xf**2 / df - 1) + bf**2 * (3 * yf**2 / df - 1)) / (6 * df)
    result[far] = 4 * af * bf / np.sqrt(df) * (1 + quadrupole)
    result[~far] = normal_integral(x[~far], y[~far], a[~far], b[~far])
    return result
