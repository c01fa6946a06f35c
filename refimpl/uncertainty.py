"""Error bars: how far each reported number may be from the exact solution of the model, in parts.

Parts are absolute, in the number's unit, and meant as 95 % bounds that add. ``iteration`` follows
from the certificate; ``tau support`` from the states of a settled cycle, and from tau on contacts that it
is withheld from; ``discretisation`` from one grid or a sequence of grids (`refimpl.discretisation`).
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from refimpl.solution import Solution

Parts = dict[str, float]
Uncertainty = dict[str, Parts]


def iteration_parts(solution: Solution) -> Uncertainty:
    """What the certificate leaves open.

    Forces and lengths are uncertain by the worst residual. The area is uncertain by the elements
    whose pressure or clearance is within ten worst residuals of zero, and friction by tau on them.
    """
    worst = solution.certificate.worst
    margin = 10 * worst
    marginal = (solution.pressure > 0) & (solution.pressure <= margin * solution.max_pressure)
    lift = abs(solution.approach) or solution.grid.spacing
    marginal |= (solution.pressure == 0) & (solution.clearance <= margin * lift)
    area = float(np.count_nonzero(marginal)) * solution.grid.element_area
    relative = ("max_pressure", "approach", "normal_force")
    parts: Uncertainty = {name: {"iteration": worst * abs(getattr(solution, name))} for name in relative}
    parts["binormal_force"] = {"iteration": worst * abs(solution.normal_force)}
    parts["contact_area"] = {"iteration": area}
    friction = worst * abs(solution.friction_force) + solution.friction.tau * area
    parts["friction_force"] = {"iteration": friction}
    share = worst * abs(solution.friction_coefficient) + adhesive_share(solution) * area
    parts["friction_coefficient"] = {"iteration": share}
    return parts


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
