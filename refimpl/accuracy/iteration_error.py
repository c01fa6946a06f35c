"""Error bars of what a grid's own solution leaves open: unfinished iterations, and tau's active set.

Parts are absolute, in the number's unit, and meant as 95 % bounds that add. ``iteration`` follows from the
certificate; ``active set`` from elements in contact that carry no adhesive shear.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from refimpl.model.certificate import State
from refimpl.model.forces import contact_area
from refimpl.model.friction import FrictionLaw, friction_per_area
from refimpl.model.problem import Problem

CORRECTED = {
    "contact_area_corrected": "contact_area",
    "friction_coefficient_corrected": "friction_coefficient",
    "friction_force_corrected": "friction_force",
}
"""Numbers without the mean excess of the contact edge, by the number that it is subtracted from."""
_SHEARED = "friction_coefficient", "friction_force"
Parts = dict[str, float]
Uncertainty = dict[str, Parts]

# times the largest residual, within which of zero a pressure or clearance may change its sign: against solves
# to 1e-10, elements of 61 of 63 loose solves (residuals of 1e-4 to 0.2) changed within 4.3, and all areas
# were within their part
_MARGIN = 10


def reported_numbers(problem: Problem, state: State) -> dict[str, float]:
    """Return all reported numbers of a state (SI); the approach counts from the problem's datum."""
    return {
        "friction_coefficient": state.friction_coefficient,
        "contact_area": state.contact_area,
        "plastic_area": state.plastic_area,
        "max_pressure": state.max_pressure,
        "approach": state.approach - problem.datum,
        "normal_force": state.forces.normal,
        "friction_force": state.forces.friction,
        "binormal_force": state.forces.binormal,
    }


def without_rule(law: FrictionLaw) -> tuple[str, ...]:
    """Return the numbers without a rule for error bars: of a nonlinear law mu and F, else none.

    Only tau's effect on an element too many is known.
    """
    corrected = tuple(name for name, raw in CORRECTED.items() if raw in _SHEARED)
    return () if law.is_linear else (*_SHEARED, *corrected)


def iteration_parts(problem: Problem, state: State) -> Uncertainty:
    """Return what the certificate leaves open.

    Forces and lengths by the largest residual; areas by elements within ten residuals of zero pressure or
    clearance, and friction by tau on them; the maximum pressure by what would close the gap at the highest
    elements; the approach of a contact without elastic elements by half the interval that the load leaves.
    """
    residual = state.certificate.largest
    margin = _MARGIN * residual
    marginal = state.contact & (state.pressure <= margin * state.max_pressure)
    lift = abs(state.approach) or problem.grid.element_size
    clearance = state.clearance
    marginal |= (state.pressure == 0) & (clearance <= margin * lift)
    area = contact_area(marginal, problem.grid)
    normal = abs(state.forces.normal)
    sizes = dict.fromkeys(("normal_force", "binormal_force"), normal) | {"approach": lift}
    parts: Uncertainty = {name: {"iteration": residual * size} for name, size in sizes.items()}
    parts["max_pressure"] = {"iteration": max(residual * state.max_pressure, _peak_misfit(problem, state))}
    yielding = state.plastic & (clearance >= -margin * lift)
    yielding |= ~state.plastic & (state.pressure >= (1 - margin) * problem.cap)
    parts["plastic_area"] = {"iteration": contact_area(yielding, problem.grid)}
    if state.plastic_area:
        parts["max_pressure"] = {"iteration": 0.0}
    if problem.load is not None and state.plastic_area == state.contact_area > 0:
        parts["approach"]["not unique"] = _approach_interval(state)
    parts["contact_area"] = {"iteration": area}
    turned = math.sqrt(state.slopes.mean_square(state.pressure)) * normal
    friction = residual * (abs(state.forces.friction) + turned) + problem.friction.jump * area
    parts["friction_force"] = {"iteration": friction}
    share = residual * (abs(state.friction_coefficient) + (turned / normal if normal else 0.0))
    per_area = friction_per_area(problem.friction, state.forces.normal)
    parts["friction_coefficient"] = {"iteration": share + per_area * area}
    return parts


def _approach_interval(state: State) -> float:
    """Return half the interval of approaches of a contact without elastic elements (m)."""
    lowest = float(np.min(state.v, where=~state.contact, initial=math.inf))
    return lowest - state.approach


def _peak_misfit(problem: Problem, state: State) -> float:
    """Return the pressure (Pa) that closes the clearance of the highest elements, each by itself."""
    if state.max_pressure == 0:
        return 0.0
    misfit = float(np.abs(state.v[state.pressure >= 0.5 * state.max_pressure] - state.approach).max())
    return misfit / problem.elasticity.element_compliance(problem.grid)


def active_set_parts(problem: Problem, state: State) -> Uncertainty:
    """Return the parts of elements that are in contact only without adhesive shear.

    Some laws give them a share of it (case ``tau/shares``): all of tau on them is uncertain.
    """
    load = problem.nominal_load(state.forces.normal)
    violating = state.certificate.law_violations * problem.grid.element_area
    by_violation = problem.friction.jump * violating / load if load else 0.0
    spread = {"friction_coefficient": by_violation, "friction_force": by_violation * load}
    spread["contact_area"] = violating
    return {name: {"active set": width} for name, width in spread.items() if width > 0}


def merged(*several: Mapping[str, Mapping[str, float]]) -> Uncertainty:
    """Return all parts of all numbers; of parts with one name the last is kept."""
    result: Uncertainty = {}
    for parts in several:
        for name, values in parts.items():
            result.setdefault(name, {}).update(values)
    return result
