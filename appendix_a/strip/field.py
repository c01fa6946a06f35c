"""Half-plane y >= 0, y into the body, under unit pressure on |x| < 1 of its boundary (Johnson 1985, 2.5)."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.special import xlogy

Real = NDArray[np.float64]


def stresses(x: ArrayLike, y: ArrayLike) -> tuple[Real, Real, Real]:
    """Return (sigma_x, sigma_y, tau_xy) of (A1), tension positive; x, y in half-widths, y >= 0.

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
    """Return u_y(x) - u_y(0) of the boundary, plane strain, in units of pressure times half-width over E."""
    return np.asarray(-2 * (1 - nu**2) / np.pi * logarithms(x))


def logarithms(x: ArrayLike) -> Real:
    """Return (x + 1) log|x + 1| - (x - 1) log|x - 1| to rounding, for every finite x.

    Near and far the two cancel, and ``log|x^2 - 1| + 2 x atanh(x or 1/x)`` takes their place.
    """
    size = np.abs(np.asarray(x, dtype=float))
    near, middle, far = np.minimum(size, 0.5), np.clip(size, 0.5, 2.0), np.maximum(size, 2.0)
    inside = np.log1p(-(near**2)) + 2 * near * np.arctanh(near)
    about = xlogy(middle + 1, middle + 1) - xlogy(middle - 1, np.abs(middle - 1))
    outside = 2 * np.log(far) + np.log1p(-((1 / far) ** 2)) + 2 * (far * np.arctanh(1 / far))
    return np.asarray(np.where(size < 0.5, inside, np.where(size > 2, outside, about)))
