"""Units that numbers are printed with, at the scale of the object."""

from __future__ import annotations

import math
from typing import NamedTuple


class Unit(NamedTuple):
    """A unit and what it is of the SI unit: 1 um is 1e-6."""

    name: str
    size: float


_LENGTHS = Unit("um", 1e-6), Unit("pm", 1e-12), Unit("nm", 1e-9), Unit("mm", 1e-3), Unit("m", 1.0)
_SCALES = {
    "m": _LENGTHS,
    "m^2": tuple(Unit(f"{name}^2", size**2) for name, size in (_LENGTHS[3], *_LENGTHS)),
    "Pa": (Unit("MPa", 1e6), Unit("Pa", 1.0), Unit("kPa", 1e3), Unit("GPa", 1e9)),
    "N": (
        Unit("N", 1.0), Unit("pN", 1e-12), Unit("nN", 1e-9), Unit("uN", 1e-6), Unit("mN", 1e-3),
        Unit("kN", 1e3), Unit("MN", 1e6),
    ),
}  # fmt: skip
"""Units by that in SI, the usual one first."""
_USUAL = 1e-3, 1e5  # numbers that keep the usual unit


def printed_unit(value: float, unit: str) -> Unit:
    """Return the unit to print a number in: the usual one, or the largest of which there is one at least.

    ``unit`` is that in SI, "1" for none.

    >>> printed_unit(5.86e-8, "m^2").name, printed_unit(9.7e-10, "m^2").name, printed_unit(-2e-6, "N").name
    ('mm^2', 'um^2', 'uN')
    >>> printed_unit(0.31, "1")
    Unit(name='', size=1.0)
    """
    if unit not in _SCALES:
        return Unit("" if unit == "1" else unit, 1.0)
    usual, size = _SCALES[unit][0], abs(value)
    if not 0 < size < math.inf or _USUAL[0] <= size / usual.size < _USUAL[1]:
        return usual
    return unit_at_scale(value, unit)


def unit_at_scale(value: float, unit: str) -> Unit:
    """Return the largest unit of which the value has at least one, or the smallest unit.

    >>> unit_at_scale(4.1e-4, "m").name, unit_at_scale(0.8e9, "Pa").name, unit_at_scale(0.0, "m").name
    ('um', 'MPa', 'pm')
    """
    rising = sorted(_SCALES[unit], key=lambda other: other.size)  # 1e-9: one unit, but for rounding, is one
    return [rising[0], *(other for other in rising if other.size * (1 - 1e-9) <= abs(value))][-1]
