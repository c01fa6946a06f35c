"""Error bars: how far each reported number may be from the exact solution of the model, in parts.

Parts are absolute, in the number's unit, and meant as 95 % bounds that add. ``iteration`` follows from the
certificate; ``tau support`` from the states of a settled cycle, and from tau on contacts that it is withheld
from; ``discretisation`` from one grid or a sequence of grids (`refimpl.accuracy.discretisation_error`).
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from refimpl.solution.solution import Solution

AREAS = "contact_area", "contact_area_corrected"  # open by the same elements
Parts = dict[str, float]
Uncertainty = dict[str, Parts]


def iteration_parts(solution: Solution) -> Uncertainty:
    """What the certificate leaves open.

    Forces and lengths are uncertain by the worst residual: of the approach from first touch, of the normal
    force, which slopes turn to friction and to Q. The area is uncertain by the elements whose pressure or
    clearance is within ten worst residuals of zero, and friction by tau on them; the highest pressure by what
    the highest elements would press by themselves for what their separation is off, where that is more.
    """
    worst = solution.certificate.worst
    margin = 10 * worst
    marginal = (solution.pressure > 0) & (solution.pressure <= margin * solution.max_pressure)
    lift = from_first_touch(solution) or solution.grid.spacing
    marginal |= (solution.pressure == 0) & (solution.clearance <= margin * lift)
    area = float(np.count_nonzero(marginal)) * solution.grid.element_area
    normal = abs(solution.normal_force)
    sizes = dict.fromkeys(("normal_force", "binormal_force"), normal) | {"approach": lift}
    parts: Uncertainty = {name: {"iteration": worst * size} for name, size in sizes.items()}
    parts["max_pressure"] = {"iteration": max(worst * solution.max_pressure, _misplaced(solution))}
    parts |= {name: {"iteration": area} for name in AREAS}
    turned = math.tan(solution.slope_error.rms_slope) * normal
    friction = worst * (abs(solution.friction_force) + turned) + solution.friction.tau * area
    parts["friction_force"] = {"iteration": friction}
    share = worst * (abs(solution.friction_coefficient) + (turned / normal if normal else 0.0))
    parts["friction_coefficient"] = {"iteration": share + adhesive_share(solution) * area}
    return parts


def _misplaced(solution: Solution) -> float:
    """Pressure (Pa) that takes the highest elements back where they should be, each by itself.

    Those with half of the highest pressure; at edges separations are off by more, and no peak is there.
    """
    if solution.max_pressure == 0:
        return 0.0
    off = float(np.abs(solution.clearance[solution.pressure >= 0.5 * solution.max_pressure]).max())
    return 0.5 * off / (solution.problem.pair.normal_compliance * solution.grid.spacing)


def from_first_touch(solution: Solution) -> float:
    """The approach counted from first touch, also of periodic scenes, which count from mean planes (m)."""
    problem = solution.problem
    return abs(solution.approach + (float(problem.gap.mean()) if problem.periodic else 0.0))


def adhesive_share(solution: Solution) -> float:
    """``d mu / d A = tau / N`` of Eq. (10): what a change of area does to friction (1/m^2)."""
    return solution.friction.tau / solution.normal_force if solution.normal_force > 0 else 0.0


def edge_excess(solution: Solution) -> float:
    """Area that whole elements add along the contact's edge, ``A - A_corrected`` (m^2)."""
    return solution.contact_area - solution.contact_area_corrected


def merged(*several: Mapping[str, Mapping[str, float]]) -> Uncertainty:
    """All parts of all numbers; of parts with one name the last is kept.

    >>> merged({"approach": {"iteration": 1.0}}, {"approach": {"discretisation": 2.0}})
    {'approach': {'iteration': 1.0, 'discretisation': 2.0}}
    """
    result: Uncertainty = {}
    for parts in several:
        for name, values in parts.items():
            result.setdefault(name, {}).update(values)
    return result
