"""Scatter of one grid's numbers: counts along edges of the contact, of its gaps and of yielded elements."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import scipy

from refimpl.accuracy.bayesian_line import DEFAULT_ORDER, Intercept
from refimpl.accuracy.constants import constant, table
from refimpl.accuracy.contact_edge import KINDS, single_element_share
from refimpl.accuracy.grid_features import GridFeatures
from refimpl.grid import Array
from refimpl.model.forces import EDGE_SHARE

STRAIGHT_SCATTER = constant("straight_scatter")  # standard deviation of a straight edge over a step
_LEAST_SHARE = 1e-6  # in place of zero
_LEAST_RESOLVED = constant("gap_least_resolved")
_SLOPES = constant("slope_single_power")
_ALONE = constant("area_single_power")
_RISING, _NARROW = 4, 5  # first kinds of faces to which pressures do not fall, beyond which gaps do not rise
AREA_SCATTER = table("area_scatter")  # elements, of each of `area_counts`
RIM_SCATTER = constant("rim_scatter")  # elements, of each of `rim_count`
_GAP_STRAIGHT = constant("gap_straight_scatter")
PLASTIC_LACK = constant("plastic_lack")  # area that yields in part, over that of the edge
PLASTIC_SCATTER = table("plastic_scatter")  # scatter at each of `plastic_sizes`
PLASTIC_FREEDOM = constant("plastic_freedom")  # weight of the prior


def area_counts(result: GridFeatures) -> Array:
    """Return the counts by which an area scatters about its mean excess, one for each of `AREA_SCATTER`.

    1 to 4: faces, ordinary, towards which pressures do not fall, beyond which gaps do not rise, and both.
    5, 6: undecided elements amid the contact, and single elements. 1 to 6 are times the symmetric copies.
    7 to 9: straight edges, squared; the share of them by faces of 2 to 4; their share in narrow strips.
    10: the square of all faces towards which pressures do not fall, as if of one rim.
    """
    dA, together = result.grid.element_area, result.symmetry_multiplicity
    area = result.numbers["contact_area"]
    faces = np.reshape(result.faces, KINDS).sum(axis=0)
    falling, rising = faces[:_RISING].sum(axis=0), faces[_RISING:].sum(axis=0)
    gaps = slice(_NARROW), slice(_NARROW, None)
    kinds = [side[part].sum() for part in gaps for side in (falling, rising)]
    single = single_element_share(result.edge, area)
    alone = area / dA * single**_ALONE
    straight = result.straight.squares * max(min(together, result.straight.runs), 1)
    uneven = straight * sum(kinds[1:]) / max(sum(kinds), 1.0)
    counts = np.array([*kinds, result.undecided / dA, alone])
    return np.concatenate([counts * together, [straight, uneven, straight * single, rising.sum() ** 2]])


def rising_share(result: GridFeatures) -> float:
    """Return the share of faces along the contact's edge that see no fall, or one from the hardness alone."""
    faces = np.reshape(result.faces, KINDS).sum(axis=(0, 2))
    return float(min(1.0, (faces[_RISING:].sum() + result.rim_faces) / max(faces.sum(), 1.0)))


def rim_count(result: GridFeatures) -> float:
    """Return the faces before elements at the hardness, times the symmetric copies."""
    return result.rim_faces * result.symmetry_multiplicity


def area_scatter(result: GridFeatures) -> float:
    """Return the standard deviation of the area about its mean excess (m^2)."""
    rim = RIM_SCATTER**2 * rim_count(result)
    return math.sqrt(AREA_SCATTER**2 @ area_counts(result) + rim) * result.grid.element_area


def straight_scatter(result: GridFeatures) -> float:
    """Return the deviation of the area by straight edges (m^2); symmetric ones count together."""
    squares, together = result.straight.squares, min(result.symmetry_multiplicity, result.straight.runs)
    return STRAIGHT_SCATTER * math.sqrt(squares * max(together, 1)) * result.grid.element_area


def straight_share(result: GridFeatures) -> float:
    """Return the standard deviation by straight edges over the area, at most 1; 0 without contact."""
    return min(straight_scatter(result) / result.numbers["contact_area"], 1.0) if result.touching else 0.0


def edge_scatter(results: Sequence[GridFeatures]) -> Array:
    """Return each grid's edge fraction to the power 3/2, with the share of straight edges in squares."""
    along = [straight_share(result) for result in results]
    around = np.array([min(1.0, result.edge_fraction) for result in results]) ** DEFAULT_ORDER
    return np.hypot(around, along)


def gap_scatter(result: GridFeatures) -> float:
    """Return the unit of the mean gap's scatter (m): its share goes with the edge over the gap's area."""
    area = result.grid.nominal_area - result.numbers["contact_area"]
    if not (area > 0 and result.edge > 0):
        return 0.0
    resolved = max(1 - single_element_share(result.edge, area) ** 2, _LEAST_RESOLVED)
    gap = min(abs(result.mean_gap), max(abs(result.numbers["approach"]), result.depth))
    shares = result.edge / area / resolved, _GAP_STRAIGHT * straight_scatter(result) / area
    return gap * math.hypot(*(min(share, 1.0) ** DEFAULT_ORDER for share in shares))


def plastic_sizes(fine: GridFeatures) -> Array:
    """Return sizes of the plastic area's scatter (m^2): edge, straight edges, single elements' excess."""
    area, dA = fine.numbers.get("plastic_area", 0.0), fine.grid.element_area
    edge = max(fine.plastic_edge, 0.0)
    counted = math.sqrt(edge / EDGE_SHARE * dA * fine.symmetry_multiplicity)
    along = dA * math.sqrt(fine.plastic_straight.squares)
    return np.array([counted, along, edge, edge * single_element_share(edge, area) ** 2])


def plastic_area(fine: GridFeatures) -> Intercept:
    """Return the area at the hardness, to which elements that yield in part add a share of its edge."""
    area, lack = fine.numbers.get("plastic_area", 0.0), PLASTIC_LACK * max(fine.plastic_edge, 0.0)
    deviation = float(np.hypot.reduce(PLASTIC_SCATTER * plastic_sizes(fine)))
    return Intercept(area + lack, deviation * float(scipy.special.stdtrit(PLASTIC_FREEDOM, 0.975)))


def slope_scatter(results: Sequence[GridFeatures], name: str = "slope_sampling_error") -> Array:
    """Return how far slopes within elements leave mu open: all of it where patches are single elements."""
    uneven = np.array([getattr(result, name) for result in results])
    whole = abs(results[-1].numbers["friction_coefficient"])
    single = np.array([single_element_share(r.edge, r.numbers["contact_area"]) for r in results])
    resolved = np.maximum(1 - single**2, _LEAST_SHARE) ** _SLOPES
    scatter: Array = np.maximum(uneven, np.minimum(uneven / resolved, whole))
    return scatter


def border_slopes(result: GridFeatures) -> float:
    """Return the unit of mu's error by slopes under a pressure that a free border cuts off."""
    return result.border_fraction * result.rms_slope
