"""Influence kernels in two parts: a far one without short waves, and a near one that vanishes beyond `REACH`.

The theory is that of `refimpl.operators.near_far`. Lengths are in elements, which are square.
"""

from __future__ import annotations

from functools import cache

import numpy as np
import scipy

from refimpl.grid import Array, Shape, read_only
from refimpl.operators.coarse_grid import COARSER
from refimpl.operators.kernel_tables import unit_table

SHAPE = 22.0  # beta of the bell
RADIUS = 2 * COARSER * SHAPE / np.pi  # R: the band ends at half the coarse grid's highest frequency
REACH = int(RADIUS)  # greatest offset at which the near part counts
WIDTH = 12  # spacings under the window
_WINDOW_SHAPE = 0.98 * np.pi * WIDTH * (1 - 0.5 * 0.5)  # beta of the window, for half the frequencies
_TAPS = 24  # spacings that the filter reaches: 16 leave 6e-10 of its values, 24 leave 3e-12
_GAUSS = 4  # points along an element's edge: exact to 3e-13 for the band's shortest wave
_SIGNS = {"normal": (1, 1), "tangential": (-1, 1)}  # signs of opposite offsets, along x and y


def window(distance: Array) -> Array:
    """Return the bell of Kaiser and Bessel, one at its centre, at distances in spacings."""
    squared = np.maximum(1 - (2 * distance / WIDTH) ** 2, 0.0)
    bell: Array = scipy.special.i0(_WINDOW_SHAPE * np.sqrt(squared)) / scipy.special.i0(_WINDOW_SHAPE)
    return bell * (squared > 0)


def near_quarter(kind: str, shape: Shape) -> Array:
    """Return the near part at offsets from 0 to half of each circle, as `unit_table` has the whole."""
    quarter = np.zeros(shape)
    near = _near(kind)
    n, m = min(shape[0], len(near)), min(shape[1], len(near))
    quarter[:n, :m] = near[:n, :m]
    return quarter


def far_quarter(kind: str, shape: Shape) -> Array:
    """Return the far part between points of the coarse grid, with a window undone at either end."""
    x, y = (COARSER * np.arange(float(n + _TAPS)) for n in shape)
    along, across = (_filter(n, sign) for n, sign in zip(shape, _SIGNS[kind], strict=True))
    return np.asarray(along @ _far(kind, x[:, None], y) @ across.T)


@cache
def _near(kind: str) -> Array:
    """Return the near part: the kernel less the mean of its far part over an element, within the reach."""
    points, weights = np.polynomial.legendre.leggauss(_GAUSS)
    offsets = np.arange(float(REACH + 1))
    at = (offsets[:, None] + points / 2).ravel()
    far = _far(kind, at[:, None], at).reshape(REACH + 1, _GAUSS, REACH + 1, _GAUSS)
    left = unit_table(kind, far.shape[::2]) - np.einsum("iajb,a,b->ij", far, weights / 2, weights / 2)
    return read_only(left * (np.hypot(offsets[:, None], offsets) <= REACH))


def _far(kind: str, x: Array, y: Array) -> Array:
    """Return ``Phi(r) / r`` or ``x Psi(r) / r^2``."""
    squared = x * x + y * y
    at = squared < RADIUS**2
    inside = squared[at] / RADIUS**2
    if kind == "normal":
        found = 1 / np.sqrt(np.maximum(squared, 1.0))
        found[at] = np.polynomial.chebyshev.chebval(2 * inside - 1, _normal_inside())
        return found
    root = np.sqrt(1 - inside)
    beyond = root * np.cosh(SHAPE * root) - np.sinh(SHAPE * root) / SHAPE
    found = x / np.maximum(squared, np.finfo(float).tiny)
    found[at] *= 1 - beyond / (np.cosh(SHAPE) - np.sinh(SHAPE) / SHAPE)
    return found


@cache
def _normal_inside() -> Array:
    """Return the coefficients of ``Phi(r) / r`` by Chebyshev's polynomials in ``2 (r / R)^2 - 1``."""
    points, weights = np.polynomial.legendre.leggauss(80)
    t = np.polynomial.chebyshev.chebpts1(41)
    at = np.sqrt((t[:, None] + 1) / 2) * (points + 1) / 2
    means = scipy.special.i0(SHAPE * np.sqrt(1 - at**2)) @ weights
    found: Array = np.polynomial.chebyshev.chebfit(t, means, 40)
    return read_only(found / (RADIUS * np.polynomial.chebyshev.chebval(1.0, found)))


@cache
def _taps() -> Array:
    """Return the filter: in the band, the mean over an element divided by two windows; beyond, anything."""
    k = np.linspace(0, np.pi / 2, 200)  # 1/spacing
    root = np.sqrt(_WINDOW_SHAPE**2 - (k * WIDTH / 2) ** 2)
    undone = WIDTH * np.sinh(root) / root / scipy.special.i0(_WINDOW_SHAPE)
    wanted = np.sinc(k / (2 * np.pi * COARSER)) / undone**2
    cosines = np.cos(np.outer(k, np.arange(_TAPS + 1)))
    found = np.linalg.lstsq(cosines, wanted, rcond=1e-14)[0]
    found[1:] /= 2
    return read_only(np.append(found, 0.0))


def _filter(count: int, sign: int) -> Array:
    """Return the matrix from ``count + _TAPS`` offsets of an even or odd field to those filtered."""
    taps, i, j = _taps(), np.arange(count)[:, None], np.arange(count + _TAPS)
    matrix: Array = taps[np.minimum(np.abs(i - j), _TAPS + 1)]
    matrix[:, 1:] += sign * taps[np.minimum(i + j, _TAPS + 1)][:, 1:]
    return matrix
