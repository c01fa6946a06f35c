"""Excess of whole elements along a contact's edge: the part of a counted area's error that can be subtracted.

An element is in contact as a whole or not at all, and is counted as soon as a part of it carries load. Per
element face along the edge that adds ``(pi - 1 + ln 2) / 24`` elements in the mean if every element that the
edge crosses is counted (Yastrebov, Anciaux and Molinari 2017).

The solution shows where within an element the edge lies. At a distance d from the edge, pressures inside go
as ``d^(1/2)`` and gaps outside as ``d^(3/2)`` (Hertz; Johnson 1985, section 4.2). Two ratios follow from d:
the pressure of a face's element over that of the element behind it, and the gap of the element beyond the
face over that of the next one. Other edges have other ratios: at the rim of a punch pressures rise towards
the edge, beside a wall gaps do not rise. So the excess of a face is a table over both ratios, for faces that
lie across the pressure's gradient and for those along it (`FACE_EXCESS`), fitted to solved scenes.
"""

from __future__ import annotations

import numpy as np

from refimpl.grid import Array, Grid, Mask
from refimpl.model.forces import EDGE_SHARE

PRESSURES = np.array([0.0, 0.3, 0.6, 0.8, 1.0, 1.3])  # knots: a face's pressure over that behind it
GAPS = np.array([0.0, 0.12, 0.24, 0.36, 0.6, 1.0])  # knots: the gap beyond a face over the next one
_STEEP = 4  # knot of gaps from which they hardly rise: Hertz's rise from at most 0.36 of the next
KINDS = 2, len(PRESSURES), len(GAPS)  # faces across and along the pressure's gradient, by both ratios
NO_FACES = (0.0,) * int(np.prod(KINDS))


def edge_faces(pressure: Array, clearance: Array, grid: Grid) -> tuple[float, ...]:
    """Return the numbers of faces along a contact's edge by kind, an array of shape `KINDS` flattened.

    A face counts for the four kinds about its two ratios, as a bilinear interpolation does, and for both
    directions by the squared cosine of its normal with the gradient. Fields in any unit, the grid's shape.

    >>> pressure, gap = np.array([[0.0, 0.0, 0.2, 1.0, 1.0]]), np.array([[4.0, 1.0, 0.0, 0.0, 0.0]])
    >>> found = np.reshape(edge_faces(pressure, gap, Grid((1, 5), (1.0, 5.0))), KINDS)
    >>> round(float(found.sum()), 12), float((found[0] @ GAPS).sum() / found[0].sum())  # gaps go as 1/4
    (1.0, 0.25)
    """
    total = np.sum([_downwards(*way) for way in _ways(pressure, clearance, grid)], axis=0)
    return tuple(total.ravel().tolist())


def rim_faces(pressure: Array, plastic: Mask, grid: Grid) -> int:
    """Return the number of faces along the edge whose element has one at the hardness behind it.

    >>> pressure = np.array([[0.0, 0.0, 0.3, 1.0, 1.0, 0.8, 0.4, 0.0]])
    >>> rim_faces(pressure, pressure == 1.0, Grid((1, 8), (1.0, 8.0)))
    1
    """
    if not plastic.any():
        return 0
    ways = _ways(pressure, np.zeros_like(pressure), grid)
    return sum(int((_beside(*way)[2] >= pressure[plastic].min()).sum()) for way in ways)


def wall_pressure(pressure: Array, clearance: Array, grid: Grid) -> float:
    """Return the maximum pressure of faces towards which it does not fall, where the gap hardly rises beyond.

    >>> pressure, gap = np.array([[0.0, 0.0, 3.0, 2.0, 2.0]]), np.array([[4.0, 3.0, 0.0, 0.0, 0.0]])
    >>> [wall_pressure(pressure, gap**power, Grid((1, 5), (1.0, 5.0))) for power in (1, 3)]
    [3.0, 0.0]
    """
    highest = 0.0
    for way in _ways(pressure, clearance, grid):
        _, here, behind, beyond, next_ = _beside(*way)
        walls = (here >= behind) & (beyond >= GAPS[_STEEP] * next_) & (behind > 0)
        highest = max(highest, float(here[walls].max(initial=0.0)))
    return highest


def _ways(pressure: Array, clearance: Array, grid: Grid) -> list[tuple[Array, Array]]:
    """Return the pressure and gap around the contact with a frame of two rows, seen from all four sides."""
    box = grid.window_around(pressure > 0, margin=2).slices
    gap = np.where(pressure[box] > 0, 0.0, clearance[box])
    p, gap = (grid.padded(field, 2) for field in (pressure[box], gap))
    return [(p, gap), (p.T, gap.T), (p[::-1], gap[::-1]), (p.T[::-1], gap.T[::-1])]


def _beside(p: Array, gap: Array) -> tuple[Mask, Array, Array, Array, Array]:
    """Return the faces to the next row, and of each the pressures at and behind it, and both gaps beyond."""
    inner = slice(2, -2)
    faces: Mask = (p[2:-2, inner] > 0) & (p[3:-1, inner] == 0)
    rows = (p, inner), (p, slice(1, -3)), (gap, slice(3, -1)), (gap, slice(4, None))
    here, behind, beyond, next_ = (field[row, inner][faces] for field, row in rows)
    return faces, here, behind, beyond, next_


def _downwards(p: Array, gap: Array) -> Array:
    """Return the faces to the next row by kind; fields have a frame of two rows."""
    inner = slice(2, -2)
    faces, here, behind, beyond, next_ = _beside(p, gap)
    by_pressure, by_gap = _hats(_ratio(here, behind), PRESSURES), _hats(_ratio(beyond, next_), GAPS)
    along = (p[inner, 3:-1] - p[inner, 1:-3])[faces]
    squared_normal = np.where(behind > 0, _ratio(behind**2, behind**2 + along**2), 0.0)
    table: Array = np.einsum("kn,pn,gn->kpg", [squared_normal, 1 - squared_normal], by_pressure, by_gap)
    return table


def _hats(ratio: Array, knots: Array) -> Array:
    """Return the weights of linear interpolation between knots, shape (knots, n); constant beyond them."""
    return np.array([np.interp(ratio, knots, row) for row in np.eye(len(knots))])


def _ratio(near: Array, far: Array) -> Array:
    """Return ``near / far``, infinite over nothing."""
    ratio: Array = np.divide(np.maximum(near, 0.0), far, out=np.full_like(near, np.inf), where=far > 0)
    return ratio


def single_element_share(edge: float, area: float) -> float:
    """Return the edge's share of an area over that of a single element: at most 1, and 1 without area.

    >>> single_element_share(4 * EDGE_SHARE, 1.0), single_element_share(EDGE_SHARE, 1.0)
    (1.0, 0.25)
    """
    return min(max(edge, 0.0) / area / (4 * EDGE_SHARE), 1.0) if area > 0 else 1.0
