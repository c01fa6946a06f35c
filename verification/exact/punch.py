"""Rigid flat-ended punches: circle (closed form) and square (published constant).

Circle: Boussinesq 1885; Johnson 1985, section 3.8. Square: the punch is the electrified plate. With the
potential of p equal to pi E* delta on the plate, P = pi C E* (side) delta, where C is the capacitance of the
unit square over 4 pi eps0: 0.3667874 (Read 1997, J. Comput. Phys. 133, 1; as quoted by Hwang and Mascagni
2004, J. Appl. Phys. 95, 3798), so P = 1.1523 E* side delta.

Orders to expect from square elements of edge h. Square punch: p ~ d^(-1/2) at an edge, so a row of elements
along it misplaces a share h of the load: order 1 in the stiffness; the corner, p ~ r^(-0.7034) (Morrison and
Lewis 1976), adds h^(1.59), which spoils a fit but not the order. Circular punch: the staircase outline moves
the edge by a fraction of h: order 1 as well, with scatter from grid to grid. The pressure beside the edge
does not converge at all.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from refimpl.grid import Array

UNIT_SQUARE_CAPACITANCE = 0.3667874
"""Over 4 pi eps0 and per unit side."""
UNCERTAINTY_SQUARE = 2e-6
"""Relative: collocation on graded meshes of our own, extrapolated, gave 0.3667880."""


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


def square_stiffness(side: float, modulus: float) -> float:
    """Return P/delta (N/m) of a square punch of edge ``side`` (m), ``modulus`` E* (Pa).

    >>> f"{square_stiffness(2.0, 1.0) / 2:.4f} E* 2a delta"
    '1.1523 E* 2a delta'
    """
    return np.pi * UNIT_SQUARE_CAPACITANCE * modulus * side
