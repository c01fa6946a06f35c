"""Differences between colours as seen with and without colour blindness."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

import numpy as np

from refimpl.grid import Array

VISION: dict[str, Array] = {
    "all cones": np.eye(3),
    "no red cones": np.array(
        [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]]
    ),
    "no green cones": np.array(
        [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]]
    ),
    "no blue cones": np.array(
        [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.303900]]
    ),
}
"""Linear sRGB as seen without one kind of cones (Machado, Oliveira and Fernandes 2009, severity 1)."""
_XYZ = np.array(
    [[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750], [0.0193339, 0.1191920, 0.9503041]]
)
"""Matrix from linear sRGB to XYZ, white D65 (IEC 61966-2-1)."""


def linear(colour: str) -> Array:
    """Return linear sRGB of a colour like "#0072B2"."""
    c = np.array([int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5)])
    return np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4)


def contrast(one: str, other: str) -> float:
    """Return the contrast of two colours (WCAG 2.1).

    >>> contrast("#FFFFFF", "#000000")
    21.0
    """
    low, high = sorted(float(_XYZ[1] @ linear(colour)) for colour in (one, other))
    return round((high + 0.05) / (low + 0.05), 3)


def least_difference(colours: Sequence[str], vision: Array) -> float:
    """Return the smallest colour difference of any two (CIE 1976; 2.3 is just noticed)."""
    seen = [_lab(vision @ linear(colour)) for colour in colours]
    return min(float(np.linalg.norm(one - other)) for one, other in combinations(seen, 2))


def _lab(rgb: Array) -> Array:
    xyz = _XYZ @ np.clip(rgb, 0, 1) / _XYZ.sum(axis=1)
    f = np.where(xyz > 216 / 24389, np.cbrt(xyz), (24389 / 27 * xyz + 16) / 116)
    return np.array([116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])])
