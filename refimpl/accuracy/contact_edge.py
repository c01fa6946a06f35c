"""Mean excess of whole elements along a contact's edge: the error of a counted area whose sign is known.

An element is in contact as a whole or not at all, and is counted as soon as a part of it carries load. Per
element face along the edge that adds ``(pi - 1 + ln 2) / 24`` elements in the mean if every element that the
edge crosses is counted (Yastrebov, Anciaux and Molinari 2017); of solved contacts it is `EDGE_SIZE` of that.
"""

from __future__ import annotations

from refimpl.model.forces import EDGE_SHARE

EDGE_SIZE, EDGE_SIZE_SPREAD = 0.78, 0.07  # c0, s_c
OBLONG_SPREAD = 0.09  # s_c per ln(dx / dy): c0 of a ball: 0.75 at 2 : 1, 0.60 at 4 : 1, 0.55 at 8 : 1
SINGLE_EXCESS = 1.5  # further excess of single elements, over that of an edge
STRAIGHT_EXCESS = 1.2  # the like of straight edges along the grid: 0.21 of an element, elsewhere 0.09


def excess_unit(edge: float, straight: float, area: float) -> float:
    """Return the area (m^2) of which the mean excess is `EDGE_SIZE` times.

    ``edge`` is the excess of Yastrebov and others, ``straight`` the faces of straight edges along the grid
    times the element's area, ``area`` the counted contact area (m^2).
    """
    single = single_element_share(edge, area)
    return edge * (1 + SINGLE_EXCESS * single**2) + STRAIGHT_EXCESS * EDGE_SHARE * straight


def mean_excess(edge: float, straight: float, area: float) -> float:
    """Return by how much a counted contact area is too large in the mean (m^2).

    >>> round(mean_excess(0.1, 0.0, 2.0), 3), mean_excess(0.0, 0.0, 0.0)
    (0.079, 0.0)
    """
    return EDGE_SIZE * excess_unit(edge, straight, area)


def single_element_share(edge: float, area: float) -> float:
    """Return the edge's share of the area over that of a single element: 1 where all patches are single
    elements, and without contact."""
    return max(edge, 0.0) / area / (4 * EDGE_SHARE) if area > 0 else 1.0
