"""Published finite-element laws of an elastic, perfectly plastic sphere on a rigid flat, for comparison.

Sources: Kogut and Etsion 2002, J. Appl. Mech. 69, 657; Jackson and Green 2005, J. Tribology 127, 343. Both
count the interference from that of first yield, below the surface, and the yield stress Y, not the hardness.
The laws are fits: their authors give some per cent, and both jump by a few per cent between their pieces.
"""

from __future__ import annotations

import math
from typing import NamedTuple

KOGUT_ETSION_LARGEST = 110.0
"""Interference over its critical value up to which Kogut and Etsion computed: mean pressure = hardness."""


class Loaded(NamedTuple):
    """Load over the load of first yield, and contact area over the area there."""

    load: float
    area: float


def hardness_factor(nu: float) -> float:
    """Return the maximum pressure at first yield over the hardness, ``K = 0.454 + 0.41 nu`` (Kogut and
    Etsion)."""
    return 0.454 + 0.41 * nu


def yield_factor(nu: float) -> float:
    """Return the maximum pressure at first yield over the yield stress, ``C = 1.295 exp(0.736 nu)`` (Jackson,
    Green)."""
    return 1.295 * math.exp(0.736 * nu)


def kogut_etsion(interference: float) -> Loaded:
    """Load and area at an interference over its critical value, up to 110; Hertz below 1.

    Raises ValueError beyond.

    >>> round(kogut_etsion(6.0).load, 1)
    13.2
    """
    w = interference
    if w <= 1:
        return Loaded(w**1.5, w)
    if w <= 6:
        return Loaded(1.03 * w**1.425, 0.93 * w**1.136)
    if w <= KOGUT_ETSION_LARGEST:
        return Loaded(1.40 * w**1.263, 0.94 * w**1.146)
    raise ValueError(f"interference of {w:g} critical ones: the law ends at {KOGUT_ETSION_LARGEST:g}")


def jackson_green(interference: float, yield_strain: float, nu: float) -> Loaded:
    """Load and area at an interference over its critical value; Hertz below 1.9.

    ``yield_strain`` is Y / E*. The fully plastic mean pressure falls with the contact radius over R.
    """
    w, C = interference, yield_factor(nu)
    if w < 1.9:
        return Loaded(w**1.5, w)
    area = w * (w / 1.9) ** (0.14 * math.exp(23 * yield_strain))
    radius = math.pi * C * yield_strain / 2 * math.sqrt(area)  # contact radius over R
    hardness = 2.84 * (1 - math.exp(-0.82 * radius**-0.7))  # fully plastic mean pressure over Y
    load = math.exp(-0.25 * w ** (5 / 12)) * w**1.5
    load += 4 * hardness / C * (1 - math.exp(-(w ** (5 / 9)) / 25)) * w
    return Loaded(load, area)
