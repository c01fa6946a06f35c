"""Half-plane y >= 0, y into the body, under unit pressure on |x| < 1 of its boundary (Johnson 1985, 2.5)."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.special import xlogy

Real = NDArray[np.float64]


def stresses(x: ArrayLike, y: ArrayLike) -> tuple[Real, Real, Real]:
    """(sigma_x, sigma_y, tau_xy) of (A1) per unit pressure, tension positive; x, y in half-widths, y >= 0.

    ``theta_1, theta_2`` are the angles in [0, pi] at which the ends x = +1 and x = -1 see the point: (A1)'s
    ``tan theta = y / (x -+ a)`` alone leaves them open by pi, and the principal branch of arctan would be
    wrong.
    """
    x, y = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    first, second = np.arctan2(y, x - 1), np.arctan2(y, x + 1)
    angle, sines = 2 * (first - second), np.sin(2 * first) - np.sin(2 * second)
    tau = (np.cos(2 * first) - np.cos(2 * second)) / (2 * np.pi)
    return -(angle + sines) / (2 * np.pi), -(angle - sines) / (2 * np.pi), tau


def flat_displacement(x: ArrayLike, nu: float) -> Real:
    """u_y(x) - u_y(0) of the boundary, plane strain, in units of pressure times half-width over E."""
    x = np.asarray(x, dtype=float)
    logs = xlogy(x + 1, np.abs(x + 1)) - xlogy(x - 1, np.abs(x - 1))
    return np.asarray(-2 * (1 - nu**2) / np.pi * logs)
