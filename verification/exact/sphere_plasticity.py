"""A published finite-element law of an elastic, perfectly plastic sphere on a rigid flat, for comparison.

Source: Kogut and Etsion 2002, J. Appl. Mech. 69, 657: a fit over the interference of first yield.
"""

from __future__ import annotations

from typing import NamedTuple

KOGUT_ETSION_LARGEST = 110.0
"""Interference over its critical value up to which Kogut and Etsion computed: mean pressure = hardness."""


class Loaded(NamedTuple):
    """Load over the load of first yield, and contact area over the area there."""

    load: float
    area: float


def hardness_factor(nu: float) -> float:
    """Return peak pressure at first yield over hardness, ``0.454 + 0.41 nu`` (Kogut and Etsion)."""
    return 0.454 + 0.41 * nu


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
