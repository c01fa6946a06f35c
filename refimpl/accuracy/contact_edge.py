"""Mean excess of whole elements along a contact's edge: the error of a counted area whose sign is known.

An element is in contact as a whole or not at all, and is counted as soon as a part of it carries load. Per
element face along the edge that adds ``(pi - 1 + ln 2) / 24`` elements in the mean if every element that the
edge crosses is counted (Yastrebov, Anciaux and Molinari 2017); of solved contacts it is `EDGE_SIZE` of that,
and more where one of the sizes below applies. They were fitted together to 1500 scenes of 15 classes
(`verification.coverage.classes`, seeds 591000 to 591019, 600000 to 600039 and 610000 to 610039).
"""

from __future__ import annotations

from refimpl.model.forces import EDGE_SHARE

EDGE_SIZE, EDGE_SIZE_SPREAD = 0.72, 0.04  # c0, s_c
OBLONG_SPREAD = 0.09  # s_c per ln(dx / dy): c0 of a ball: 0.75 at 2 : 1, 0.60 at 4 : 1, 0.55 at 8 : 1
# further excess over that of an edge, where elements stand alone, in contact or without; where pressure is at
# the hardness up to the edge; beyond the third face of a run along an axis (Westergaard's strips: 0.16 of an
# element in all); where a free border cuts the contact off, which carries too little there
SINGLE_EXCESS, YIELDED_EXCESS, STRAIGHT_EXCESS, BORDER_EXCESS = 1.5, 0.3, 1.0, 1.2


def single_element_share(edge: float, area: float) -> float:
    """Return the edge's share of an area over that of a single element: 1 where all patches are single
    elements, and without any area.

    >>> single_element_share(4 * EDGE_SHARE, 1.0), single_element_share(EDGE_SHARE, 1.0)
    (1.0, 0.25)
    """
    return min(max(edge, 0.0) / area / (4 * EDGE_SHARE), 1.0) if area > 0 else 1.0
