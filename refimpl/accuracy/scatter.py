"""Scatter of one grid's numbers: counts along edges of the contact, of its gaps and of yielded elements."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from refimpl.accuracy.bayesian_line import DEFAULT_ORDER, Estimate
from refimpl.accuracy.contact_edge import single_element_share
from refimpl.accuracy.grid_features import GridFeatures
from refimpl.grid import Array
from refimpl.model.forces import EDGE_SHARE

STRAIGHT_SCATTER = 0.21  # standard deviation over a step; Westergaard's strips: 0.17 to 0.22
_LEAST_SHARE = 1e-6  # in place of zero
_LEAST_RESOLVED = 0.2  # share of gaps that are not single elements: a mean gap errs by no more
_SLOPES = 2  # power of the share that is not single elements, which divides the scatter of slopes
EDGE_SCATTER, UNEVEN_SCATTER = 0.03, 0.46  # elements per face, and per uneven one
_ALONE = 5.5  # power of the share of single elements: patches of 2 x 2 have bars of all their area
STRAIGHT_LEFT = 0.46  # share of `straight_scatter` beyond the mean excess
# standard deviation of mu by slopes under that pressure, over border fraction and rms slope: the errors there
BORDER_SLOPES = 0.1
PLASTIC_SINGLE = 1.5  # further excess of single elements at the hardness, over that of their edge
PLASTIC_COUNT = 0.36  # 95 % bound of the area at the hardness, over the root of its edge elements
GAP_STRAIGHT = 3.5  # scatter of a gap's straight edges, over an area's


def area_scatter(result: GridFeatures) -> float:
    """Return the standard deviation of the area about its mean excess (m^2).

    Faces and undecided elements scatter as a count of which symmetric ones come in and out together, and
    uneven faces along a straight edge do. Of other straight edges the mean excess has the greater part. Where
    elements stand alone, nothing says how much of each is in contact.
    """
    dA, area, uneven = result.grid.element_area, result.numbers["contact_area"], result.offset.uneven
    faces, straight = max(result.edge, 0.0) / EDGE_SHARE / dA, straight_scatter(result) / dA
    alone = area / dA * single_element_share(result.edge, area) ** _ALONE
    together = EDGE_SCATTER**2 * (faces + result.undecided / dA) + alone
    variance = together * result.symmetry_multiplicity + (STRAIGHT_LEFT * straight) ** 2
    if uneven:
        variance += UNEVEN_SCATTER**2 * uneven * (1 + (straight / STRAIGHT_SCATTER) ** 2 / faces)
    return math.sqrt(variance) * dA


def straight_scatter(result: GridFeatures) -> float:
    """Return the standard deviation of the area by straight edges along the grid (m^2).

    Symmetric ones come in and out together.
    """
    squares, together = result.straight.squares, min(result.symmetry_multiplicity, result.straight.runs)
    return STRAIGHT_SCATTER * math.sqrt(squares * max(together, 1)) * result.grid.element_area


def straight_share(result: GridFeatures) -> float:
    """Return the standard deviation by straight edges over the area, at most 1; 0 without contact."""
    return min(straight_scatter(result) / result.numbers["contact_area"], 1.0) if result.touching else 0.0


def edge_scatter(results: Sequence[GridFeatures]) -> Array:
    """Return each grid's edge fraction to the power 3/2, the order at which an area's scatter falls.

    On a disc that is about the standard deviation of the area over the area; that of straight edges is added.
    """
    along = [straight_share(result) for result in results]
    around = np.array([min(1.0, result.edge_fraction) for result in results]) ** DEFAULT_ORDER
    return np.hypot(around, along)


def gap_scatter(result: GridFeatures) -> float:
    """Return the unit of the mean gap's scatter (m): its share goes with the edge over the gap's area.

    As that of an area does with the edge over the contact's; more where gaps are single elements or end at
    straight edges along the grid.
    """
    area = result.grid.nominal_area - result.numbers["contact_area"]
    if not (area > 0 and result.edge > 0):
        return 0.0
    resolved = max(1 - single_element_share(result.edge, area) ** 2, _LEAST_RESOLVED)
    gap = min(abs(result.mean_gap), max(abs(result.numbers["approach"]), result.depth))
    shares = result.edge / area / resolved, GAP_STRAIGHT * straight_scatter(result) / area
    return gap * math.hypot(*(min(share, 1.0) ** DEFAULT_ORDER for share in shares))


def plastic_area(fine: GridFeatures) -> Estimate:
    """Return the area at the hardness: the count of its edge elements, and their excess either way.

    The excess is larger where elements stand alone, as a contact's.
    """
    area, edge, dA = fine.numbers.get("plastic_area", 0.0), fine.plastic_edge, fine.grid.element_area
    counted = math.sqrt(edge / EDGE_SHARE * dA * fine.symmetry_multiplicity) if edge > 0 else 0.0
    along = 0.5 * dA * math.sqrt(fine.plastic_straight.squares)
    excess = edge * (1 + PLASTIC_SINGLE * single_element_share(edge, area) ** 2)
    return Estimate(area, excess + math.hypot(PLASTIC_COUNT * counted, along))


def slope_scatter(results: Sequence[GridFeatures]) -> Array:
    """Return how far slopes within elements leave mu open: all of it where patches are single elements."""
    uneven = np.array([result.slope_sampling_error for result in results])
    whole = abs(results[-1].numbers["friction_coefficient"])
    single = np.array([single_element_share(r.edge, r.numbers["contact_area"]) for r in results])
    resolved = np.maximum(1 - single**2, _LEAST_SHARE) ** _SLOPES
    scatter: Array = np.maximum(uneven, np.minimum(uneven / resolved, whole))
    return scatter


def border_slopes(result: GridFeatures) -> float:
    """Return how far slopes under a pressure that a free border cuts off leave mu open."""
    return BORDER_SLOPES * result.border_fraction * result.rms_slope
