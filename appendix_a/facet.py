"""Influence coefficients of one square element on a plane of any tilt: values 'computed on the slope'.

The paper's remedy for steep asperities is to replace the few near-field terms of the flexibility matrix
by values computed on the slope. On an infinite plane of gradient g those are the flat solution in the
plane's own frame (Love 1929; Johnson 1985, 3.2): a force P normal to it moves the surface, at the
horizontal distance d from it, down by

    P cos(theta) [ (1 - nu^2) / (pi rho) + (1 + nu)(1 - 2 nu) / (2 pi) g . d / (cos(theta) rho^2) ],

rho^2 = d^2 + (g . d)^2, and the facet over a unit of projected area carries P = 1 / cos(theta).
"""

from __future__ import annotations

from functools import cache
from math import pi

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
NEAR, FAR = 8, 5  # Gauss points a side, for the next elements and beyond: 2e-7 of flat at worst
OCTANTS = 8  # octants of the loaded element; 1/rho in polar coordinates with NEAR points: smooth in the angle


def neighbours(reach: int) -> list[tuple[int, int]]:
    """Return offsets (i, j) in elements, up to `reach` along either axis, the element itself among them.

    >>> len(neighbours(1))
    9
    """
    steps = range(-reach, reach + 1)
    return [(i, j) for i in steps for j in steps]


def facet_coefficient(tan_x: Array, tan_y: Array, nu: float, offset: tuple[int, int]) -> Array:
    """Return the downward displacement (n,) at the element `offset` away, E = 1, unit pressure, a = 1.

    tan_x, tan_y: gradients (n,) of the loaded element's plane, heights outwards from the body; its
    projection is a square of edge 2 a. For another edge and modulus multiply by a / E.

    >>> flat = facet_coefficient(np.zeros(1), np.zeros(1), 0.0, (0, 0))
    >>> round(float(flat[0] * pi / np.arcsinh(1.0)), 9)  # 8 asinh(1) / pi
    8.0
    """
    if offset == (0, 0):
        return _own(tan_x, tan_y, nu)
    dx, dy, area = _lever_arms(offset)
    uphill = tan_x[:, None] * dx + tan_y[:, None] * dy
    squared = dx * dx + dy * dy + uphill * uphill
    secant = np.sqrt(1 + tan_x**2 + tan_y**2)[:, None]
    shear = (1 + nu) * (1 - 2 * nu) / (2 * pi)
    kernel = (1 - nu * nu) / (pi * np.sqrt(squared)) + shear * secant * uphill / squared
    result: Array = kernel @ area
    return result


def _own(tan_x: Array, tan_y: Array, nu: float) -> Array:
    """Return the value at the loaded element's centre, by 1/rho in polar coordinates."""
    nodes, weights = np.polynomial.legendre.leggauss(NEAR)
    width = 2 * pi / OCTANTS
    angles = (width * (np.arange(OCTANTS)[:, None] + 0.5 * (nodes + 1))).ravel()
    steps = np.tile(0.5 * width * weights, OCTANTS)
    cosine, sine = np.cos(angles), np.sin(angles)
    edge = 1 / np.maximum(np.abs(cosine), np.abs(sine))
    stretch = np.hypot(1.0, tan_x[:, None] * cosine + tan_y[:, None] * sine)
    result: Array = (1 - nu * nu) / pi * ((edge / stretch) @ steps)
    return result


@cache
def _lever_arms(offset: tuple[int, int]) -> tuple[Array, Array, Array]:
    """Return offsets from Gauss points of the loaded square to the field point: dx, dy (m,), and weights."""
    nodes, weights = np.polynomial.legendre.leggauss(NEAR if max(map(abs, offset)) == 1 else FAR)
    x, y = np.meshgrid(nodes, nodes, indexing="ij")
    area = np.outer(weights, weights)
    return 2.0 * offset[0] - x.ravel(), 2.0 * offset[1] - y.ravel(), area.ravel()
