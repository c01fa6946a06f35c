"""Excess of whole elements along a contact's edge: the part of a counted area's error that can be subtracted.

An element is in contact as a whole or not at all, and is counted as soon as a part of it carries load. Per
element face along the edge that adds ``(pi - 1 + ln 2) / 24`` elements in the mean if every element that the
edge crosses is counted (Yastrebov, Anciaux and Molinari 2017); of solved contacts it is `EDGE_SIZE` of that.

The solution shows where within an element the edge lies. At a distance d from the edge, pressures inside go
as ``d^(1/2)`` and gaps outside as ``d^(3/2)`` (Hertz; Johnson 1985, section 4.2). Two ratios follow from d:
the pressure of a face's element over that of the element behind it, and the gap of the element beyond the
face over that of the next one. On strips along an axis, of which d is known, each goes with the excess of a
face, from -0.3 of an element (ratios 0.7 and 0) to 0.7 (0 and 0.39). Where the edge crosses the axes at an
angle it has more faces than edge elements, and the ratios are worth less: a quarter of a face along the edge.

Solved strips (Westergaard's closed form) exceed by 0.10 to 0.11 of an element per face whatever the gap to
the next one, from 0.3 elements on. Beside a narrow gap pressures rise as d, which reads as an edge that
leaves the element. So faces from which gaps do not rise count as the mean (`EdgeOffset.uneven`).

The constants were fitted together by likelihood to 1500 scenes of 15 classes
(`verification.coverage.classes`, seeds 1500000 to 1500099).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from refimpl.grid import Array, Grid
from refimpl.model.forces import EDGE_SHARE

EDGE_SIZE, EDGE_SIZE_SPREAD = 0.72, 0.03  # c0, s_c
# elements: per face, from one end of both ratios to the other; per face beyond the second of a run along an
# axis; per element on a free border that cuts the contact off, which carries too little there
OFFSET_EXCESS, STRAIGHT_EXCESS, BORDER_EXCESS = 0.41, 0.08, 0.09
_FILLED = 0.45  # ratio of pressures from which the edge fills the element
# ratios of gaps: edge that reaches the element, edge that leaves it, most of any edge
_REACHED, _LEFT, _MOST = 0.1, 0.3, 0.4
_EVEN = 0.99  # ratio without a rise: symmetric elements differ by iterations
_WIDE, _LEVEL = 0.7, 0.74  # place of the edge at larger ratios of gaps, and by pressures without a rise
# place by gaps less that by pressures: in the mean, of gaps without a rise, and of pressures too
_MEAN, _NARROW, _NEITHER = -0.083, 0.05, 0.5
_ACROSS = 0.25  # share of a face that lies across the edge
_UNEVEN_PRESSURE = 0.25  # variance of a face without a rise of pressure, over that without a rise of gap


class EdgeOffset(NamedTuple):
    """Offset of a contact's edge within its elements, from the mean.

    excess : by which whole elements exceed the mean (elements)
    uneven : number of faces from which gaps do not rise, and a quarter of those from which pressures do not
    """

    excess: float
    uneven: float


NO_OFFSET = EdgeOffset(0.0, 0.0)


def edge_offset(pressure: Array, clearance: Array, grid: Grid) -> EdgeOffset:
    """Return the offset of a contact's edge, by its pressure and clearance (any unit, the grid's shape).

    >>> pressure, gap = np.array([[0.0, 0.0, 0.2, 1.0, 1.0]]), np.array([[4.0, 1.0, 0.0, 0.0, 0.0]])
    >>> found = edge_offset(pressure, gap, Grid((1, 5), (1.0, 5.0)))
    >>> round(found.excess, 4), found.uneven  # 0.41 (0.75 - 0.2 / 0.45 + 0.083)
    (0.1593, 0.0)
    """
    box = grid.window_around(pressure > 0, margin=2).slices
    p, gap = (grid.padded(field[box], 2) for field in (pressure, np.where(pressure > 0, 0.0, clearance)))
    ways = [(p, gap), (p.T, gap.T), (p[::-1], gap[::-1]), (p.T[::-1], gap.T[::-1])]
    excess, uneven = (float(sum(found)) for found in zip(*(_downwards(*way) for way in ways), strict=True))
    return EdgeOffset(OFFSET_EXCESS * excess, uneven)


def _downwards(p: Array, gap: Array) -> EdgeOffset:
    """Return the offset, over `OFFSET_EXCESS`, of faces to the next row; fields have a frame of two rows."""
    inner = slice(2, -2)
    faces = (p[2:-2, inner] > 0) & (p[3:-1, inner] == 0)
    here, behind, beyond, next_ = (
        field[rows, inner][faces]
        for field, rows in ((p, inner), (p, slice(1, -3)), (gap, slice(3, -1)), (gap, slice(4, None)))
    )
    filled, open_ = _ratio(here, behind), _ratio(beyond, next_)
    level, narrow = filled >= _EVEN, open_ >= _EVEN
    by_pressure = np.where(level, _LEVEL, np.minimum(filled / _FILLED, 1.0))
    by_gap = np.clip((open_ - _REACHED) / (_LEFT - _REACHED), 0.0, 1.0)
    by_gap[open_ >= _MOST] = _WIDE
    place = np.where(narrow, np.where(level, _NEITHER, _NARROW), by_gap - by_pressure)
    along = (p[inner, 3:-1] - p[inner, 1:-3])[faces]
    squared_normal = _ratio(behind**2, behind**2 + along**2)
    share = _ACROSS + (1 - _ACROSS) * np.where(behind > 0, squared_normal, 0.0)
    uneven = np.count_nonzero(narrow) + _UNEVEN_PRESSURE * np.count_nonzero(level)
    return EdgeOffset(float(np.sum(share * place - _MEAN)), uneven)


def _ratio(near: Array, far: Array) -> Array:
    """Return ``near / far``, infinite over nothing."""
    ratio: Array = np.divide(np.maximum(near, 0.0), far, out=np.full_like(near, np.inf), where=far > 0)
    return ratio


def single_element_share(edge: float, area: float) -> float:
    """Return the edge's share of an area over that of a single element: 1 where all patches are single
    elements, and without any area.

    >>> single_element_share(4 * EDGE_SHARE, 1.0), single_element_share(EDGE_SHARE, 1.0)
    (1.0, 0.25)
    """
    return min(max(edge, 0.0) / area / (4 * EDGE_SHARE), 1.0) if area > 0 else 1.0
