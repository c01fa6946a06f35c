"""Exact plane-strain displacements of a half-plane y > 0, y into the body (Flamant; Johnson 1985, ch. 2).

Lengths in any unit, forces per unit thickness in units of E times that length; E = 1.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from appendix_a.strip.field import logarithms

Array = NDArray[np.float64]


def point_force(x: Array, y: Array, force: tuple[float, float], nu: float) -> tuple[Array, Array]:
    """Return displacements (u_x, u_y) at (x, y) under a force (F_x, F_y) on the surface at the origin.

    The stress is radial, -2 F . r / (pi r^2) (Flamant); the rotation tends to zero at infinity, the
    translation is arbitrary.
    """
    radius2 = x**2 + y**2
    angle = np.arctan2(x, y)  # from the inward normal
    spread = (1.0 - nu**2) / np.pi * np.log(radius2)
    turn = (1.0 + nu) * (1.0 - 2.0 * nu) / np.pi * angle
    pull = (1.0 + nu) / np.pi / radius2
    push_x, push_y = force
    u_x = push_x * (-spread - pull * y**2) + push_y * (-turn + pull * x * y)
    u_y = push_y * (-spread - pull * x**2) + push_x * (turn + pull * x * y)
    return u_x, u_y


def pressed_strip(x: Array, nu: float, half_width: float = 1.0) -> Array:
    """Return u_y(x) - u_y(0) under unit pressure on |x| < half_width, in pressure / E.

    >>> pressed_strip(np.array([2.0]), 0.0), -6 * np.log(3.0) / np.pi
    (array([-2.09819...]), np.float64(-2.09819...))
    """
    return -2.0 * (1.0 - nu**2) / np.pi * half_width * logarithms(x / half_width)


def sheared_strip(x: Array, nu: float, half_width: float = 1.0) -> Array:
    """Return u_y(x) - u_y(0) under unit traction along +x on |x| < half_width, in traction / E."""
    return (1.0 + nu) * (1.0 - 2.0 * nu) * np.clip(x, -half_width, half_width)
